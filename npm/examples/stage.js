// What the three.js examples share: a camera, lights, a canvas that fills the window, and a hand that pulls.
import { Color, DirectionalLight, HemisphereLight, PerspectiveCamera, Raycaster, Scene, Vector2, Vector3, WebGLRenderer } from "three";

/** Says something at the bottom of the page. */
export function say(text) {
    const place = document.querySelector("#says");
    if (place !== null) place.textContent = text;
}

/** Shows errors where the visitor sees them: theirs are sentences. */
addEventListener("error", ({ message }) => say(message));
addEventListener("unhandledrejection", ({ reason }) => say(reason.message));

/** A stage with a camera there that looks at a place, m. */
export function stage({ eye, centre }) {
    const canvas = /** @type {HTMLCanvasElement} */ (document.querySelector("canvas"));
    const renderer = new WebGLRenderer({ canvas, antialias: true });
    const scene = new Scene();
    scene.background = new Color(0x14171c);
    const sun = new DirectionalLight(0xffffff, 2.5);
    sun.position.set(1, 2, 1.5);
    scene.add(new HemisphereLight(0xdfe8ff, 0x4a3f35, 1.6), sun);
    const camera = new PerspectiveCamera(40, 1, 0.1, 1000);
    camera.position.fromArray(eye);
    camera.lookAt(new Vector3().fromArray(centre));

    function fit() {
        renderer.setPixelRatio(devicePixelRatio);
        renderer.setSize(canvas.clientWidth, canvas.clientHeight, false);
        camera.aspect = canvas.clientWidth / canvas.clientHeight;
        camera.updateProjectionMatrix();
    }
    new ResizeObserver(fit).observe(canvas);
    fit();
    return { scene, camera, canvas, draw: () => renderer.render(scene, camera) };
}

/** Lets the pointer pull at the points of a simulation. */
export function pull(simulation, { camera, canvas }) {
    const raycaster = new Raycaster();
    const ray = ({ clientX, clientY }) => {
        const { left, top, width, height } = canvas.getBoundingClientRect();
        const at = new Vector2((2 * (clientX - left)) / width - 1, 1 - (2 * (clientY - top)) / height);
        raycaster.setFromCamera(at, camera);
        return raycaster.ray;
    };
    let held = null;
    canvas.addEventListener("pointerdown", (event) => {
        const { origin, direction } = ray(event);
        const picked = simulation.pick(origin, direction, { spread: 0.04 });
        if (picked?.kind !== "point" || simulation.get("pinned", picked.index)) return;
        canvas.setPointerCapture(event.pointerId);
        held = picked;
        say(`You hold ${picked.name}.`);
    });
    canvas.addEventListener("pointermove", (event) => {
        if (held !== null) simulation.drag(held.index, ray(event).at(held.distance, new Vector3()));
    });
    const release = () => {
        if (held !== null) simulation.release(held.index);
        held = null;
    };
    canvas.addEventListener("pointerup", release);
    canvas.addEventListener("pointercancel", release);
}

/** Calls a function for each picture with the seconds since the last one. */
export function play(draw) {
    let before = performance.now();
    requestAnimationFrame(function next(now) {
        requestAnimationFrame(next);
        draw(Math.max(0, now - before) / 1000);
        before = now;
    });
}
