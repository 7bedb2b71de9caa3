// The simulation: the engine's, with arrays that stay.

import { EngineSimulation } from "./engine.js";
import { call, free, lend } from "./engine-door.js";
import { mistake } from "./errors.js";
import { changes, choice, flag, number, options, planes, range, text, vector } from "./values.js";

const OURS = Symbol("made by this package");

/** A simulation of masses and springs. The types in index.d.ts say what everything means. */
export class Simulation {
    #engine;
    #facts = {}; // what never changes, once it was asked for
    #arrays = {}; // the arrays that are kept current, once they were asked for
    #current = -1; // the engine's count of changes that they show

    static builtin(name, set) {
        const pairs = changes(set);
        return new Simulation(OURS, call(() => EngineSimulation.builtin(text(name, "name"), pairs)));
    }

    static parse(scene, set, file = "scene.toml") {
        const pairs = changes(set);
        return new Simulation(OURS, call(() => EngineSimulation.parse(text(scene, "scene"), text(file, "file"), pairs)));
    }

    constructor(key, engine) {
        if (key !== OURS) {
            throw mistake("Unsupported", undefined, "a simulation is not made with new", "use Simulation.builtin, Simulation.parse or a Builder");
        }
        this.#engine = engine;
    }

    // Moving on.

    step(count = 1) {
        this.#change((engine) => engine.step(number(count, "step")));
    }

    frame() {
        this.#change((engine) => engine.frame());
    }

    advance(seconds, most = 0.25) {
        return this.#change((engine) => engine.advance(number(seconds, "seconds"), number(most, "most")));
    }

    reset() {
        this.#change((engine) => engine.reset());
    }

    settle(given) {
        const { residualForce, maxSteps } = options(given, "settle", ["residualForce", "maxSteps"]);
        return this.#change((engine) => engine.settle(residualForce, maxSteps));
    }

    // Reading.

    get title() {
        return this.#fact("title", (engine) => engine.title());
    }

    get description() {
        return this.#fact("description", (engine) => engine.description());
    }

    get pointCount() {
        return this.#fact("pointCount", (engine) => engine.point_count());
    }

    get springCount() {
        return this.#fact("springCount", (engine) => engine.spring_count());
    }

    get springs() {
        return this.#fact("springs", (engine) => engine.springs());
    }

    get bodies() {
        return this.#fact("bodies", (engine) => engine.bodies());
    }

    get joints() {
        return this.#fact("joints", (engine) => engine.joints());
    }

    get surfaces() {
        return this.#fact("surfaces", (engine) => engine.surfaces());
    }

    get stepCount() {
        return this.#read((engine) => engine.steps_taken());
    }

    get time() {
        return this.#read((engine) => engine.time());
    }

    get positions() {
        return this.#array("positions");
    }

    get velocities() {
        return this.#array("velocities");
    }

    copyPositions(target) {
        return this.#copy("positions", target);
    }

    copyVelocities(target) {
        return this.#copy("velocities", target);
    }

    withViews(use) {
        const places = this.#read((engine) => engine.snapshot_at());
        return lend(places, 3 * this.pointCount, use);
    }

    stateHash() {
        return this.#read((engine) => engine.state_hash());
    }

    energy() {
        return this.#read((engine) => engine.energy());
    }

    get keepsLedger() {
        return this.#read((engine) => engine.keeps_ledger());
    }

    set keepsLedger(on) {
        this.#read((engine) => engine.keep_ledger(flag(on, "keepsLedger")));
    }

    stability() {
        return this.#read((engine) => engine.stability());
    }

    certifiedLimit() {
        return this.#read((engine) => engine.certified_limit());
    }

    // Changing.

    get(name, of) {
        text(name, "name");
        if (of === undefined) return this.#read((engine) => engine.get(name));
        const value = this.#read((engine) => engine.get_of(name, number(of, name)));
        return name === "pinned" || name === "cut" ? value === 1 : value;
    }

