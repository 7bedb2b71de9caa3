/**
 * sprung: masses, springs and a ground plane.
 *
 * Units are SI (m, kg, s, N, J) everywhere; the up axis is +y, as in three.js. Points and springs are called by their index,
 * from 0. Every function that is given something wrong throws a {@link SprungError} that says what, where, and what mends it.
 *
 * @example Five lines to a moving cloth
 * ```js
 * import { init, Simulation } from "sprung";
 *
 * await init();
 * const cloth = Simulation.builtin("cloth");
 * cloth.frame();
 * console.log(cloth.positions);
 * ```
 * @packageDocumentation
 */

/**
 * Loads the engine. Needed once before anything else, and harmless more often.
 *
 * Without an argument the engine is loaded from where this package lies. Some bundlers put files elsewhere; then say where
 * `engine_bg.wasm` is, or hand over its bytes, or the module compiled already.
 *
 * @example With Vite, if it is not told to leave this package alone (`optimizeDeps: { exclude: ["sprung"] }`)
 * ```js
 * import wasm from "sprung/engine_bg.wasm?url";
 * await init(wasm);
 * ```
 */
export function init(source?: EngineSource | Promise<EngineSource>): Promise<void>;

/** Where the engine comes from: a URL, an answer of `fetch`, bytes, or a compiled module. */
export type EngineSource = string | URL | Response | BufferSource | WebAssembly.Module;

/** The version of the engine, such as "0.1.0". */
export function version(): string;

/** The scenes that come with the engine. */
export function scenes(): SceneInfo[];

/** Bytes of memory that the engine has taken from the system, for all simulations together. It never shrinks, and is used again. */
export function memoryBytes(): number;

/** A scene that comes with the engine. */
export interface SceneInfo {
    /** As {@link Simulation.builtin} takes it. */
    name: string;
    /** What it shows, in a few words. */
    title: string;
    /** One of the four with which the project began, one that shows something more, or a large one for measuring speed. */
    kind: "report" | "gallery" | "benchmark";
    /** Its text, which {@link Simulation.parse} takes: change it, and it is a scene of your own. */
    text: string;
}

/** Three numbers: x, y and z, as a list, or as an object such as three.js's `Vector3`. */
export type Vector = readonly [x: number, y: number, z: number] | Float32Array | Float64Array | { x: number; y: number; z: number };

/**
 * Changes of a scene before it is built, as the command's `--set KEY=VALUE`: `{ dt: 0.005, "plane.y": -3 }`. Keys are paths
 * such as `dt`, `gravity`, `stiffness`, `plane.y` or `body.jelly.springs.0.stiffness`; values are what a scene file has there.
 */
export type Changes = Readonly<Record<string, SceneValue>>;

/** A value in a scene file. A text may also be anything that a scene file has there, as on a command line. */
export type SceneValue = number | string | boolean | readonly SceneValue[] | Float32Array | Float64Array | { readonly [key: string]: SceneValue };

/** A range of points or springs, from the first to the end, which is not included. */
export type Range = [first: number, end: number];

/** Some points: one index, a range, what a {@link Builder} gave, or the name of a body. */
export type PointsWhere = number | Readonly<Range> | Points | string;

/** Some springs: one index, a range, or the name of a body or joint. */
export type SpringsWhere = number | Readonly<Range> | string;

/** A named part of a scene. */
export interface Body {
    name: string;
    points: Range;
    springs: Range;
}

/** Springs that join bodies. */
export interface Joint {
    name: string;
    springs: Range;
}

/** Triangles of a body, for drawing. */
export interface Surface {
    /** The body's name. */
    body: string;
    /** An open sheet, or the closed skin of a solid, whose triangles turn counter-clockwise seen from outside. */
    kind: "cloth" | "skin";
    /** Three points for each triangle: an index for {@link Simulation.positions}. */
    triangles: Uint32Array;
}

