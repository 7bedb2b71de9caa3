// How long a step takes here: node bench.mjs [SCENE…]. Nanoseconds per spring and step, the fastest of some runs.
import { init, Simulation } from "sprung";

await init();
const scenes = process.argv.slice(2);
for (const name of scenes.length > 0 ? scenes : ["jelly", "cloth", "cloth512", "jelly64"]) {
    const begun = performance.now();
    const simulation = Simulation.builtin(name);
    simulation.step();
    const setUp = (performance.now() - begun) / 1000;
    const { springCount } = simulation;
    const steps = Math.max(10, Math.ceil(2e7 / springCount));
    let best = Infinity;
    for (let run = 0; run < 6; run++) {
        const from = performance.now();
        simulation.step(steps);
        best = Math.min(best, (performance.now() - from) / steps);
    }
    console.log(`${name.padEnd(10)} ${((1e6 * best) / springCount).toFixed(2)} ns per spring and step; ready in ${setUp.toFixed(2)} s`);
    simulation.dispose();
}
