// Points and springs in code.

import { EngineBuilder } from "./engine.js";
import { call, free } from "./engine-door.js";
import { mistake } from "./errors.js";
import { simulationOf } from "./simulation.js";
import { choice, material, number, numbers, options, planes, range, text, vector } from "./values.js";

const KINDS = { structural: 1, shear: 2, bend: 4 };
const GRID_AXES = { xy: [0, 1], xz: [0, 2], yz: [1, 2] };

/** Points that were added together: a range, and where they are a lattice, its sides. */
class Points {
    #sideOf;
    #lattice;
    #counts;

    constructor(first, count, sideOf, lattice, counts) {
        Object.assign(this, { first, count, end: first + count });
        this.#sideOf = sideOf;
        this.#lattice = lattice;
        this.#counts = counts;
        Object.freeze(this);
    }

    /** Where it is a lattice, its number there. */
    get lattice() {
        return this.#lattice;
    }

    index(i, j = 0, k = 0) {
        const [x, y, z] = this.#counts ?? [this.count, 1, 1];
        const inside = [[i, x], [j, y], [k, z]].every(([at, count]) => Number.isInteger(at) && at >= 0 && at < count);
        if (!inside) {
            throw mistake("NotFound", "index", `there is no point at ${i}, ${j}, ${k}; there are ${x} × ${y} × ${z} points`);
        }
        return this.first + (i * y + j) * z + k;
    }

    side(name) {
        if (this.#lattice === undefined) {
            throw mistake("NotFound", "side", "these points are no chain, grid or lattice, and have no sides");
        }
        return this.#sideOf(text(name, "side"));
    }

    *[Symbol.iterator]() {
        for (let point = this.first; point < this.end; point++) yield point;
    }
}

/** Collects points and springs, and makes simulations of them. The types in index.d.ts say what everything means. */
export class Builder {
    #engine;

    constructor(given) {
        const { title = "" } = options(given, "Builder", ["title"]);
        this.#engine = call(() => new EngineBuilder(text(title, "title")));
    }

    get pointCount() {
        return this.#call((engine) => engine.point_count());
    }

    get springCount() {
        return this.#call((engine) => engine.spring_count());
    }

    body(name) {
        this.#call((engine) => engine.body(text(name, "name")));
    }

    joint(name) {
        this.#call((engine) => engine.joint(text(name, "name")));
    }

    point(position, given) {
        const { mass = 1 } = options(given, "point", ["mass"]);
        const place = new Float64Array(vector(position, "position"));
        return this.#call((engine) => engine.points(place, new Float64Array([number(mass, "mass")])));
    }