/** A ground plane: points below it are pushed back out. Say `y`, or `point` and perhaps `normal`. */
export interface PlaneOptions {
    /** Height of a level plane, m. */
    y?: number;
    /** A point of the plane, m. */
    point?: Vector;
    /** The direction out of the ground, of any length. Default: up. */
    normal?: Vector;
    /** N/m for each point that touches. */
    stiffness: number;
    /** N·s/m for each point that touches. Default: 0. */
    damping?: number;
    /** "push" never pulls; "report" may hold a point down near lift-off. Default: "push". */
    law?: "push" | "report";
}

/** A ground plane as it is. */
export interface Plane {
    point: [number, number, number];
    normal: [number, number, number];
    stiffness: number;
    damping: number;
    law: "push" | "report";
}

/** Where the energy is, and where it went since the start, J. */
export interface Energy {
    /** Kinetic and all potential energy. */
    total: number;
    kinetic: number;
    gravitational: number;
    elastic: number;
    contact: number;
    /** The total at the start. */
    start: number;
    /** Put in by forces, by dragging and by changes of the parameters. Always kept. */
    workIn: number;
    /** Taken out by dampers, by contact, and made by the integrator, as long as {@link Simulation.keepsLedger} is on. */
    lostInDampers: number;
    lostInContact: number;
    integratorError: number;
}

/** A length of the step that is safe, and what keeps it from being larger. */
export interface Limit {
    /** s; `Infinity` where nothing limits it. */
    dt: number;
    /** What sets it, in words, such as "spring 884 of jelly (points 111 and 112)". */
    setBy: string;
    /** The spring that does, if one does. */
    spring?: number;
    /** Its points; or the one whose contact or drag sets the limit. */
    points?: number[];
}

/** How large dt may be: three answers, as `sprung show` prints them. */
export interface Stability {
    /** The length of the step now, s. */
    dt: number;
    /** The true limit in this configuration, s; ω² (1/s²) of the fastest vibration and the largest damping per mass (1/s). */
    sharp: { dt: number; omega2Max: number; cMax: number };
    /** A limit that is safe in this configuration. */
    certified: Limit;
    /** One that is safe whatever shape the network takes. */
    everyConfiguration: Limit;
}

/** What a ray met. */
export interface Picked {
    kind: "point" | "spring";
    /** The point, or the spring. */
    index: number;
    /** In words, such as "point 3 of jelly". */
    name: string;
    /** The place on it that is nearest to the ray, m. */
    position: [number, number, number];
    /** How far along the ray that is, m. */
    distance: number;
}

/** A spring, N/m and N·s/m. */
export interface Material {
    stiffness: number;
    /** Default: 0. */
    damping?: number;
}

/** Within how far of a ray things are met. */
export interface PickOptions {
    /** m, at the ray's origin. Default: 0. */
    radius?: number;
    /** By how much that grows with each metre. Default: 0.02, ten or so pixels in a usual picture. */
    spread?: number;
}

/** When a scene counts as settled. */
export interface SettleOptions {
    /** The largest force that may remain on any point, N. Default: a thousandth of the largest weight. */
    residualForce?: number;
    /** Steps after which to give up. Default: a million. */
    maxSteps?: number;
}

/** How a scene came to rest. */
export interface Settled {
    /** Steps that took; they count neither as steps nor as time of the run. */
    steps: number;
    /** The largest force that remains, N. */
    residualForce: number;
}

/** Parameters of the whole simulation: name, and what {@link Simulation.get} gives. */
export interface Parameters {
    /** Length of one step, s. */
    dt: number;
    /** Steps for each frame. */
    substeps: number;
    /** Gravitational acceleration, m/s². */
    gravity: [number, number, number];
    /** Ground planes. */
    planes: Plane[];
    /** Mass of each point, kg; zero is fixed in space. */
    mass: Float32Array;
    /** For each point whether it is pinned: 1 or 0. */
    pinned: Uint8Array;
    /** Stiffness of each spring, N/m. */
    stiffness: Float32Array;
    /** Damping along each spring, N·s/m. */
    damping: Float32Array;
    /** Rest length of each spring, m. */
    restLength: Float32Array;
    /** For each spring whether it is cut: 1 or 0. */
    cut: Uint8Array;
}

