// The page in a real browser, as people use it: `cargo xtask web`.

import assert from "node:assert/strict";
import { readFile, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";

import { chromium } from "playwright-core";

import { hashes, printed } from "./hashes.mjs";
import { serve } from "./server.mjs";

const PAGE = process.env.SPRUNG_PAGE;
const ROOT = process.env.SPRUNG_ROOT;
const BROWSER = process.env.SPRUNG_BROWSER ?? "/usr/bin/chromium";

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

// As a phone has them: with two pixels to a point, which a page's own emulation does only by half.
WAYS.phone = [...WAYS.WebGL2, "--force-device-scale-factor=2"];

// As where the graphics card's driver is on the browser's list of bad ones.
WAYS.neither = ["--disable-3d-apis", "--disable-features=WebGPU"];

let server;
const browsers = {};

before(async () => {
  server = await serve(PAGE);
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
  await page.goto(server.address + fragment);
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

// What the canvas shows once it changes no more, held against the picture of this name in pictures/; with
// SPRUNG_UPDATE_PICTURES it becomes that. Two pixels in a hundred may differ, as browsers draw from version to version, and
// as numbers that tell of speed do.
async function asStored(page, name) {
  let picture = await page.screenshot();
  for (let before = null, tries = 0; !before?.equals(picture) && tries < 40; tries += 1) {
    await page.waitForTimeout(500);
    [before, picture] = [picture, await page.screenshot()];
  }
  const path = join(ROOT, "web/tests/pictures", `${name}.webp`);
  const text = picture.toString("base64");
  if (process.env.SPRUNG_UPDATE_PICTURES) await writeFile(path, await page.evaluate(packed, text), "base64");
  const share = await page.evaluate(differing, [text, await readFile(path, "base64")]);
  if (share > 0.02) await writeFile(join(tmpdir(), `sprung-${name}.png`), picture);
  assert.ok(share <= 0.02, `${name}: ${(100 * share).toFixed(1)} % of its pixels are not as stored`);
}

// A picture with little loss, in a tenth of the room.
async function packed(text) {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const bitmap = await createImageBitmap(new Blob([bytes]));
  const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
  canvas.getContext("2d").drawImage(bitmap, 0, 0);
  const blob = await canvas.convertToBlob({ type: "image/webp", quality: 0.9 });
  const small = new Uint8Array(await blob.arrayBuffer());
  return btoa(Array.from(small, (byte) => String.fromCharCode(byte)).join(""));
}

// The share of pixels that differ between two pictures by more than a shade.
async function differing(pictures) {
  const [a, b] = await Promise.all(
    pictures.map(async (text) => {
      const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
      const bitmap = await createImageBitmap(new Blob([bytes]));
      const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext("2d");
      context.drawImage(bitmap, 0, 0);
      return context.getImageData(0, 0, bitmap.width, bitmap.height);
    }),
  );
  if (a.width !== b.width || a.height !== b.height) return 1;
  let count = 0;
  for (let at = 0; at < a.data.length; at += 4) {
    const far = [0, 1, 2].some((channel) => Math.abs(a.data[at + channel] - b.data[at + channel]) > 24);
    if (far) count += 1;
  }
  return (4 * count) / a.data.length;
}

for (const [way, scene, name] of [
  ["WebGL2", "jelly", "jelly"],
  ["WebGPU", "jelly", "jelly"],
  ["WebGL2", "cloth", "cloth"],
  ["phone", "chain", "chain-phone"],
]) {
  test(`${scene} with ${way} looks as stored`, async () => {
    const phone = { viewport: { width: 390, height: 844 }, deviceScaleFactor: 2, hasTouch: true, isMobile: true };
    const { context, page, wrong } = await opened(way, { fragment: `#scene=${scene}`, ...(way === "phone" ? phone : {}) });
    await titled(page, `${scene} – sprung`);
    await press(page, "Home");
    await titled(page, `${scene}, paused – sprung`);
    await asStored(page, name);
    assert.deepEqual(wrong, []);
    await context.close();
  });
}

for (const way of ["WebGL2", "WebGPU"]) {
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

test("a browser that cannot draw is told so", async () => {
  const page = await browsers.neither.newPage();
  await page.goto(server.address);
  await page.waitForFunction(() => document.getElementById("word").textContent !== "Loading…");
  assert.match(await page.textContent("#word"), /^This browser offers neither WebGPU nor WebGL 2 here\. .*hardware acceleration/);
  await page.close();
});

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

// Takes what the page hands out when `act` is done.
async function downloaded(page, act) {
  const [download] = await Promise.all([page.waitForEvent("download", { timeout: 60_000 }), act()]);
  return { name: download.suggestedFilename(), bytes: await readFile(await download.path()) };
}

test("what is pulled, blows up, is mended and rewound", async () => {
  const { context, page, wrong } = await opened("WebGL2", { fragment: "#scene=cloth" });
  await titled(page, "cloth – sprung");
  await page.mouse.move(730, 300);
  await page.mouse.down();
  await page.mouse.move(800, 420, { steps: 8 });
  await page.mouse.up();
  await press(page, "Home");
  await titled(page, "cloth, paused – sprung");
  await context.close();
  assert.deepEqual(wrong, []);

  const text = await readFile(join(ROOT, "scenes/jelly.toml"), "utf8");
  const blows = await opened();
  await dropped(blows.page, { "bad.toml": text.replace(/^dt = .*$/m, "dt = 0.02") });
  await titled(blows.page, "bad, blew up – sprung");
  await drawn(blows.page, "blow-up");
  await press(blows.page, "Enter");
  await titled(blows.page, "bad – sprung");
  assert.deepEqual(blows.wrong, []);
  await blows.context.close();
});

// Drops files onto the page.
async function dropped(page, files) {
  await page.evaluate((files) => {
    const transfer = new DataTransfer();
    for (const [name, text] of Object.entries(files)) transfer.items.add(new File([text], name));
    const canvas = document.querySelector("canvas");
    for (const kind of ["dragenter", "dragover", "drop"]) {
      canvas.dispatchEvent(new DragEvent(kind, { dataTransfer: transfer, bubbles: true, cancelable: true }));
    }
  }, files);
}

test("files come in by drop: good ones, bad ones, and a scene with its mesh", async () => {
  const { context, page, wrong } = await opened();
  const file = (name) => readFile(join(ROOT, name), "utf8");
  await dropped(page, { "mine.toml": await file("scenes/chain.toml") });
  await titled(page, "mine – sprung");
  await dropped(page, { "bad.toml": "dt = -1\n" });
  await titled(page, "mine, card: That did not work – sprung");
  await drawn(page, "bad-file");
  await press(page, "Escape");
  await titled(page, "mine – sprung");
  const scene = await file("examples/towel.toml");
  await dropped(page, { "towel.toml": scene, "towel.obj": await file("examples/towel.obj") });
  await titled(page, "towel – sprung");
  assert.deepEqual(wrong, []);
  await context.close();
});

test("files go out as downloads: scene, picture, motion, film, checkpoint, which comes back", async () => {
  const { context, page, wrong } = await opened("WebGL2", { fragment: "#scene=chain" });
  await titled(page, "chain – sprung");
  await page.waitForTimeout(1500);
  await press(page, "Space");
  await titled(page, "chain, paused – sprung");
  // The card is up, and its field has the focus, before the name in it is taken.
  const saved = async (keys, card) => {
    await press(page, keys);
    await titled(page, `chain, paused, card: ${card} – sprung`);
    await page.waitForTimeout(500);
    const file = await downloaded(page, () => page.keyboard.press("Enter", { delay: 30 }));
    await titled(page, "chain, paused – sprung");
    return file;
  };
  const kept = await saved("Control+Shift+s", "Save a checkpoint");
  assert.equal(kept.name, "my-chain.sprung");
  const scene = await saved("Control+s", "Save the scene");
  assert.equal(scene.name, "my-chain.toml");
  assert.match(scene.bytes.toString(), /^title = /m);
  const picture = await saved("Control+p", "Save the picture");
  assert.deepEqual([picture.name, picture.bytes.subarray(1, 4).toString()], ["chain.png", "PNG"]);
  const motion = await saved("Control+e", "Save the motion");
  assert.deepEqual([motion.name, motion.bytes.subarray(0, 8).toString()], ["chain.usdc", "PXR-USDC"]);
  // A film of a second or more, as the simulation goes on.
  await press(page, "Control+r", "Space");
  await page.waitForTimeout(3000);
  await press(page, "Space");
  const film = await saved("Control+r", "Save the film");
  assert.deepEqual([film.name, film.bytes.subarray(0, 6).toString()], ["chain.gif", "GIF89a"]);
  await page.evaluate((bytes) => {
    const transfer = new DataTransfer();
    transfer.items.add(new File([new Uint8Array(bytes)], "kept.sprung"));
    const canvas = document.querySelector("canvas");
    canvas.dispatchEvent(new DragEvent("drop", { dataTransfer: transfer, bubbles: true, cancelable: true }));
  }, [...kept.bytes]);
  await titled(page, "chain – sprung");
  assert.deepEqual(wrong, []);
  await context.close();
});

test("what the keyboard is at is said to those who do not see it", async () => {
  const { context, page, wrong } = await opened();
  await titled(page, "jelly – sprung");
  const heard = new Set();
  for (let tabs = 0; tabs < 12 && heard.size < 3; tabs += 1) {
    await press(page, "Tab");
    await page.waitForTimeout(1000);
    heard.add(await page.textContent("#words"));
  }
  assert.ok([...heard].some((words) => /Pause|Step|Frame|Reset/.test(words)), [...heard].join("; "));
  assert.deepEqual(wrong, []);
  await context.close();
});

test("a link is a scene, there and back", async () => {
  const { context, page, wrong } = await opened("WebGL2", { fragment: "#scene=chain&view=0,-2,0,14,0.3,0.2" });
  await titled(page, "chain – sprung");
  await press(page, "Space");
  await titled(page, "chain, paused – sprung");
  await press(page, "Control+l");
  let link = "";
  for (let tries = 0; tries < 50 && !link.includes("#"); tries += 1) {
    await page.waitForTimeout(100);
    link = await page.evaluate(() => navigator.clipboard.readText());
  }
  const { hash } = new URL(link);
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

test("the last scene comes back, with what was changed in it", async () => {
  const { context, page, wrong } = await opened("WebGL2", { fragment: "#scene=bridge" });
  await titled(page, "bridge – sprung");
  // What is kept is kept when one goes.
  await page.goto("about:blank");
  await page.goto(server.address);
  await page.waitForSelector("#loading", { state: "hidden", timeout: 120_000 });
  await titled(page, "bridge – sprung");
  assert.deepEqual(wrong, []);
  await context.close();
});

test("every scene has the bits of the native program, in this browser too", async () => {
  const { context, page, wrong } = await opened();
  const goldens = JSON.parse(await readFile(join(ROOT, "crates/sprung/goldens.json"), "utf8"));
  const found = await page.evaluate(hashes, goldens);
  console.log(printed(goldens, found, `Chromium ${browsers.WebGL2.version()}`));
  assert.deepEqual(found, goldens);
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
  const { context, page, wrong } = await opened("phone", {
    viewport: { width: 390, height: 844 },
    deviceScaleFactor: 2,
    hasTouch: true,
    isMobile: true,
  });
  await titled(page, "jelly – sprung");
  await drawn(page, "phone");
  const fingers = await context.newCDPSession(page);
  const touch = (type, touchPoints) => fingers.send("Input.dispatchTouchEvent", { type, touchPoints });
  // Without a graphics card a picture can take longer than a tap, which is then none: so more than once.
  for (let tries = 0; tries < 20 && (await page.title()) === "jelly – sprung"; tries += 1) {
    await touch("touchStart", [{ x: 22, y: 15 }]);
    await page.waitForTimeout(300 + 20 * tries);
    await touch("touchEnd", []);
    await page.waitForTimeout(2000);
  }
  assert.equal(await page.title(), "jelly, paused – sprung");
  // Two fingers that move apart come nearer: much of the picture is another.
  const apart = (by) => [{ x: 195 - by, y: 350, id: 0 }, { x: 195 + by, y: 350, id: 1 }];
  await page.waitForTimeout(1000);
  const far = await page.screenshot();
  await touch("touchStart", apart(30));
  for (let by = 40; by <= 150; by += 10) {
    await touch("touchMove", apart(by));
    await page.waitForTimeout(150);
  }
  await touch("touchEnd", []);
  await page.waitForTimeout(2000);
  const near = await page.screenshot({ path: join(tmpdir(), "sprung-phone-near.png") });
  const share = await page.evaluate(differing, [far, near].map((png) => png.toString("base64")));
  assert.ok(share > 0.05, `a pinch changes ${(100 * share).toFixed(1)} % of the picture`);
  await page.setViewportSize({ width: 844, height: 390 });
  await page.waitForTimeout(500);
  await drawn(page, "phone-across");
  assert.deepEqual(wrong, []);
  await context.close();
});
