// sprung in a browser, or wherever `fetch` and `Worker` are those of a browser. Node.js begins at node.js instead.

import { load } from "./engine-door.js";
import { spawnIn } from "./in-worker.js";

export { Builder } from "./builder.js";
export { BlowUpError, SprungError } from "./errors.js";
export { SimulationInWorker } from "./in-worker.js";
export { memoryBytes, scenes, version } from "./scenes.js";
export { Simulation } from "./simulation.js";

// Bundlers look for these two lines as they stand.
const wasm = () => new URL("./engine_bg.wasm", import.meta.url);
const worker = () => new Worker(new URL("./worker.js", import.meta.url), { type: "module" });

export function init(source) {
    return load(() => source ?? wasm());
}

export async function spawn(scene, options) {
    await init();
    return spawnIn(worker, scene, options);
}
