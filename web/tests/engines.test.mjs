// The page in the engines of Firefox and Safari: `cargo xtask web`. What it does is tested in Chromium; that it does the same here, by
// what differs between engines: drawing, keys, files, workers, WebAssembly and what is kept.

import assert from "node:assert/strict";
import { readFile, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { setTimeout as wait } from "node:timers/promises";

import { firefox, webkit } from "./browsers.mjs";
import { hashes, printed } from "./hashes.mjs";
import { serve } from "./server.mjs";

const ROOT = process.env.SPRUNG_ROOT;

let server;
before(async () => {
  server = await serve(process.env.SPRUNG_PAGE);
});
after(() => server.close());

async function titled(browser, title) {
  const read = async () => document.title;
  let found = "";
  for (let tries = 0; tries < 600 && found !== title; tries += 1) {
    await wait(200);
    found = await browser.run(read).catch(() => "");
  }
  assert.equal(found, title);
}

// Drops a file onto the page.
async function drop({ name, text }) {
  const transfer = new DataTransfer();
  transfer.items.add(new File([text], name));
  const canvas = document.querySelector("canvas");
  for (const kind of ["dragenter", "dragover", "drop"]) {
    canvas.dispatchEvent(new DragEvent(kind, { dataTransfer: transfer, bubbles: true, cancelable: true }));
  }
}

// Notes what goes wrong in the page from now on.
async function watch() {
  window.wrong = [];
  for (const kind of ["error", "unhandledrejection", "securitypolicyviolation"]) {
    addEventListener(kind, (event) => window.wrong.push(String(event.message ?? event.reason ?? event.violatedDirective)));
  }
}

for (const [engine, open] of Object.entries({ firefox, webkit })) {
  test(`the page in ${engine}`, { timeout: 600_000 }, async (context) => {
    const browser = await open();
    if (!browser) return context.skip("it is not installed, or there is no display");
    try {
      await browser.go(`${server.address}#scene=chain`);
      await titled(browser, "chain – sprung");
      await browser.run(watch);
      await browser.press(" ");
      await titled(browser, "chain, paused – sprung");
      await browser.press("3");
      await titled(browser, "jelly – sprung");
      // Long enough for pictures: one that is blank packs into little.
      await wait(2000);
      const picture = await browser.picture();
      await writeFile(join(tmpdir(), `sprung-${engine}.png`), picture);
      assert.ok(picture.length > 20_000, `the picture has ${picture.length} bytes: it is blank`);

      await browser.run(drop, { name: "bad.toml", text: "dt = -1\n" });
      await titled(browser, "jelly, card: That did not work – sprung");
      await browser.press("Escape");
      await titled(browser, "jelly – sprung");
      const text = await readFile(join(ROOT, "scenes/jelly.toml"), "utf8");
      await browser.run(drop, { name: "mine.toml", text: text.replace(/^dt = .*$/m, "dt = 0.02") });
      await titled(browser, "mine, blew up – sprung");
      await browser.press("Enter");
      await titled(browser, "mine – sprung");

      const goldens = JSON.parse(await readFile(join(ROOT, "crates/sprung/goldens.json"), "utf8"));
      const found = await browser.run(hashes, goldens);
      console.log(printed(goldens, found, browser.name));
      assert.deepEqual(found, goldens);
      assert.deepEqual(await browser.run(async () => window.wrong), []);

      // What was open comes back, and without the server.
      await browser.run(() => navigator.serviceWorker.ready.then(() => true));
      await browser.go("about:blank");
      server.close();
      await browser.go(server.address);
      await titled(browser, "mine – sprung");
    } finally {
      await browser.close();
      server.close();
      server = await serve(process.env.SPRUNG_PAGE);
    }
  });
}
