// What a simulation can do.
import assert from "node:assert/strict";
import { test } from "node:test";

import { BlowUpError, init, scenes, Simulation, SprungError, version } from "sprung";

await init();

test("the engine tells its version and its scenes", async () => {
    await init(); // once more does no harm
    assert.match(version(), /^\d+\.\d+\.\d+$/);
    const names = scenes().map(({ name }) => name);
    assert.deepEqual(names.slice(0, 4), ["spring", "chain", "jelly", "cloth"]);
    for (const { title, text, kind, name } of scenes()) {
        assert.ok(title.length > 5 && text.includes(title), name);
        assert.ok(["report", "gallery", "benchmark"].includes(kind));
    }
    const cloth = scenes().find(({ name }) => name === "cloth");
    const [parsed, builtin] = [Simulation.parse(cloth?.text ?? ""), Simulation.builtin("cloth")];
    parsed.frame();
    builtin.frame();
    assert.equal(parsed.stateHash(), builtin.stateHash());
});

test("a scene tells what it is made of", () => {
    const jelly = Simulation.builtin("jelly");
    assert.equal(jelly.title, "A cube of jelly falling on a plane");
    assert.match(jelly.description, /thousand points/);
    assert.deepEqual([jelly.pointCount, jelly.springCount], [1000, 7560]);
    assert.deepEqual(jelly.bodies, [{ name: "jelly", points: [0, 1000], springs: [0, 7560] }]);
    assert.deepEqual(jelly.joints, []);
    assert.equal(jelly.springs.length, 2 * 7560);
    assert.deepEqual([...jelly.springs.subarray(2 * 884, 2 * 885)], [111, 112]);
    const [{ body, kind, triangles }] = jelly.surfaces;
    assert.deepEqual([body, kind, triangles.length], ["jelly", "skin", 3 * 6 * 9 * 9 * 2]);
    assert.equal(Simulation.builtin("bridge").joints.length > 0, true);
    // What never changes is made once.
    assert.equal(jelly.springs, jelly.springs);
    assert.equal(jelly.surfaces, jelly.surfaces);
});

test("positions and velocities are one array each, always current", () => {
    const cloth = Simulation.builtin("cloth");
    const { positions, velocities } = cloth;
    assert.equal(positions.length, 1200);
    assert.deepEqual([...positions.subarray(0, 3)], [-20, 10, 0]);
    const middle = 3 * 210 + 1;
    const before = positions[middle];
    cloth.frame();
    assert.ok(positions[middle] < before, "it has begun to fall");
    assert.ok(velocities[middle] < 0);
    assert.equal(cloth.positions, positions);
    assert.equal(cloth.velocities, velocities);
    const mine = cloth.copyPositions(new Float32Array(1200));
    assert.deepEqual(mine, positions);
    assert.deepEqual(cloth.copyVelocities(new Float32Array(1200)), velocities);
    cloth.reset();
    assert.equal(positions[middle], before);
    assert.equal(velocities[middle], 0);
    cloth.place(210, [1, 2, 3]);
    assert.deepEqual([...positions.subarray(3 * 210, 3 * 211)], [1, 2, 3]);
});

test("changes before a scene is built are those of --set", () => {
    const jelly = Simulation.builtin("jelly", {
        dt: 0.005,
        gravity: [0, -1.62, 0],
        "plane.y": -12,
        stiffness: 500,
        "plane.law": "push",
        "body.jelly.rotation": { axis: [0, 0, 1], degrees: 45 },
    });
    assert.equal(jelly.get("dt"), 0.005);
    assert.deepEqual(jelly.get("gravity"), [0, Math.fround(-1.62), 0]);
    assert.deepEqual(jelly.get("planes"), [{ point: [0, -12, 0], normal: [0, 1, 0], stiffness: 50, damping: 10, law: "push" }]);
    assert.equal(jelly.get("stiffness", 7000), 500);
    assert.ok(Simulation.builtin("jelly", { dt: "auto" }).get("dt") < 0.005);
});

