// A cube of 64³ points in a worker: the page itself stays free, however long a step takes.
import { spawn } from "sprung";

const canvas = /** @type {HTMLCanvasElement} */ (document.querySelector("canvas"));
const pen = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
const says = /** @type {HTMLElement} */ (document.querySelector("#says"));

const jelly = await spawn("jelly64");
const { positions, surfaces, springCount } = jelly;
const skin = [...new Set(surfaces[0].triangles)];
// The middle of it, and how far it reaches from there.
const middle = [0, 1, 2].map((axis) => skin.reduce((sum, point) => sum + positions[3 * point + axis], 0) / skin.length);
const away = (point) => middle.map((part, axis) => positions[3 * point + axis] - part);
const size = skin.reduce((size, point) => Math.max(size, Math.hypot(...away(point))), 0);

let picture = 0;
requestAnimationFrame(function draw() {
    requestAnimationFrame(draw);
    // One step at a time, as soon as the last one is there.
    if (!jelly.busy) jelly.step().catch((error) => (says.textContent = error.message));
    [canvas.width, canvas.height] = [canvas.clientWidth, canvas.clientHeight];
    const scale = (0.45 * Math.min(canvas.width, canvas.height)) / size;
    const [cos, sin] = [Math.cos(0.01 * picture), Math.sin(0.01 * picture)];
    pen.fillStyle = "#f2994a";
    for (const point of skin) {
        const [x, y, z] = away(point);
        const depth = -x * sin + z * cos;
        pen.globalAlpha = 0.5 + 0.4 * Math.max(-1, Math.min(1, depth / size));
        pen.fillRect(canvas.width / 2 + scale * (x * cos + z * sin), canvas.height / 2 - scale * (y + 0.3 * depth), 1.5, 1.5);
    }
    says.textContent = `${springCount.toLocaleString("en")} springs, step ${jelly.stepCount}, picture ${picture++}`;
});
