// Firefox and WebKit, as far as tests need them: `go`, `run` a function in the page, `press` a key, `picture`, `close`. Each is
// undefined where it is not installed, or where there is no display: both draw only on one.

import { spawn } from "node:child_process";
import { existsSync } from "node:fs";
import { setTimeout as wait } from "node:timers/promises";

import puppeteer from "puppeteer-core";

const FIREFOX = ["/usr/bin/firefox-esr", "/usr/bin/firefox"];
const WEBKIT_DRIVER = "/usr/bin/WebKitWebDriver";
const WEBKIT = ["x86_64", "aarch64"].map((cpu) => `/usr/lib/${cpu}-linux-gnu/webkit2gtk-4.1/MiniBrowser`);

const SIZE = { width: 1100, height: 700 };

export async function firefox() {
  const executablePath = FIREFOX.find(existsSync);
  if (!executablePath || !process.env.DISPLAY) return undefined;
  // In software where there is no graphics card.
  const extraPrefsFirefox = { "webgl.force-enabled": true };
  const browser = await puppeteer.launch({ browser: "firefox", executablePath, headless: false, extraPrefsFirefox });
  const page = await browser.newPage();
  await page.setViewport(SIZE);
  return {
    name: (await browser.version()).replace("firefox/", "Firefox "),
    go: (address) => page.goto(address),
    run: (what, argument) => page.evaluate(what, argument),
    press: (key) => page.keyboard.press(key, { delay: 30 }),
    picture: () => page.screenshot(),
    close: () => browser.close(),
  };
}

// The engine of Safari, driven as the W3C's WebDriver says.
export async function webkit() {
  const binary = WEBKIT.find(existsSync);
  if (!binary || !existsSync(WEBKIT_DRIVER) || !process.env.DISPLAY) return undefined;
  const port = 4400 + (process.pid % 1000);
  const driver = spawn(WEBKIT_DRIVER, [`--port=${port}`], { stdio: "inherit" });
  // Whatever goes wrong here, it is not left behind, nor waited for.
  driver.unref();
  process.once("exit", () => driver.kill());
  const call = async (method, path, body) => {
    const answer = await fetch(`http://127.0.0.1:${port}${path}`, { method, body: body && JSON.stringify(body) });
    const { value } = await answer.json();
    if (!answer.ok) throw new Error(value.message);
    return value;
  };
  for (let tries = 0; !(await call("GET", "/status").catch(() => undefined)); tries += 1) {
    if (tries === 100) throw new Error("WebKitWebDriver does not answer");
    await wait(100);
  }
  const options = { binary, args: ["--automation"] };
  const capabilities = { alwaysMatch: { "webkitgtk:browserOptions": options } };
  const { sessionId, capabilities: has } = await call("POST", "/session", { capabilities });
  const session = (method, path, body) => call(method, `/session/${sessionId}${path}`, body);
  await session("POST", "/timeouts", { script: 120_000, pageLoad: 120_000 });
  return {
    name: `WebKit ${has.browserVersion}`,
    go: (url) => session("POST", "/url", { url }),
    run: (what, argument) => {
      const script = `const [argument, done] = arguments; (${what})(argument).then(done);`;
      return session("POST", "/execute/async", { script, args: [argument ?? null] });
    },
    press: async (key) => {
      const value = { Enter: "\uE007", Escape: "\uE00C" }[key] ?? key;
      const actions = [{ type: "keyDown", value }, { type: "pause", duration: 30 }, { type: "keyUp", value }];
      await session("POST", "/actions", { actions: [{ type: "key", id: "keys", actions }] });
    },
    picture: async () => Buffer.from(await session("GET", "/screenshot"), "base64"),
    close: async () => {
      await session("DELETE", "").catch(() => undefined);
    },
  };
}
