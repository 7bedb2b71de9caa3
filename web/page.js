// Loads the app, and says how far that is, or why it cannot be.

const loading = document.getElementById("loading");
const progress = document.getElementById("progress");
const word = document.getElementById("word");

function fail(sentence, reason) {
  console.error(reason ?? sentence);
  loading.hidden = false;
  progress.hidden = true;
  word.textContent = sentence;
}

document.addEventListener("sprung-ready", () => { loading.hidden = true; });
document.addEventListener("sprung-failed", (event) => {
  fail(`sprung has stopped: ${event.detail}. Load the page anew to start again.`);
});

// A file with how much of it has come. Servers that compress do not say how long it will be: its length is in sizes.json.
async function fetched(url, length) {
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url}: the server says ${response.status} ${response.statusText}`);
  const reader = response.body.getReader();
  let come = 0;
  const watched = new ReadableStream({
    async pull(controller) {
      const { done, value } = await reader.read();
      if (done) return controller.close();
      come += value.length;
      progress.value = Math.min(come / length, 1);
      controller.enqueue(value);
    },
  });
  return new Response(watched, { headers: { "Content-Type": "application/wasm" } });
}

// Whether there is anything to draw with. A context is given back: browsers allow a page only so many.
async function canDraw() {
  const context = document.createElement("canvas").getContext("webgl2");
  context?.getExtension("WEBGL_lose_context")?.loseContext();
  return context !== null || ((await navigator.gpu?.requestAdapter()) ?? null) !== null;
}

async function start() {
  if (!("WebAssembly" in globalThis)) {
    return fail("This browser has no WebAssembly: sprung needs Chrome or Edge 96, Firefox 114, Safari 16.4, or newer.");
  }
  if (!(await canDraw())) {
    return fail(
      "This browser offers neither WebGPU nor WebGL 2 here. Switch hardware acceleration on in its settings, or open the page in another browser.",
    );
  }
  const sizes = await (await fetch("sizes.json")).json();
  const { default: init } = await import("./sprung-app.js");
  await init({ module_or_path: fetched("sprung-app_bg.wasm", sizes["sprung-app_bg.wasm"]) });
  // After that: what must not be late for the first picture.
  if ("serviceWorker" in navigator && isSecureContext) {
    await navigator.serviceWorker.register("offline.js");
  }
}

// Another link was put into the address: it is opened as in a new page.
addEventListener("hashchange", () => location.reload());

start().catch((error) => fail(`sprung cannot be loaded: ${error.message}`, error));
