// Runs a program built for wasm32-wasip1: `node xtask/wasi.mjs PROGRAM.wasm [ARGUMENT…]`, from any folder of the repository.
// It may read the repository, at the path that it has outside, and nothing else.

import { readFile } from "node:fs/promises";
import { dirname } from "node:path";
import { fileURLToPath } from "node:url";
import { WASI } from "node:wasi";

const repository = dirname(dirname(fileURLToPath(import.meta.url)));
const [path, ...programArguments] = process.argv.slice(2);

const wasi = new WASI({
    version: "preview1",
    args: [path, ...programArguments],
    preopens: { [repository]: repository },
});
// Through functions of our own: what Node.js calls for WebAssembly without a detour can crash when memory is cleaned up
// meanwhile (https://github.com/nodejs/node/issues/53087).
const doors = Object.entries(wasi.wasiImport).map(([name, call]) => [name, (...values) => call(...values)]);
const imports = { wasi_snapshot_preview1: Object.fromEntries(doors) };
const program = await WebAssembly.compile(await readFile(path));
process.exitCode = wasi.start(await WebAssembly.instantiate(program, imports));
