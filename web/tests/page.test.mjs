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

// What the canvas shows, as a picture.
async function drawn(page, name) {
  const picture = await page.screenshot({ path: join(tmpdir(), `sprung-${name}.png`) });
  assert.ok(picture.length > 20_000, `${name} has ${picture.length} bytes: it is blank`);
  return picture;
}

for (const way of Object.keys(WAYS)) {
  test(`it loads and moves with ${way}`, async () => {
    const { context, page, wrong } = await opened(way);
    await titled(page, "jelly – sprung");
    const has = await page.evaluate(async () => "gpu" in navigator && (await navigator.gpu.requestAdapter()) !== null);
    assert.equal(has, way === "WebGPU");
    await press(page, "Space");
    await titled(page, "jelly, paused – sprung");
    await drawn(page, way);
    assert.deepEqual(wrong, []);
    await context.close();
  });
}

test("every scene of the report opens and plays, and steps", async () => {
  const { context, page, wrong } = await opened();
  for (const [key, name] of [["1", "spring"], ["2", "chain"], ["4", "cloth"], ["3", "jelly"]]) {
    await press(page, key);
    await titled(page, `${name} – sprung`);
    await press(page, "s");
    await titled(page, `${name}, paused – sprung`);
    await drawn(page, name);
  }
  assert.deepEqual(wrong, []);
  await context.close();
});

test("a link is a scene, there and back", async () => {
  const { context, page, wrong } = await opened("WebGL2", { fragment: "#scene=chain&view=0,-2,0,14,0.3,0.2" });
  await titled(page, "chain – sprung");
  await press(page, "Space");
  await titled(page, "chain, paused – sprung");
  await press(page, "Control+l");
  const link = await page.waitForFunction(() => navigator.clipboard.readText().then((text) => text.includes("#") && text));
  const { hash } = new URL(await link.jsonValue());
  assert.match(hash, /^#v=[0-9.]+&scene=chain&view=0,-2,0,14,0\.3,0\.2$/);
  await context.close();
  const again = await opened("WebGL2", { fragment: hash });
  await titled(again.page, "chain – sprung");
  assert.deepEqual([...wrong, ...again.wrong], []);
  await again.context.close();
});

test("a hostile link is refused with a sentence, and the page goes on", async () => {
  const { context, page, wrong } = await opened("WebGL2", { fragment: "#toml=AAAA" });
  await titled(page, "jelly, card: That did not work – sprung");
  await press(page, "Escape");
  await titled(page, "jelly – sprung");
  assert.deepEqual(wrong, []);
  await context.close();
});

test("it works without a network after the first visit", async () => {
  const { context, page, wrong } = await opened();
  await page.waitForFunction(() => navigator.serviceWorker.ready.then(({ active }) => active.state === "activated"));
  await context.setOffline(true);
  await page.reload();
  await page.waitForSelector("#loading", { state: "hidden", timeout: 120_000 });
  await titled(page, "jelly – sprung");
  assert.deepEqual(wrong, []);
  await context.close();
});

test("it is a phone's page, too", async () => {
  const { context, page, wrong } = await opened("WebGL2", {
    viewport: { width: 390, height: 844 },
    deviceScaleFactor: 2,
    hasTouch: true,
    isMobile: true,
  });
  await titled(page, "jelly – sprung");
  await drawn(page, "phone");
  await page.touchscreen.tap(24, 20);
  await titled(page, "jelly, paused – sprung");
  await page.setViewportSize({ width: 844, height: 390 });
  await page.waitForTimeout(500);
  await drawn(page, "phone-across");
  assert.deepEqual(wrong, []);
  await context.close();
});