/**
 * A simulation.
 *
 * @example
 * ```js
 * const jelly = Simulation.builtin("jelly", { gravity: [0, -1.62, 0] });
 * jelly.set("stiffness", 500); // N/m, of all springs
 * jelly.pin(0);
 * for (let frame = 0; frame < 60; frame++) jelly.frame();
 * console.log(jelly.time, jelly.energy().total);
 * jelly.dispose();
 * ```
 */
export class Simulation {
    /** A scene that comes with the engine, by its name: see {@link scenes}. */
    static builtin(name: string, set?: Changes): Simulation;
    /**
     * The scene that a TOML text says; `docs/scene-format.md` explains every key. `file` is the name that errors give.
     *
     * @example
     * ```js
     * const rope = Simulation.parse(`
     *     [[body]]
     *     name = "rope"
     *     chain = { points = 20, step = [0.1, 0, 0] }
     *     point_mass = 0.05
     *     pins = ["start"]
     *     [[body.springs]]
     *     kinds = ["structural"]
     *     stiffness = 500
     *     damping = 0.1
     * `);
     * ```
     */
    static parse(scene: string, set?: Changes, file?: string): Simulation;
    private constructor();

    /** What the scene is called, in a few words. */
    readonly title: string;
    /** What there is to see. */
    readonly description: string;
    readonly pointCount: number;
    readonly springCount: number;
    /** Both points of every spring, the smaller index first: `springs[2 * spring]` and `springs[2 * spring + 1]`. */
    readonly springs: Uint32Array;
    /** The bodies; together they hold every point, in order. */
    readonly bodies: readonly Body[];
    readonly joints: readonly Joint[];
    /** Triangles to draw, of bodies that have some. */
    readonly surfaces: readonly Surface[];

    /** Takes so many steps of `dt`. Default: one. Throws a {@link BlowUpError} if the simulation blows up. */
    step(count?: number): void;
    /** Takes `substeps` steps of `dt`. */
    frame(): void;
    /**
     * Takes the steps that are due after so many more seconds, and gives how many those were; what is too short for a step waits
     * for the next call. Of a long pause, as of a page in the background, `most` seconds count. Default: 0.25 s.
     *
     * @example In step with the clock
     * ```js
     * let before = performance.now();
     * requestAnimationFrame(function draw(now) {
     *     cloth.advance((now - before) / 1000);
     *     before = now;
     *     paint(cloth.positions);
     *     requestAnimationFrame(draw);
     * });
     * ```
     */
    advance(seconds: number, most?: number): number;
    /** Back to how it began, bit for bit, parameters too. */
    reset(): void;
    /** Brings it to rest, without steps or time going on. */
    settle(options?: SettleOptions): Settled;

    /** Steps taken since the start. */
    readonly stepCount: number;
    /** Simulated time, s. */
    readonly time: number;

