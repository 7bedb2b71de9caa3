// How long the page's pictures take while large scenes play beside them: by hand, after `cargo xtask web`, which copies this file to
// where the packages are,
//
//     cd target/web-tests && SPRUNG_PAGE=../../web/dist node frames.mjs
//
// For each scene: the time that the page's own thread works for a picture, and the time from one picture to the next, paused and
// playing; medians, and of the time between pictures the longest of ten seconds too.
import { chromium } from "playwright-core";

import { serve } from "./server.mjs";

const server = await serve(process.env.SPRUNG_PAGE);

const browser = await chromium.launch({
  executablePath: process.env.SPRUNG_BROWSER ?? "/usr/bin/chromium",
  args: ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
});
console.log("| scene | | work for a picture, ms | from picture to picture, ms | longest, ms |\n|---|---|---:|---:|---:|");
for (const scene of ["chain", "jelly", "cloth512", "jelly64"]) {
  const page = await browser.newPage({ viewport: { width: 1100, height: 700 } });
  await page.addInitScript(() => {
    window.pictures = [];
    const ask = window.requestAnimationFrame.bind(window);
    window.requestAnimationFrame = (call) =>
      ask((now) => {
        const begin = performance.now();
        call(now);
        window.pictures.push([begin, performance.now() - begin]);
      });
  });
  await page.goto(`${server.address}#scene=${scene}`);
  await page.waitForFunction((scene) => document.title === `${scene} – sprung`, scene, { timeout: 120_000 });
  await page.waitForTimeout(3000);
  for (const state of ["playing", "paused, turning"]) {
    if (state !== "playing") {
      await page.focus("canvas");
      await page.keyboard.press("Space", { delay: 30 });
      await page.waitForFunction(() => document.title.includes("paused"));
    }
    await page.evaluate(() => (window.pictures.length = 0));
    // The pointer moves in both, or a picture that does not change would not be drawn again.
    for (let step = 0; step < 100; step += 1) {
      await page.mouse.move(700 + (step % 10), 300);
      await page.waitForTimeout(100);
    }
    const pictures = await page.evaluate(() => window.pictures);
    const between = pictures.slice(1).map(([begin], at) => begin - pictures[at][0]);
    const median = (values) => values.toSorted((a, b) => a - b)[values.length >> 1];
    const row = [median(pictures.map(([, work]) => work)), median(between), Math.max(...between)];
    console.log(`| ${scene} | ${state} | ${row.map((value) => value.toFixed(1)).join(" | ")} |`);
  }
  await page.close();
}
await browser.close();
server.close();
