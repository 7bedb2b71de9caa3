// A cube of 64³ points in a worker: the page itself stays free, however long a step takes.
import { spawn } from "sprung";

const canvas = /** @type {HTMLCanvasElement} */ (document.querySelector("canvas"));
const pen = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
const says = /** @type {HTMLElement} */ (document.querySelector("#says"));

const jelly = await spawn("jelly64");
const { positions, surfaces, springCount } = jelly;
const skin = [...new Set(surfaces[0].triangles)];
let size = 0;
for (const point of skin) size = Math.max(size, Math.hypot(...positions.subarray(3 * point, 3 * point + 3)));

let picture = 0;
requestAnimationFrame(function draw() {
    requestAnimationFrame(draw);
    // One step at a time, as soon as the last one is there.
    if (!jelly.busy) jelly.step().catch((error) => (says.textContent = error.message));
    [canvas.width, canvas.height] = [canvas.clientWidth, canvas.clientHeight];
    const scale = (0.5 * Math.min(canvas.width, canvas.height)) / size;
    const [cos, sin] = [Math.cos(0.01 * picture), Math.sin(0.01 * picture)];
    pen.fillStyle = "#f2994a";
    for (const point of skin) {
        const [x, y, z] = positions.subarray(3 * point, 3 * point + 3);
        const depth = -x * sin + z * cos;
        pen.globalAlpha = 0.5 + 0.4 * Math.max(-1, Math.min(1, depth / size));
        pen.fillRect(canvas.width / 2 + scale * (x * cos + z * sin), canvas.height / 2 - scale * (y + 0.3 * depth), 1.5, 1.5);
    }
    says.textContent = `${springCount.toLocaleString("en")} springs, step ${jelly.stepCount}, picture ${picture++}`;
});
