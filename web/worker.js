// The page's worker: steps the simulation in a module of its own, so that the picture never waits for a step.
//
// Messages from the page are bytes: the first is what the driver begins with, and all others are told to it. Messages to the
// page are bytes, too, but for the last: { ended: "why" }.

import init, { PageDriver, lastWords } from "./engine.js";

const post = self.postMessage.bind(self);
// A timer would rest for milliseconds where there is no rest.
const again = new MessageChannel();
let driver = null;
let timer = 0;
let isDue = false;
let hasEnded = false;

// Messages may come before the module has: they wait for it, and for each other.
let ready = init({ module_or_path: new URL("engine_bg.wasm", import.meta.url) });
self.onmessage = ({ data }) => {
  ready = ready.then(() => hear(new Uint8Array(data))).catch(end);
};
again.port1.onmessage = () => attempt(turn);

function hear(message) {
  if (hasEnded) return;
  if (driver === null) {
    driver = new PageDriver(message);
  } else {
    driver.hear(message);
  }
  schedule(0);
}

function turn() {
  isDue = false;
  const rest = driver.turn();
  for (let report = driver.report(); report !== undefined; report = driver.report()) {
    post(report.buffer, [report.buffer]);
  }
  if (rest >= 0) schedule(rest);
}

// A turn after so many milliseconds, or before.
function schedule(rest) {
  if (isDue) return;
  clearTimeout(timer);
  if (rest > 0) {
    timer = setTimeout(() => schedule(0), rest);
  } else {
    isDue = true;
    again.port2.postMessage(null);
  }
}

function attempt(action) {
  if (hasEnded) return;
  try {
    action();
  } catch (error) {
    end(error);
  }
}

// After this nothing is done any more.
function end(error) {
  if (hasEnded) return;
  hasEnded = true;
  clearTimeout(timer);
  let words;
  try {
    words = lastWords();
  } catch {
    // The module has not even been loaded.
  }
  post({ ended: words ?? error?.message ?? String(error) });
}
