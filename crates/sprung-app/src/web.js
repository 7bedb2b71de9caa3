// What the page does for the app that the app cannot do itself.

// The part of the address behind "#": a scene, if somebody followed a link to one.
export function fragment() {
  return location.hash.slice(1);
}

// The page's address without that part.
export function address() {
  return location.origin + location.pathname;
}

// Hands a file to the person: it lies where the browser puts what is downloaded.
export function download(name, bytes) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([bytes]));
  link.download = name;
  link.click();
  // The browser has to begin before the bytes may go.
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
}

// Asks for files; `take(names, bytes of each)` is called when they are chosen and read.
export function pick(accept, take) {
  const input = document.createElement("input");
  input.type = "file";
  input.multiple = true;
  input.accept = accept;
  input.addEventListener("change", async () => {
    const files = [...input.files];
    const bytes = await Promise.all(files.map(async (file) => new Uint8Array(await file.arrayBuffer())));
    take(files.map((file) => file.name), bytes);
  });
  input.click();
}

// What the page is called: what it shows.
export function name(title) {
  document.title = title;
}

// Says something to those who do not see the canvas: screen readers read out what changes there.
export function tell(words) {
  if (words) document.getElementById("words").textContent = words;
}

// A worker to simulate in. `take(bytes)` hears its messages, and `take(undefined, why)` that there will be no more; what is
// given back takes messages there.
export function work(take) {
  const worker = new Worker("worker.js", { type: "module" });
  worker.onmessage = ({ data }) => (data.ended === undefined ? take(new Uint8Array(data)) : take(undefined, data.ended));
  worker.onerror = (event) => take(undefined, event.message ?? "its file cannot be loaded");
  return (bytes) => worker.postMessage(bytes.buffer, [bytes.buffer]);
}

// The app has drawn its first picture: what was shown while it loaded goes.
export function ready() {
  document.dispatchEvent(new CustomEvent("sprung-ready"));
}

// The app cannot go on: the page says so in its own words.
export function failed(reason) {
  document.dispatchEvent(new CustomEvent("sprung-failed", { detail: reason }));
}