    /**
     * Positions, m: x, y and z of each point in turn.
     *
     * It is *one* array, the same for as long as the simulation lives, outside of the engine's memory. Once it was asked for, every
     * call that moves points fills it anew before it returns. So it may be kept, wrapped in a `BufferAttribute` of three.js, and
     * read at any time; it never dies and is never behind. (Only if its buffer is transferred to another thread, another array is
     * made when this is next read.) It is for reading: what is written to it moves no point.
     */
    readonly positions: Float32Array;
    /** Velocities, m/s, likewise. */
    readonly velocities: Float32Array;
    /** Copies the positions into an array of your own, with three numbers for each point, and gives it. */
    copyPositions<Target extends Float32Array>(target: Target): Target;
    /** Copies the velocities likewise. */
    copyVelocities<Target extends Float32Array>(target: Target): Target;
    /**
     * Lends views of the engine's own memory, which costs no copy, for as long as the function runs; gives what it gives. They are
     * worthless afterwards, as memory is used again and moves when it grows. Until the function returns, nothing of this package
     * can be called, and it must not be async: both are errors.
     *
     * @example
     * ```js
     * const lowest = cloth.withViews((positions) => {
     *     let lowest = Infinity;
     *     for (let y = 1; y < positions.length; y += 3) lowest = Math.min(lowest, positions[y]);
     *     return lowest;
     * });
     * ```
     */
    withViews<Result>(use: (positions: Float32Array, velocities: Float32Array) => Result): Result;

    /** The fingerprint of positions, velocities and step: 16 digits, the same on every machine and with the native program. */
    stateHash(): string;
    /** Where the energy is, and where it went. Costs about as much as a step. */
    energy(): Energy;
    /** Whether every force's work is summed for {@link energy}, at several times the cost of a step. Default: false. */
    keepsLedger: boolean;
    /** All three limits on dt, and what sets them. Takes a second for a million springs. */
    stability(): Stability;
    /** The certified limit alone, as quickly as three steps; less than 0.002 % below that of {@link stability}. */
    certifiedLimit(): Limit;

    /** A parameter as it is now: a copy. */
    get<Name extends keyof Parameters>(name: Name): Parameters[Name];
    /** Mass (kg) of a point; stiffness (N/m), damping (N·s/m) or rest length (m) of a spring. */
    get(name: "mass" | "stiffness" | "damping" | "restLength", of: number): number;
    /** Whether a point is pinned, or a spring is cut. */
    get(name: "pinned" | "cut", of: number): boolean;

    /** Length of one step, s; "auto" is the largest that is safely stable. */
    set(name: "dt", seconds: number | "auto"): void;
    /** Steps for each frame. */
    set(name: "substeps", steps: number): void;
    /** Gravitational acceleration, m/s². */
    set(name: "gravity", acceleration: Vector): void;
    /** All ground planes. */
    set(name: "planes", planes: readonly PlaneOptions[]): void;
    /** Mass of some points, kg; zero fixes them in space. Default: of all. */
    set(name: "mass", kilograms: number, where?: PointsWhere): void;
    /** Stiffness of some springs, N/m. Default: of all. */
    set(name: "stiffness", newtonsPerMetre: number, where?: SpringsWhere): void;
    /** Damping along some springs, N·s/m. Default: of all. */
    set(name: "damping", newtonSecondsPerMetre: number, where?: SpringsWhere): void;
    /** Rest length of some springs, as a multiple of the length they were built with. Default: of all. */
    set(name: "restScale", factor: number, where?: SpringsWhere): void;

    /** Fixes points where they are. */
    pin(where: PointsWhere): void;
    /** Frees them. */
    unpin(where: PointsWhere): void;
    /** Cuts springs: they exert no force. */
    cut(where: SpringsWhere): void;
    /** Mends them. */
    mend(where: SpringsWhere): void;
    /** A constant force on a point from now on, N; zero takes it away. */
    force(point: number, force: Vector): void;
    /** Puts a point there at once, m, and at rest. */
    place(point: number, position: Vector): void;
    /** Carries a point along at this velocity, m/s, whatever pulls at it, until it is released. */
    carry(point: number, velocity: Vector): void;

