// A bridge on a plain canvas: each spring is a line, orange where it is pulled and blue where it is pressed.
import { init, Simulation } from "sprung";

const canvas = /** @type {HTMLCanvasElement} */ (document.querySelector("canvas"));
const pen = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
const says = /** @type {HTMLElement} */ (document.querySelector("#says"));

await init();
const bridge = Simulation.builtin("bridge");
const { positions, springs, springCount, pointCount } = bridge;
const rest = bridge.get("restLength");

// Seen from the front: x to the right, y upwards, all of it in the picture.
let [left, right, low, high] = [Infinity, -Infinity, Infinity, -Infinity];
for (let point = 0; point < pointCount; point++) {
    const [x, y] = positions.subarray(3 * point, 3 * point + 2);
    [left, right, low, high] = [Math.min(left, x), Math.max(right, x), Math.min(low, y), Math.max(high, y)];
}
const [width, height] = [right - left, Math.max(high - low, 0.5 * (right - left))];

function draw() {
    [canvas.width, canvas.height] = [canvas.clientWidth * devicePixelRatio, canvas.clientHeight * devicePixelRatio];
    const scale = 0.85 * Math.min(canvas.width / width, canvas.height / height);
    const x = (point) => canvas.width / 2 + scale * (positions[3 * point] - (left + right) / 2);
    const y = (point) => canvas.height / 2 - scale * (positions[3 * point + 1] - (low + high) / 2);
    pen.lineWidth = 2 * devicePixelRatio;
    for (let spring = 0; spring < springCount; spring++) {
        const [i, j] = [springs[2 * spring], springs[2 * spring + 1]];
        const length = Math.hypot(...[0, 1, 2].map((axis) => positions[3 * i + axis] - positions[3 * j + axis]));
        const strain = length / rest[spring] - 1;
        const share = Math.min(Math.abs(strain) / 0.01, 1);
        const [red, green, blue] = strain > 0 ? [242, 153, 74] : [86, 156, 214];
        pen.strokeStyle = `rgb(${[red, green, blue].map((part) => 110 + share * (part - 110)).join(" ")})`;
        pen.beginPath();
        pen.moveTo(x(i), y(i));
        pen.lineTo(x(j), y(j));
        pen.stroke();
    }
}

let before = performance.now();
requestAnimationFrame(function next(now) {
    requestAnimationFrame(next);
    bridge.advance(Math.max(0, now - before) / 1000);
    before = now;
    draw();
    says.textContent = `${bridge.title}, t = ${bridge.time.toFixed(1)} s`;
});