test("parameters are changed while it runs", () => {
    const jelly = Simulation.builtin("jelly");
    jelly.set("dt", 0.002);
    jelly.set("substeps", 5);
    jelly.set("gravity", { x: 0, y: -3, z: 0 });
    jelly.set("mass", 2, 7);
    jelly.set("stiffness", 600);
    jelly.set("damping", 5, [10, 20]);
    jelly.set("restScale", 0.5, 3);
    jelly.set("planes", [{ y: -4, stiffness: 80 }, { point: [0, 0, 0], normal: [1, 1, 0], stiffness: 10, damping: 1, law: "report" }]);
    assert.deepEqual([jelly.get("dt"), jelly.get("substeps"), jelly.get("gravity")], [0.002, 5, [0, -3, 0]]);
    const mass = jelly.get("mass");
    assert.deepEqual([mass.length, mass[6], mass[7], jelly.get("mass", 7)], [1000, 1, 2, 2]);
    assert.ok(jelly.get("stiffness").every((stiffness) => stiffness === 600));
    assert.deepEqual([9, 10, 19, 20].map((spring) => jelly.get("damping", spring)), [10, 5, 5, 10]);
    assert.equal(jelly.get("restLength", 3), 1);
    const [level, sloping] = jelly.get("planes");
    assert.deepEqual(level, { point: [0, -4, 0], normal: [0, 1, 0], stiffness: 80, damping: 0, law: "push" });
    assert.deepEqual(sloping.normal, [Math.fround(Math.SQRT1_2), Math.fround(Math.SQRT1_2), 0]);
    jelly.set("dt", "auto");
    assert.ok(jelly.get("dt") > 0.002);
    jelly.set("mass", 3, "jelly");
    assert.equal(jelly.get("mass", 999), 3);
    jelly.reset();
    assert.deepEqual([jelly.get("dt"), jelly.get("mass", 7), jelly.get("stiffness", 0)], [0.01, 1, 750]);
});

test("points are pinned and freed, springs cut and mended, points pulled and carried", () => {
    const chain = Simulation.builtin("chain");
    const at = (point) => [...chain.positions.subarray(3 * point, 3 * point + 3)];
    assert.deepEqual([chain.get("pinned", 0), chain.get("pinned", 14)], [true, false]);
    chain.pin(14);
    const end = at(14);
    chain.step(50);
    assert.deepEqual(at(14), end);
    chain.unpin([0, 15]);
    assert.equal(chain.get("pinned").indexOf(1), -1);
    chain.cut(3);
    assert.deepEqual([chain.get("cut", 3), chain.get("cut", 4)], [true, false]);
    chain.mend("chain");
    assert.equal(chain.get("cut", 3), false);

    chain.set("gravity", [0, 0, 0]);
    chain.carry(0, [0, 0, 1]);
    const from = at(0);
    chain.step(100);
    assert.ok(Math.abs(at(0)[2] - from[2] - 1) < 1e-5, "a metre in a second");
    chain.release(0);

    const spring = Simulation.builtin("spring");
    const rest = spring.energy().workIn;
    spring.force(1, [5, 0, 0]);
    spring.step(20);
    assert.ok(spring.energy().workIn > rest);
    assert.ok(spring.velocities[3] > 0);
    spring.force(1, [0, 0, 0]);
});

test("time passes in step with a clock", () => {
    const cloth = Simulation.builtin("cloth"); // steps of 0.01 s
    assert.equal(cloth.advance(0.025), 2);
    assert.equal(cloth.advance(0.0049), 0);
    assert.equal(cloth.advance(0.0002), 1);
    assert.equal(cloth.stepCount, 3);
    assert.ok(Math.abs(cloth.time - 0.03) < 1e-12);
    // A page that was in the background for an hour.
    assert.equal(cloth.advance(3600), 25);
    assert.equal(cloth.advance(3600, 1), 100);
});

