// sprung in Node.js. It differs from index.js in where the engine is read from, and in how a thread is started.

import { readFile } from "node:fs/promises";
import { Worker } from "node:worker_threads";

import { load } from "./engine-door.js";
import { spawnIn } from "./in-worker.js";

export { Builder } from "./builder.js";
export { BlowUpError, SprungError } from "./errors.js";
export { SimulationInWorker } from "./in-worker.js";
export { memoryBytes, scenes, version } from "./scenes.js";
export { Simulation } from "./simulation.js";

export function init(source) {
    return load(() => source ?? readFile(new URL("./engine_bg.wasm", import.meta.url)));
}

export async function spawn(scene, options) {
    await init();
    return spawnIn(() => asInBrowsers(new Worker(new URL("./node-worker.js", import.meta.url))), scene, options);
}

/** Node's worker with the names that a browser's has. */
function asInBrowsers(worker) {
    // A program may end while a simulation waits in its thread.
    worker.unref();
    const doors = {
        postMessage: (message, transfer) => worker.postMessage(message, transfer),
        terminate: () => void worker.terminate(),
        /** While an answer is waited for, the program does not end. */
        waiting: (on) => (on ? worker.ref() : worker.unref()),
    };
    worker.on("message", (data) => doors.onmessage?.({ data }));
    worker.on("messageerror", (error) => doors.onerror?.({ message: error.message }));
    worker.on("error", (error) => doors.onerror?.({ message: error.message }));
    worker.on("exit", (code) => doors.onerror?.({ message: `it ended with ${code}` }));
    return doors;
}
