// The one way to the WebAssembly: loading it, calling it, and lending views of its memory.

import start from "./engine.js";
import { errorOf, mistake, SprungError } from "./errors.js";

let loading; // a promise, from the first call of `load` on
let loaded; // what the module exports, once it is there
let compiled; // the module itself, which workers are given
let fault; // why the engine cannot be used any more
let lent = 0; // how many callers are looking at its memory right now

/**
 * Loads the engine once, however often this is called. `source` is a function that gives a URL, a `Response`, bytes, or a
 * compiled module, or a promise of one of these.
 */
export function load(source) {
    loading ??= begin(source).catch((error) => {
        loading = undefined; // the next call tries anew
        throw error;
    });
    return loading;
}

async function begin(source) {
    compiled = await compile(await source());
    loaded = await start({ module_or_path: compiled });
}

async function compile(source) {
    try {
        if (source instanceof WebAssembly.Module) return source;
        if (typeof source === "string" || source instanceof URL) source = await fetched(source);
        // Not compiled while it streams in: that asks servers for a type which not all of them send.
        const bytes = source instanceof Response ? await source.arrayBuffer() : source;
        return await WebAssembly.compile(bytes);
    } catch (error) {
        if (error instanceof SprungError) throw error;
        const sentence = `the engine cannot be compiled here: ${error.message}`;
        throw mistake("Unsupported", undefined, sentence, "use an engine with WebAssembly SIMD, such as Node.js 20 or a browser of 2023");
    }
}

async function fetched(url) {
    const sentence = (why) => mistake("Unreadable", undefined, `the engine cannot be loaded from ${url}: ${why}`, "pass init() the place where engine_bg.wasm lies");
    let response;
    try {
        response = await fetch(url);
    } catch (error) {
        throw sentence(error.message);
    }
    if (!response.ok) throw sentence(`the server answers ${response.status}`);
    return response;
}

/** The compiled module, for a worker. */
export function engineModule() {
    return compiled;
}

/** Calls the engine; what it throws becomes one of our errors. */
export function call(act) {
    check();
    try {
        return act();
    } catch (error) {
        throw translated(error);
    }
}

/** Gives back what an object has in the engine's memory. */
export function free(object) {
    // Of an engine that has stopped nothing can be given back, and nobody needs to hear that when cleaning up.
    if (fault === undefined) call(() => object.free());
}

function check() {
    if (loaded === undefined) {
        throw mistake("Unsupported", undefined, "the engine is not loaded yet", "call `await init()` first");
    }
    if (fault !== undefined) throw fault;
    if (lent > 0) {
        const sentence = "the engine cannot be called while views of its memory are lent out";
        throw mistake("Conflict", undefined, sentence, "return from the function given to withViews first");
    }
}

function translated(error) {
    if (error?.parts) return errorOf(error.message, error.parts);
    if (error instanceof WebAssembly.RuntimeError) {
        // Nothing is known about its memory from here on.
        fault = new SprungError(`the engine has stopped, most likely for want of memory (${error.message}); load it anew`, { code: "TooLarge" });
        return fault;
    }
    return error;
}

/** Calls a function with views of the engine's memory, during which the engine stands still. */
export function lend(places, length, use) {
    // Made only now: whenever memory grows, all views of it die.
    const views = Array.from(places, (place) => new Float32Array(loaded.memory.buffer, place, length));
    lent++;
    try {
        const result = use(...views);
        if (typeof result?.then === "function") {
            const sentence = "the function given to withViews gives a promise, and the views do not live that long";
            throw mistake("Conflict", undefined, sentence, "let it not be async, and copy what is needed later");
        }
        return result;
    } finally {
        lent--;
    }
}

/** Bytes of the engine's memory. */
export function memoryBytes() {
    check();
    return loaded.memory.buffer.byteLength;
}
