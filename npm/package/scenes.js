// What comes with the engine.

import * as engine from "./engine.js";
import { call, memoryBytes } from "./engine-door.js";

export { memoryBytes };

export function scenes() {
    return call(() => engine.scenes());
}

export function version() {
    return call(() => engine.version());
}
