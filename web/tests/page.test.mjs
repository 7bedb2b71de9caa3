// The page in a real browser, as people use it: `cargo xtask web`.

import assert from "node:assert/strict";
import { createServer } from "node:http";
import { mkdtemp, readFile, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { extname, join, normalize } from "node:path";
import { after, before, test } from "node:test";

import { chromium } from "playwright-core";

const PAGE = process.env.SPRUNG_PAGE;
const ROOT = process.env.SPRUNG_ROOT;
const BROWSER = process.env.SPRUNG_BROWSER ?? "/usr/bin/chromium";

const TYPES = {
  ".html": "text/html",
  ".js": "text/javascript",
  ".css": "text/css",
  ".json": "application/json",
  ".svg": "image/svg+xml",
  ".wasm": "application/wasm",
  ".webmanifest": "application/manifest+json",
};

// A server as strict as one can be; `asked` has what was asked of it.
const asked = [];
const server = createServer(async (request, response) => {
  const path = normalize(new URL(request.url, "http://localhost").pathname);
  asked.push(path);
  try {
    const file = path === "/" ? "index.html" : path.slice(1);
    const bytes = await readFile(join(PAGE, file));
    response.writeHead(200, {
      "Content-Type": TYPES[extname(file)] ?? "application/octet-stream",
      "Content-Security-Policy":
        "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self'; style-src 'self'; " +
        "img-src 'self' blob: data:; connect-src 'self'; manifest-src 'self'; frame-ancestors 'none'",
    });
    response.end(bytes);
  } catch {
    response.writeHead(404).end();
  }
});

const SOFTWARE = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
const WAYS = {
  WebGL2: [...SOFTWARE, "--disable-features=WebGPU"],
  WebGPU: [
    ...SOFTWARE,
    "--enable-unsafe-webgpu",
    "--use-webgpu-adapter=swiftshader",
    "--use-vulkan=swiftshader",
    "--enable-features=Vulkan",
  ],
};

let address;
const browsers = {};

before(async () => {
  await new Promise((done) => server.listen(0, "127.0.0.1", done));
  address = `http://localhost:${server.address().port}/`;
  for (const [way, args] of Object.entries(WAYS)) {
    browsers[way] = await chromium.launch({ executablePath: BROWSER, args });
  }
});

after(async () => {
  await Promise.all(Object.values(browsers).map((browser) => browser.close()));
  server.close();
});

// A page of its own, with an eye on everything that goes wrong in it.
async function opened(way = "WebGL2", { fragment = "", ...options } = {}) {
  const context = await browsers[way].newContext({
    viewport: { width: 1100, height: 700 },
    permissions: ["clipboard-read", "clipboard-write"],
    ...options,
  });
  const page = await context.newPage();
  const wrong = [];
  page.on("console", (message) => {
    if (message.type() === "error") wrong.push(message.text());
  });
  page.on("pageerror", (error) => wrong.push(String(error)));
  page.on("request", (request) => {
    const url = new URL(request.url());
    if (!["localhost", ""].includes(url.hostname)) wrong.push(`asked for ${url}`);
  });
  await page.goto(address + fragment);
  await page.waitForSelector("#loading", { state: "hidden", timeout: 120_000 });
  return { context, page, wrong };
}

async function titled(page, title) {
  await page.waitForFunction((title) => document.title === title, title, { timeout: 60_000 });
}

async function press(page, ...keys) {
  await page.focus("canvas");
  for (const key of keys) await page.keyboard.press(key, { delay: 30 });
}

for (const way of Object.keys(WAYS)) {
  test(`it loads and moves with ${way}`, async () => {
    const { context, page, wrong } = await opened(way);
    await titled(page, "jelly – sprung");
    const drawn = await page.evaluate(() => "gpu" in navigator && navigator.gpu.requestAdapter().then((it) => it !== null));
    assert.equal(drawn, way === "WebGPU");
    await page.waitForTimeout(1500);
    await press(page, "Space");
    await titled(page, "jelly, paused – sprung");
    const picture = await page.screenshot({ path: join(tmpdir(), `sprung-${way}.png`) });
    assert.ok(picture.length > 30_000, `the picture has ${picture.length} bytes: it is blank`);
    assert.deepEqual(wrong, []);
    await context.close();
  });
}