    /**
     * What a ray meets: the point nearest to it, else the nearest spring, and nothing that a surface hides; `null` for nothing.
     *
     * @example Drag with the mouse, in three.js
     * ```js
     * let held = null;
     * canvas.addEventListener("pointerdown", (event) => {
     *     raycaster.setFromCamera(pointer(event), camera);
     *     held = jelly.pick(raycaster.ray.origin, raycaster.ray.direction);
     * });
     * canvas.addEventListener("pointermove", (event) => {
     *     if (held?.kind !== "point") return;
     *     raycaster.setFromCamera(pointer(event), camera);
     *     jelly.drag(held.index, raycaster.ray.at(held.distance, new Vector3()));
     * });
     * canvas.addEventListener("pointerup", () => {
     *     if (held?.kind === "point") jelly.release(held.index);
     *     held = null;
     * });
     * ```
     */
    pick(origin: Vector, direction: Vector, options?: PickOptions): Picked | null;
    /**
     * Pulls a point there by a spring, until it is released; a later call moves the other end. Without a spring of your own it is
     * as stiff as those at the point together, or less, so that dt stays within its limit.
     */
    drag(point: number, target: Vector, spring?: Material): void;
    /** Lets a point go that was dragged or carried. */
    release(point: number): void;

    /** Gives back the memory of this simulation. It cannot be used any more. Without this it is given back some time later. */
    dispose(): void;
    [Symbol.dispose](): void;
}

/** Points that were added together. */
export interface Points extends Iterable<number> {
    readonly first: number;
    readonly end: number;
    readonly count: number;
    /** The point at i, j, k along the axes of a chain, grid or lattice. */
    index(i: number, j?: number, k?: number): number;
    /**
     * The points of a side of a grid or lattice: left, right (along x), bottom, top (y), back, front (z), and edges and corners
     * such as "left-back"; of a chain "start" and "end".
     */
    side(name: string): Uint32Array;
}

/**
 * Collects points and springs, and makes simulations of them.
 *
 * @example A cloth that hangs at its upper edge
 * ```js
 * const builder = new Builder();
 * const cloth = builder.grid({ points: [30, 20], spacing: 0.1, plane: "xy", mass: 0.01 });
 * builder.connect(cloth, { kinds: ["structural", "shear"], stiffness: 80, damping: 0.05 });
 * builder.pin(cloth.side("top"));
 * const simulation = builder.simulation({ planes: [{ y: -1, stiffness: 100 }] });
 * ```
 */
export class Builder {
    constructor(options?: { title?: string });

    readonly pointCount: number;
    readonly springCount: number;

    /** Begins a body: what is added from here on belongs to it. Without one there is one, called "body". */
    body(name: string): void;
    /** Begins a joint: springs from here on may join any bodies. Bodies come first. */
    joint(name: string): void;

    /** Adds a point, m and kg; gives its index. Zero mass fixes it in space. Default: 1 kg. */
    point(position: Vector, options?: { mass?: number }): number;
    /** Adds points: a list of vectors, or all coordinates in a row. A mass for all, or one for each, kg. Default: 1 kg. */
    points(positions: readonly Vector[] | readonly number[] | Float32Array | Float64Array, options?: { mass?: number | ArrayLike<number> }): Points;
    /** Adds points in a row: the first at `origin`, each `step` from the one before, m. */
    chain(options: { points: number; step: Vector; origin?: Vector; mass?: number }): Points;
    /** Adds a flat sheet of points, with its surface: "xy" and "yz" stand upright, "xz" is level. Default: "xz". */
    grid(options: { points: readonly [number, number]; spacing: number; plane?: "xy" | "xz" | "yz"; origin?: Vector; mass?: number }): Points;
    /** Adds a block of points, with its skin: so many along x, y and z. */
    lattice(options: { points: readonly [number, number, number]; spacing: number; origin?: Vector; mass?: number }): Points;

