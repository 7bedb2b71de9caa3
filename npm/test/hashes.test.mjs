// The same bits as the native program: every built-in scene, after as many steps as its golden hashes are for.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { test } from "node:test";

import { init, scenes, Simulation } from "sprung";

const goldens = JSON.parse(await readFile(process.env.SPRUNG_GOLDENS ?? "", "utf8"));
await init();

test("every built-in scene gives the hashes of the native program", () => {
    const rows = [];
    for (const { name } of scenes()) {
        const simulation = Simulation.builtin(name);
        for (const [step, native] of Object.entries(goldens[name])) {
            simulation.step(Number(step) - simulation.stepCount);
            rows.push({ name, step, native, node: simulation.stateHash() });
        }
        simulation.dispose();
    }
    console.log(`${"scene".padEnd(12)} ${"step".padStart(5)}  ${"native".padEnd(16)}  ${`node ${process.version}`.padEnd(16)}`);
    for (const { name, step, native, node } of rows) {
        console.log(`${name.padEnd(12)} ${step.padStart(5)}  ${native}  ${node}  ${native === node ? "same" : "DIFFERENT"}`);
    }
    assert.deepEqual(rows.map(({ name, step, node }) => [name, step, node]), rows.map(({ name, step, native }) => [name, step, native]));
    assert.deepEqual(Object.keys(goldens).sort(), scenes().map(({ name }) => name).sort());
});

test("a frame is its substeps, and steps at once are those one by one", () => {
    const [frames, steps] = [Simulation.builtin("cloth"), Simulation.builtin("cloth")];
    for (let frame = 0; frame < 10; frame++) frames.frame();
    for (let step = 0; step < 10 * frames.get("substeps"); step++) steps.step();
    assert.equal(frames.stateHash(), steps.stateHash());
    assert.equal(frames.stepCount, 70);
});

test("reading, resetting and views leave the bits alone", () => {
    const [plain, watched] = [Simulation.builtin("jelly"), Simulation.builtin("jelly")];
    plain.step(100);
    watched.step(7);
    watched.reset();
    for (let step = 0; step < 100; step++) {
        watched.step();
        watched.positions.fill(0); // ours to spoil
        watched.withViews((positions) => positions[0]);
        watched.energy();
    }
    assert.equal(watched.stateHash(), plain.stateHash());
    assert.equal(plain.stateHash(), goldens.jelly["100"]);
});
