// A simulation that runs in another thread, from this side: the same methods, which give promises.

import { engineModule } from "./engine-door.js";
import { mistake, unpackedError } from "./errors.js";
import { flag, options, text } from "./values.js";

const OURS = Symbol("made by spawn");

/** Methods of a simulation that are called over there. */
const METHODS = [
    ..."step frame advance reset settle stateHash energy stability certifiedLimit get set".split(" "),
    ..."pin unpin cut mend force place carry pick drag release keepLedger".split(" "),
];

/** What `spawn` may do, and nobody else. */
let callOf;

/** A simulation in a thread of its own. The types in index.d.ts say what everything means. */
export class SimulationInWorker {
    #worker;
    #waiting = new Map(); // what to do with each answer
    #next = 0;
    #arrays = {}; // what the user sees: the same arrays for ever
    #returned = {}; // arrays that came with the last answer, to be filled again
    #end; // the error with which everything ends

    constructor(key, worker) {
        if (key !== OURS) {
            throw mistake("Unsupported", undefined, "a simulation in a worker is not made with new", "use `await spawn(…)`");
        }
        this.#worker = worker;
        worker.onmessage = ({ data }) => this.#answered(data);
        worker.onerror = ({ message }) => {
            this.#stop(mistake("Unsupported", undefined, `the simulation's worker has stopped: ${message || "it could not be started"}`));
        };
        worker.onmessageerror = worker.onerror;
    }

    /** Whether answers are still to come. */
    get busy() {
        return this.#waiting.size > 0;
    }

    get positions() {
        return this.#array("positions");
    }

    get velocities() {
        return this.#array("velocities");
    }

    dispose() {
        this.#stop(mistake("Conflict", undefined, "this simulation was disposed of, and cannot be used any more"));
    }

    static {
        callOf = (simulation, method, args) => simulation.#call(method, args);
        for (const method of METHODS) {
            this.prototype[method] = function (...args) {
                return this.#call(method, args);
            };
        }
    }

    /** Calls a method over there. */
    #call(method, args) {
        if (this.#end !== undefined) return Promise.reject(this.#end);
        const id = this.#next++;
        const returned = this.#returned;
        this.#returned = {};
        try {
            this.#worker.postMessage({ id, method, args: args.map(plain), returned }, Object.values(returned).map((array) => array.buffer));
        } catch (error) {
            // Something that cannot be sent, such as a function.
            return Promise.reject(mistake("WrongType", method, `cannot be given this: ${error.message}`));
        }
        this.#worker.waiting?.(true);
        return new Promise((resolve, reject) => this.#waiting.set(id, { resolve, reject }));
    }

    #answered({ id, value, error, now }) {
        const { resolve, reject } = this.#waiting.get(id);
        this.#waiting.delete(id);
        if (!this.busy) this.#worker.waiting?.(false);
        if (now !== undefined) this.#take(now);
        if (error === undefined) resolve(value);
        else reject(unpackedError(error));
    }

    #take({ stepCount, time, arrays }) {
        Object.assign(this, { stepCount, time });
        for (const [name, array] of Object.entries(arrays)) {
            // One that was transferred to somebody else is empty.
            if (this.#arrays[name]?.length !== array.length) this.#arrays[name] = new Float32Array(array.length);
            this.#arrays[name].set(array);
            this.#returned[name] = array;
        }
    }

    #array(name) {
        if (this.#arrays[name] === undefined) {
            throw mistake("Conflict", name, "are not sent by this worker", "spawn it with { velocities: true }");
        }
        return this.#arrays[name];
    }

    #stop(error) {
        if (this.#end !== undefined) return;
        this.#end = error;
        this.#worker.terminate();
        this.#waiting.forEach(({ reject }) => reject(error));
        this.#waiting.clear();
    }
}

if (Symbol.dispose) SimulationInWorker.prototype[Symbol.dispose] = SimulationInWorker.prototype.dispose;

/** Vectors of three.js, and what else has x, y and z, would lose their class on the way, and that is all that they need. */
function plain(value) {
    return typeof value?.x === "number" ? { x: value.x, y: value.y, z: value.z } : value;
}

/** Starts a worker and has it make a simulation: of a built-in scene by its name, or of a scene's text. */
export async function spawnIn(start, scene, given) {
    const { set, file, velocities = false } = options(given, "spawn", ["set", "file", "velocities"]);
    const isText = typeof scene === "object" && scene !== null;
    const wanted = isText ? { text: text(options(scene, "scene", ["text"]).text, "text"), file, set } : { builtin: text(scene, "scene"), set };
    const simulation = new SimulationInWorker(OURS, start());
    try {
        const begin = { module: engineModule(), scene: wanted, velocities: flag(velocities, "velocities") };
        Object.assign(simulation, await callOf(simulation, "begin", [begin]));
        return simulation;
    } catch (error) {
        simulation.dispose();
        throw error;
    }
}
