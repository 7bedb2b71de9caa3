// web/worker.js in Node.js: messages come from standard input and go to standard output, each after its length.
// The page's end is page.rs.

import { readFile } from "node:fs/promises";
import { pathToFileURL } from "node:url";
import { writeSync } from "node:fs";

const folder = process.argv[2];

function write(bytes) {
  const length = new Uint8Array(4);
  new DataView(length.buffer).setUint32(0, bytes.length, true);
  for (let rest of [length, bytes]) {
    while (rest.length > 0) {
      try {
        rest = rest.subarray(writeSync(1, rest));
      } catch (error) {
        if (error.code !== "EAGAIN") throw error;
      }
    }
  }
}

// What a worker has, and Node.js has not.
globalThis.self = globalThis;
globalThis.fetch = async (url) => {
  const bytes = await readFile(new URL(url));
  return new Response(bytes, { headers: { "Content-Type": "application/wasm" } });
};
globalThis.postMessage = (data) => {
  if (data.ended === undefined) return write(new Uint8Array(data));
  process.stderr.write(data.ended);
  process.exit(1);
};

await import(pathToFileURL(`${folder}/worker.js`));

let come = Buffer.alloc(0);
process.stdin.on("data", (piece) => {
  come = Buffer.concat([come, piece]);
  while (come.length >= 4 && come.length >= 4 + come.readUInt32LE(0)) {
    const end = 4 + come.readUInt32LE(0);
    globalThis.onmessage({ data: new Uint8Array(come.subarray(4, end)).buffer });
    come = come.subarray(end);
  }
});
process.stdin.on("end", () => process.exit(0));
