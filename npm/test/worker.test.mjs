// A simulation in a thread of its own.
import assert from "node:assert/strict";
import { test } from "node:test";

import { BlowUpError, init, Simulation, spawn, SprungError } from "sprung";
import { Vector3 } from "three";

await init();

test("it moves as here, and its arrays stay", async () => {
    const here = Simulation.builtin("cloth", { gravity: [0, -5, 0] });
    const there = await spawn("cloth", { set: { gravity: [0, -5, 0] }, velocities: true });
    assert.deepEqual([there.title, there.pointCount, there.springCount, there.stepCount], [here.title, 400, 1482, 0]);
    assert.deepEqual([there.bodies, there.joints, there.surfaces], [here.bodies, here.joints, here.surfaces]);
    assert.deepEqual(there.springs, here.springs);
    const { positions, velocities } = there;
    assert.deepEqual(positions, here.positions);
    for (let frame = 0; frame < 20; frame++) {
        here.frame();
        const done = there.frame();
        assert.equal(there.busy, true);
        await done;
        assert.deepEqual(positions, here.positions);
        assert.deepEqual(velocities, here.velocities);
    }
    assert.equal(there.busy, false);
    assert.deepEqual([there.positions === positions, there.stepCount, there.time], [true, 140, here.time]);
    assert.equal(await there.stateHash(), here.stateHash());
    assert.deepEqual(await there.energy(), here.energy());
    assert.deepEqual((await there.stability()).certified, here.stability().certified);
    there.dispose();
});

test("all calls are done in their order", async () => {
    const chain = await spawn("chain");
    await Promise.all([chain.set("dt", 0.005), chain.pin(14), chain.step(10), chain.unpin(14), chain.advance(0.1), chain.keepLedger(true)]);
    assert.deepEqual([chain.stepCount, await chain.get("dt"), await chain.get("pinned", 14)], [30, 0.005, false]);
    const picked = await chain.pick(new Vector3(4, 25, 10), new Vector3(0, 0, -1), { radius: 1 });
    assert.equal(picked?.kind, "point");
    await chain.drag(picked?.index ?? 0, new Vector3(0, 30, 0));
    await chain.frame();
    await chain.release(picked?.index ?? 0);
    await chain.reset();
    assert.equal(chain.stepCount, 0);
    chain.dispose();
});

test("errors come across whole", async () => {
    await assert.rejects(spawn("clooth"), (error) => error instanceof SprungError && error.code === "NotFound" && /did you mean/.test(error.message));
    await assert.rejects(spawn({ text: "dt = -1\n" }, { file: "my.toml" }), { name: "SprungError", message: /^my.toml:1:6: dt: is -1/, line: 1, column: 6 });
    const jelly = await spawn("jelly", { set: { dt: 0.013 } });
    await assert.rejects(jelly.step(1000), (error) => error instanceof BlowUpError && error.step === 79 && error.points.length === 2);
    assert.equal(jelly.stepCount, 40);
    await assert.rejects(jelly.set("stiffness", -1), { code: "OutOfRange", field: "stiffness" });
    await assert.rejects(jelly.settle(/** @type {any} */ ({ maxSteps: () => 3 })), { code: "WrongType" });
    await jelly.set("dt", 0.01);
    await jelly.frame();
    assert.throws(() => jelly.velocities, { code: "Conflict" });
    jelly.dispose();
});

test("what is waited for when it ends is rejected", async () => {
    const cloth = await spawn("cloth512");
    const waiting = [cloth.step(1000), cloth.frame()];
    cloth.dispose();
    for (const answer of waiting) await assert.rejects(answer, { code: "Conflict", message: /disposed of/ });
    await assert.rejects(cloth.frame(), { code: "Conflict" });
    assert.throws(() => new /** @type {any} */ (cloth.constructor)(), { code: "Unsupported" });
});