    /**
     * Joins neighbours in a chain, grid or lattice: along its axes (structural), across its squares (shear), two apart (bend).
     * Gives the range of springs.
     */
    connect(points: Points, options: Material & { kinds: readonly ("structural" | "shear" | "bend")[] }): Range;
    /** Joins all points that are no further apart than `radius`, m. */
    connectWithin(points: Points | Readonly<Range>, radius: number, material: Material): Range;
    /** Joins all points of `a` to all of `b` that are no further apart than `radius`, m. */
    connectBetween(a: Points | Readonly<Range>, b: Points | Readonly<Range>, radius: number, material: Material): Range;
    /** Joins two points; gives the spring. Its rest length (m) is their distance, unless said otherwise. */
    spring(a: number, b: number, options: Material & { restLength?: number }): number;
    /** Joins pairs of points. */
    springs(pairs: Iterable<readonly [number, number]>, options: Material & { restLength?: number }): Range;

    /** Fixes points in space. */
    pin(points: number | Iterable<number>): void;
    /** First velocity of points, m/s. */
    velocity(points: number | Iterable<number>, velocity: Vector): void;
    /** A surface of the current body, for drawing: three points for each triangle. Default: "cloth". */
    surface(triangles: Uint32Array | readonly number[] | readonly (readonly [number, number, number])[], kind?: "cloth" | "skin"): void;

    /** A simulation of all that was added; more can be added afterwards, for another one. */
    simulation(options?: {
        /** Length of one step, s; "auto" is the largest that is safely stable, and no more than 0.01 s. Default: "auto". */
        dt?: number | "auto";
        /** Steps for each frame. Default: 1. */
        substeps?: number;
        /** m/s². Default: [0, -9.81, 0]. */
        gravity?: Vector;
        /** Default: none. */
        planes?: readonly PlaneOptions[];
    }): Simulation;

    /** Gives back its memory. Simulations that it made are not touched. */
    dispose(): void;
    [Symbol.dispose](): void;
}

/**
 * Starts a simulation in a thread of its own: a Web Worker, or a worker thread of Node.js. Its scene is a built-in one by its
 * name, or `{ text }`.
 *
 * @example The page stays responsive, however large the scene is
 * ```js
 * const cloth = await spawn("cloth512");
 * geometry.setAttribute("position", new BufferAttribute(cloth.positions, 3));
 * renderer.setAnimationLoop(() => {
 *     if (!cloth.busy) cloth.advance(1 / 60).catch(show);
 *     geometry.attributes.position.needsUpdate = true;
 *     renderer.render(scene, camera);
 * });
 * ```
 */
export function spawn(
    scene: string | { text: string },
    options?: {
        /** Changes of the scene before it is built. */
        set?: Changes;
        /** The name of the scene's text that errors give. */
        file?: string;
        /** Whether velocities are wanted too. Default: false. */
        velocities?: boolean;
    },
): Promise<SimulationInWorker>;

/** A function over there: the same, but for a promise of what it gives. */
type Remote<Method> = Method extends (...args: infer Arguments) => infer Result ? (...args: Arguments) => Promise<Result> : never;

/**
 * A simulation in a thread of its own. Its methods are those of {@link Simulation} and give promises; they are done in the order
 * in which they are called. `positions`, `velocities`, `stepCount` and `time` are those of the last answer: the same arrays for
 * as long as it lives, which change only between two turns of the page's own loop, never while your code runs.
 */
export class SimulationInWorker {
    private constructor();

    readonly title: string;
    readonly description: string;
    readonly pointCount: number;
    readonly springCount: number;
    readonly springs: Uint32Array;
    readonly bodies: readonly Body[];
    readonly joints: readonly Joint[];
    readonly surfaces: readonly Surface[];
    readonly stepCount: number;
    readonly time: number;
    readonly positions: Float32Array;
    /** Only if they were asked for: `spawn(scene, { velocities: true })`. */
    readonly velocities: Float32Array;
    /** Whether answers are still to come. */
    readonly busy: boolean;