test("energies and limits are those that the command prints", () => {
    const jelly = Simulation.builtin("jelly");
    const round = (value) => Number(value.toPrecision(6));
    assert.equal(round(jelly.energy().total), 75256.2);
    const { dt, sharp, certified, everyConfiguration } = jelly.stability();
    assert.deepEqual([dt, round(sharp.dt), round(certified.dt), round(everyConfiguration.dt)], [0.01, 0.0119753, 0.011611, 0.00462387]);
    assert.equal(certified.setBy, "spring 3945 of jelly (points 487 and 587)");
    assert.deepEqual([certified.spring, certified.points], [3945, [487, 587]]);
    assert.deepEqual([everyConfiguration.spring, everyConfiguration.points], [884, [111, 112]]);
    assert.deepEqual([round(sharp.omega2Max), round(sharp.cMax)], [8643.98, 115.253]);
    const quick = jelly.certifiedLimit();
    assert.ok(quick.dt <= certified.dt && quick.dt > certified.dt * (1 - 2e-5));

    // With the ledger on from the start the sums explain the total, but for what float32 rounds: half an ulp is 2⁻²⁴.
    jelly.keepsLedger = true;
    jelly.step(200);
    assert.equal(jelly.keepsLedger, true);
    const { total, start, workIn, lostInDampers, lostInContact, integratorError } = jelly.energy();
    const explained = start + workIn - lostInDampers - lostInContact + integratorError;
    assert.ok(lostInDampers > 0 && Math.abs(total - explained) < 2 ** -23 * start, `${total} and ${explained} J`);

    const loose = Simulation.parse('[[body]]\nname = "a"\npoints = [[0, 0, 0]]\n');
    assert.deepEqual(loose.stability().certified, { dt: Infinity, setBy: "nothing" });
});

test("a scene comes to rest", () => {
    const chain = Simulation.builtin("chain");
    const { steps, residualForce } = chain.settle({ residualForce: 0.01 });
    assert.ok(steps > 0 && residualForce <= 0.01);
    assert.deepEqual([chain.stepCount, chain.time], [0, 0]);
    // It hangs straight down.
    assert.ok(Math.abs(chain.positions[3 * 14]) < 0.1 && chain.positions[3 * 14 + 1] < -3);
    assert.throws(() => chain.settle({ maxSteps: -1 }), /maxSteps: is -1/);
    const spring = Simulation.builtin("spring");
    assert.throws(() => spring.settle({ residualForce: 1e-9, maxSteps: 3 }), { name: "SprungError", code: "NotSettled" });
});

test("a blow-up is an error with all its numbers, and the last good state stays", () => {
    const jelly = Simulation.builtin("jelly", { dt: 0.013 });
    const { positions } = jelly;
    let blowUp;
    try {
        jelly.step(1000);
    } catch (error) {
        blowUp = error;
    }
    assert.ok(blowUp instanceof BlowUpError && blowUp instanceof SprungError && blowUp instanceof Error);
    // As the README of the project shows it.
    assert.equal(
        blowUp.message,
        "the simulation blew up at t = 1.027 s (step 79): for 20 steps more than half of its energy has come from nowhere " +
            "(1.44399e13 J). The state of t = 0.52 s (step 40) is the last good one and is kept. The tightest limit is set by spring " +
            "4443 of jelly (points 552 and 562): dt = 0.013 s is 112 % of the certified limit of 0.0116069 s there. Use dt = 0.011 s " +
            'or less, or dt = "auto".',
    );
    const { code, name, reason, step, goodStep, spring, points, dt, suggestedDt } = blowUp;
    assert.deepEqual(
        { code, name, reason, step, goodStep, spring, points, dt, suggestedDt },
        { code: "BlewUp", name: "BlowUpError", reason: "energy-from-nowhere", step: 79, goodStep: 40, spring: 4443, points: [552, 562], dt: 0.013, suggestedDt: 0.011 },
    );
    assert.ok((blowUp.excess ?? 0) > 1e13 && (blowUp.certifiedLimit ?? 1) < dt && Math.abs(blowUp.goodTime - 0.52) < 1e-12);
    assert.equal(jelly.stepCount, 40);
    // The array shows that state, too.
    assert.deepEqual(positions, jelly.copyPositions(new Float32Array(3000)));
    assert.ok(positions.every(Number.isFinite));
    // And with what the error advises, it goes on.
    jelly.set("dt", blowUp.suggestedDt ?? "auto");
    jelly.step(100);
});
