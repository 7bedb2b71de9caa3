// What a second thread would bring in WebAssembly: the engine's example `asked`, built for WASI with threads, in Node.js.
//
//     rustup target add wasm32-wasip1-threads
//     RUSTFLAGS=-Ctarget-feature=+simd128 cargo build --release -p sprung --features rayon --example asked \
//         --target wasm32-wasip1-threads
//     node bench/wasm_threads.mjs target/wasm32-wasip1-threads/release/examples/asked.wasm [SCENE…]
import { existsSync, readFileSync } from "node:fs";
import { WASI } from "node:wasi";
import { Worker, isMainThread, workerData } from "node:worker_threads";

// Most that such a module asks for: 1 GiB, in pages of 64 KiB.
const MOST_PAGES = 16384;

let threads = 0;

// The module on this thread, with memory that all threads share.
function instance(module, memory, wasi) {
  const spawn = (argument) => {
    threads += 1;
    new Worker(new URL(import.meta.url), { workerData: { module, memory, thread: threads, argument } }).unref();
    return threads;
  };
  return new WebAssembly.Instance(module, {
    ...wasi.getImportObject(),
    env: { memory },
    wasi: { "thread-spawn": spawn },
  });
}

// Node.js knows how to start a program, and not that a thread of one begins elsewhere.
function start(wasi, memory, begin) {
  return wasi.start({ exports: { memory, _start: begin } });
}

if (isMainThread) {
  const [file, ...scenes] = process.argv.slice(2);
  if (!file || !existsSync(file)) {
    console.error(`${file ?? "no module"}: say which module to run, built as this file says at its beginning`);
    process.exit(2);
  }
  const module = new WebAssembly.Module(readFileSync(file));
  const memory = new WebAssembly.Memory({ initial: 256, maximum: MOST_PAGES, shared: true });
  const wasi = new WASI({ version: "preview1", args: ["asked", ...scenes] });
  const program = instance(module, memory, wasi);
  process.exit(start(wasi, memory, program.exports._start));
} else {
  const { module, memory, thread, argument } = workerData;
  const wasi = new WASI({ version: "preview1" });
  const program = instance(module, memory, wasi);
  start(wasi, memory, () => program.exports.wasi_thread_start(thread, argument));
}