    set(name, value, where) {
        text(name, "name");
        const range = () => (name === "mass" ? this.#points(where, name) : this.#springs(where, name));
        this.#change((engine) => {
            if (name === "gravity") return engine.set_gravity(...vector(value, name));
            if (name === "planes") return engine.set_planes(new Float64Array(planes(value)));
            if (name === "dt" && value === "auto") return engine.set_dt_auto();
            if (name === "dt") return engine.set_dt(number(value, name));
            if (name === "substeps") return engine.set_substeps(number(value, name));
            choice(name, "name", ["dt", "substeps", "gravity", "planes", "mass", "stiffness", "damping", "restScale"]);
            return engine.set_range(name, ...range(), number(value, name));
        });
    }

    pin(where) {
        this.#switch("pin", this.#points(where, "pin"), 1);
    }

    unpin(where) {
        this.#switch("pin", this.#points(where, "unpin"), 0);
    }

    cut(where) {
        this.#switch("cut", this.#springs(where, "cut"), 1);
    }

    mend(where) {
        this.#switch("cut", this.#springs(where, "mend"), 0);
    }

    force(point, force) {
        const parts = vector(force, "force");
        this.#change((engine) => engine.force(number(point, "point"), ...parts));
    }

    place(point, position) {
        const parts = vector(position, "position");
        this.#change((engine) => engine.place(number(point, "point"), ...parts));
    }

    carry(point, velocity) {
        const parts = vector(velocity, "velocity");
        this.#change((engine) => engine.carry(number(point, "point"), ...parts));
    }

    pick(origin, direction, given) {
        const { radius = 0, spread = 0.02 } = options(given, "pick", ["radius", "spread"]);
        const ray = [...vector(origin, "origin"), ...vector(direction, "direction")];
        return this.#read((engine) => engine.pick(...ray, number(radius, "radius"), number(spread, "spread")));
    }

    drag(point, target, spring) {
        const parts = vector(target, "target");
        const { stiffness, damping = 0 } = options(spring, "drag", ["stiffness", "damping"]);
        const own = stiffness === undefined ? undefined : new Float32Array([number(stiffness, "stiffness"), number(damping, "damping")]);
        this.#change((engine) => engine.drag(number(point, "point"), ...parts, own));
    }

    release(point) {
        this.#change((engine) => engine.release(number(point, "point")));
    }

    dispose() {
        const engine = this.#engine;
        if (engine === undefined) return;
        free(engine);
        this.#engine = undefined;
    }

    // Inside.

    #use() {
        if (this.#engine === undefined) {
            throw mistake("Conflict", undefined, "this simulation was disposed of, and cannot be used any more");
        }
        return this.#engine;
    }

    /** Calls what moves no point. */
    #read(act) {
        const engine = this.#use();
        return call(() => act(engine));
    }

    /** Calls what may move points; then, and after an error too, the arrays show how it is now. */
    #change(act) {
        const engine = this.#use();
        try {
            return call(() => act(engine));
        } finally {
            this.#refresh(engine);
        }
    }

    #refresh(engine) {
        const { positions, velocities } = this.#arrays;
        if (positions === undefined && velocities === undefined) return;
        call(() => {
            const changes = engine.changes();
            if (changes === this.#current) return;
            // An array that was transferred to somebody else is empty, and no longer ours to fill.
            if (positions?.length) engine.copy_positions(positions);
            if (velocities?.length) engine.copy_velocities(velocities);
            this.#current = changes;
        });
    }

    #array(name) {
        const engine = this.#use();
        const length = 3 * this.pointCount;
        if (this.#arrays[name]?.length !== length) {
            this.#arrays[name] = new Float32Array(length);
            this.#current = -1;
            this.#refresh(engine);
        }
        return this.#arrays[name];
    }

    #copy(name, target) {
        if (!(target instanceof Float32Array)) {
            throw mistake("WrongType", "target", "must be a Float32Array with three numbers for each point");
        }
        this.#read((engine) => (name === "positions" ? engine.copy_positions(target) : engine.copy_velocities(target)));
        return target;
    }

    #fact(name, find) {
        this.#facts[name] ??= this.#read(find);
        this.#use();
        return this.#facts[name];
    }

    #points(where, field) {
        return range(where, field, this.pointCount, this.bodies.map(({ name, points }) => ({ name, range: points })));
    }

    #springs(where, field) {
        const owners = [...this.bodies, ...this.joints].map(({ name, springs }) => ({ name, range: springs }));
        return range(where, field, this.springCount, owners);
    }

    #switch(name, [first, end], on) {
        this.#change((engine) => engine.set_range(name, first, end, on));
    }
}

if (Symbol.dispose) Simulation.prototype[Symbol.dispose] = Simulation.prototype.dispose;

/** A simulation around one of the engine's: for the builder. */
export function simulationOf(engine) {
    return new Simulation(OURS, engine);
}