    points(positions, given) {
        const { mass = 1 } = options(given, "points", ["mass"]);
        const places = new Float64Array(flat(positions));
        const masses = new Float64Array(typeof mass === "number" ? [mass] : numbers(mass, "mass", places.length / 3));
        return new Points(this.#call((engine) => engine.points(places, masses)), places.length / 3);
    }

    chain(given) {
        const { points, step, origin = [0, 0, 0], mass = 1 } = options(given, "chain", ["points", "step", "origin", "mass"]);
        const [way, from] = [new Float64Array(vector(step, "step")), new Float64Array(vector(origin, "origin"))];
        return this.#lattice([number(points, "points"), 1, 1], (engine) => engine.chain(points, way, from, number(mass, "mass")));
    }

    grid(given) {
        const { points, plane = "xz", ...rest } = options(given, "grid", ["points", "spacing", "plane", "origin", "mass"]);
        const axes = GRID_AXES[choice(plane, "plane", Object.keys(GRID_AXES))];
        const counts = [1, 1, 1];
        numbers(points, "points", 2).forEach((count, at) => (counts[axes[at]] = count));
        return this.#block(counts, rest);
    }

    lattice(given) {
        const { points, ...rest } = options(given, "lattice", ["points", "spacing", "origin", "mass"]);
        return this.#block(numbers(points, "points", 3), rest);
    }

    connect(points, given) {
        const { kinds, ...rest } = options(given, "connect", ["kinds", "stiffness", "damping"]);
        if (points?.lattice === undefined) {
            throw mistake("WrongType", "points", "must be what chain, grid or lattice gave");
        }
        if (!Array.isArray(kinds)) throw mistake("MissingField", "kinds", "must be a list of structural, shear, bend");
        const bits = kinds.reduce((bits, kind) => bits | KINDS[choice(kind, "kinds", Object.keys(KINDS))], 0);
        const made = material(rest, "connect");
        return this.#springs((engine) => engine.connect(points.lattice, bits, ...made));
    }

    connectWithin(points, radius, given) {
        const made = material(given, "connectWithin");
        const [first, end] = range(points, "points", this.pointCount, []);
        return this.#springs((engine) => engine.connect_within(first, end, number(radius, "radius"), ...made));
    }

    connectBetween(a, b, radius, given) {
        const made = material(given, "connectBetween");
        const ends = new Float64Array([a, b].flatMap((points) => range(points, "points", this.pointCount, [])));
        return this.#springs((engine) => engine.connect_between(ends, number(radius, "radius"), ...made));
    }

    spring(a, b, given) {
        const made = material(given, "spring", ["restLength"]);
        const length = given.restLength === undefined ? undefined : number(given.restLength, "restLength");
        return this.#call((engine) => engine.spring(number(a, "spring"), number(b, "spring"), ...made, length));
    }

    springs(pairs, given) {
        return this.#springs(() => {
            for (const [a, b] of pairs) this.spring(a, b, given);
            return undefined;
        });
    }

    pin(points) {
        this.#each(points, (engine, point) => engine.pin(point));
    }

    velocity(points, velocity) {
        const parts = vector(velocity, "velocity");
        this.#each(points, (engine, point) => engine.velocity(point, ...parts));
    }

    surface(triangles, kind = "cloth") {
        const corners = Uint32Array.from(triangles.flat?.() ?? triangles);
        if (corners.length % 3 !== 0) {
            throw mistake("Conflict", "triangles", `has ${corners.length} corners, and must have three for each triangle`);
        }
        const isSkin = choice(kind, "kind", ["cloth", "skin"]) === "skin";
        this.#call((engine) => engine.surface(corners, isSkin));
    }

    simulation(given) {
        const allowed = ["dt", "substeps", "gravity", "planes"];
        const { dt = "auto", substeps = 1, gravity = [0, -9.81, 0], planes: ground = [] } = options(given, "simulation", allowed);
        const step = dt === "auto" ? undefined : number(dt, "dt");
        const [down, floors] = [new Float64Array(vector(gravity, "gravity")), new Float64Array(planes(ground))];
        return simulationOf(this.#call((engine) => engine.simulation(step, number(substeps, "substeps"), down, floors)));
    }

    dispose() {
        const engine = this.#engine;
        if (engine === undefined) return;
        free(engine);
        this.#engine = undefined;
    }

    #call(act) {
        if (this.#engine === undefined) {
            throw mistake("Conflict", undefined, "this builder was disposed of, and cannot be used any more");
        }
        return call(() => act(this.#engine));
    }

    #block(counts, { spacing, origin = [0, 0, 0], mass = 1 }) {
        const [sizes, from] = [new Float64Array(counts), new Float64Array(vector(origin, "origin"))];
        return this.#lattice(counts, (engine) => engine.lattice(sizes, number(spacing, "spacing"), from, number(mass, "mass")));
    }

    #lattice(counts, add) {
        const lattice = this.#call(add);
        const first = this.#call((engine) => engine.first_of(lattice));
        const sideOf = (name) => this.#call((engine) => engine.side(lattice, name));
        return new Points(first, this.pointCount - first, sideOf, lattice, counts);
    }

    /** Adds springs; gives them as a range. */
    #springs(add) {
        const first = this.springCount;
        this.#call(add);
        return [first, this.springCount];
    }

    #each(points, act) {
        if (typeof points !== "number" && typeof points?.[Symbol.iterator] !== "function") {
            throw mistake("WrongType", "points", "must be an index, a list of them, or what the builder gave");
        }
        const list = typeof points === "number" ? [points] : points;
        for (const point of list) this.#call((engine) => act(engine, number(point, "point")));
    }
}

if (Symbol.dispose) Builder.prototype[Symbol.dispose] = Builder.prototype.dispose;

/** All coordinates in a row: from one already, or from vectors. */
function flat(positions) {
    if (ArrayBuffer.isView(positions) || typeof positions?.[0] === "number") {
        if (positions.length % 3 === 0) return Array.from(positions, (part) => number(part, "positions"));
        throw mistake("Conflict", "positions", `has ${positions.length} numbers, and must have three for each point`);
    }
    if (!Array.isArray(positions)) {
        throw mistake("WrongType", "positions", "must be a list of vectors, or of three numbers for each point");
    }
    return positions.flatMap((position, index) => vector(position, `positions[${index}]`));
}