    step: Remote<Simulation["step"]>;
    frame: Remote<Simulation["frame"]>;
    advance: Remote<Simulation["advance"]>;
    reset: Remote<Simulation["reset"]>;
    settle: Remote<Simulation["settle"]>;
    stateHash: Remote<Simulation["stateHash"]>;
    energy: Remote<Simulation["energy"]>;
    keepLedger(on: boolean): Promise<void>;
    stability: Remote<Simulation["stability"]>;
    certifiedLimit: Remote<Simulation["certifiedLimit"]>;
    get<Name extends keyof Parameters>(name: Name): Promise<Parameters[Name]>;
    get(name: "mass" | "stiffness" | "damping" | "restLength", of: number): Promise<number>;
    get(name: "pinned" | "cut", of: number): Promise<boolean>;
    set(name: "dt", seconds: number | "auto"): Promise<void>;
    set(name: "substeps", steps: number): Promise<void>;
    set(name: "gravity", acceleration: Vector): Promise<void>;
    set(name: "planes", planes: readonly PlaneOptions[]): Promise<void>;
    set(name: "mass", value: number, where?: PointsWhere): Promise<void>;
    set(name: "stiffness" | "damping" | "restScale", value: number, where?: SpringsWhere): Promise<void>;
    pin: Remote<Simulation["pin"]>;
    unpin: Remote<Simulation["unpin"]>;
    cut: Remote<Simulation["cut"]>;
    mend: Remote<Simulation["mend"]>;
    force: Remote<Simulation["force"]>;
    place: Remote<Simulation["place"]>;
    carry: Remote<Simulation["carry"]>;
    pick: Remote<Simulation["pick"]>;
    drag: Remote<Simulation["drag"]>;
    release: Remote<Simulation["release"]>;

    /** Ends the thread. Whatever is still waited for is rejected. */
    dispose(): void;
    [Symbol.dispose](): void;
}

/** What kind of thing went wrong; stable names to match on. */
export type ErrorCode =
    | "Syntax"
    | "WrongType"
    | "MissingField"
    | "UnknownKey"
    | "OutOfRange"
    | "NotFound"
    | "Duplicate"
    | "Conflict"
    | "TooLarge"
    | "Unreadable"
    | "Unsupported"
    | "NotSettled"
    | "BlewUp";

/** An error. Its `message` is one sentence, the same as the command's, with the place and the fix; here are its parts. */
export class SprungError extends Error {
    constructor(message: string, parts?: Partial<Pick<SprungError, "code" | "sentence" | "file" | "line" | "column" | "field" | "fix">>);
    readonly code: ErrorCode;
    /** What was found and what is allowed, without the place and the fix. */
    readonly sentence: string;
    /** The scene's file, or the change, such as `--set dt=x`. */
    readonly file?: string;
    /** Line and column in it, from 1. */
    readonly line?: number;
    readonly column?: number;
    /** The field, such as `body[0].springs[1].stiffness`. */
    readonly field?: string;
    /** What would mend it, where that is known. */
    readonly fix?: string;
}

/** The simulation blew up, most likely since dt is too large. Its last good state is the current one. */
export class BlowUpError extends SprungError {
    readonly code: "BlewUp";
    /** How it showed: a position that is no number any more, or energy from nowhere. */
    readonly reason: "not-finite" | "energy-from-nowhere";
    /** Energy from nowhere, J. */
    readonly excess?: number;
    /** The step and time (s) at which it was noticed. */
    readonly step: number;
    readonly time: number;
    /** Those of the last good state. */
    readonly goodStep: number;
    readonly goodTime: number;
    /** The spring that sets the limit there, if one does; its points, or the one whose contact or drag sets it. */
    readonly spring?: number;
    readonly points: number[];
    /** The same in words. */
    readonly place: string;
    /** The length of the step, and the limits that it is held against, s. */
    readonly dt: number;
    readonly certifiedLimit?: number;
    readonly everyConfigurationLimit?: number;
    /** A length of the step that mends it, s. */
    readonly suggestedDt?: number;
    /** By how much to multiply all damping so that dt would do, where damping is to blame. */
    readonly suggestedDampingScale?: number;
}
