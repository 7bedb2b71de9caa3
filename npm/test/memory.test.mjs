// Memory: arrays outlive its growth, views are only lent, and what is disposed of is used again.
import assert from "node:assert/strict";
import { setImmediate } from "node:timers/promises";
import { test } from "node:test";
import { setFlagsFromString } from "node:v8";
import { runInNewContext } from "node:vm";

import { Builder, init, memoryBytes, Simulation } from "sprung";

await init();

/** Makes memory grow, and so every view of it die. */
function grow() {
    const before = memoryBytes();
    const builder = new Builder();
    const made = [];
    while (memoryBytes() === before) {
        const points = builder.grid({ points: [100, 100], spacing: 1 });
        builder.connect(points, { kinds: ["structural"], stiffness: 1 });
        made.push(builder.simulation({ dt: 0.001 }));
    }
    made.forEach((simulation) => simulation.dispose());
    builder.dispose();
}

test("an array that was kept while memory grew is alive and current", () => {
    const cloth = Simulation.builtin("cloth");
    const { positions, velocities } = cloth;
    /** @type {Float32Array} */
    let leaked = new Float32Array(1);
    cloth.withViews((views) => {
        leaked = views;
        assert.equal(views.length, positions.length);
    });
    grow();
    // This is the trap that the others are kept out of.
    assert.equal(leaked.length, 0, "a view of the engine's memory has died");
    assert.equal(positions.length, 1200);
    cloth.frame();
    assert.equal(cloth.positions, positions);
    cloth.withViews((now, speeds) => {
        assert.deepEqual(positions, Float32Array.from(now));
        assert.deepEqual(velocities, Float32Array.from(speeds));
    });
});

test("while views are lent, nothing can move what they show", () => {
    const [cloth, other] = [Simulation.builtin("cloth"), Simulation.builtin("chain")];
    const refused = { name: "SprungError", code: "Conflict", message: /views of its memory are lent out/ };
    const gave = cloth.withViews((positions) => {
        assert.throws(() => cloth.frame(), refused);
        assert.throws(() => other.frame(), refused);
        assert.throws(() => Simulation.builtin("jelly"), refused);
        assert.throws(() => cloth.positions, refused);
        assert.throws(() => other.dispose(), refused);
        return positions[0];
    });
    assert.equal(gave, -20);
    // A view in a promise would be read when it is dead.
    assert.throws(() => cloth.withViews(async () => {}), { code: "Conflict", message: /promise/ });
    assert.throws(
        () =>
            cloth.withViews(() => {
                throw new TypeError("the user's own");
            }),
        TypeError,
    );
    // After all of these it goes on.
    cloth.frame();
    other.frame();
});

test("an array that was transferred away is replaced", () => {
    const cloth = Simulation.builtin("cloth");
    const { positions } = cloth;
    structuredClone(positions, { transfer: [positions.buffer] });
    assert.equal(positions.length, 0);
    cloth.frame();
    assert.equal(cloth.positions.length, 1200);
    assert.notEqual(cloth.positions, positions);
    assert.deepEqual(cloth.positions, cloth.copyPositions(new Float32Array(1200)));
});

test("ten thousand simulations that were disposed of leave nothing behind", () => {
    const once = () => {
        const cloth = Simulation.builtin("chain");
        cloth.frame();
        cloth.positions;
        cloth.dispose();
        const builder = new Builder();
        builder.connectWithin(builder.grid({ points: [5, 5], spacing: 1 }), 1.5, { stiffness: 10 });
        const made = builder.simulation();
        made.frame();
        made.dispose();
        builder.dispose();
        assert.throws(() => Simulation.parse("dt = -1"));
    };
    for (let time = 0; time < 100; time++) once();
    const before = memoryBytes();
    for (let time = 0; time < 10_000; time++) once();
    assert.equal(memoryBytes(), before);
});

test("simulations that were forgotten are given back with the garbage", async () => {
    setFlagsFromString("--expose-gc");
    const collect = runInNewContext("gc");
    const forget = async (times) => {
        for (let time = 0; time < times; time++) {
            Simulation.builtin("jelly").positions;
            collect();
            await setImmediate(); // memory is given back between two turns
        }
    };
    await forget(20);
    const before = memoryBytes();
    await forget(100);
    assert.equal(memoryBytes(), before);
});

test("a wind that changes with every step for an hour takes no memory", () => {
    const chain = Simulation.builtin("chain");
    const blow = (steps) => {
        for (let step = 0; step < steps; step++) {
            for (let point = 1; point < 15; point++) chain.force(point, [Math.sin(step / 50 + point), 0, 0]);
            chain.step();
        }
    };
    blow(2_000);
    const before = memoryBytes();
    blow(20_000);
    assert.equal(memoryBytes(), before);
    chain.reset();
    assert.equal(chain.stepCount, 0);
});

test("what was disposed of says so", () => {
    const chain = Simulation.builtin("chain");
    const { positions, pointCount } = chain;
    chain.dispose();
    chain.dispose(); // once more does no harm
    const refused = { name: "SprungError", code: "Conflict", message: "this simulation was disposed of, and cannot be used any more" };
    assert.throws(() => chain.frame(), refused);
    assert.throws(() => chain.positions, refused);
    assert.throws(() => chain.title, refused);
    assert.equal(positions.length, 3 * pointCount);
    if (Symbol.dispose) assert.equal(chain[Symbol.dispose], chain.dispose);
});

test("a scene for which there is no room is refused before it is built", () => {
    const text = `max_springs = 4000000000
        [[body]]
        name = "a"
        lattice = { points = [200, 200, 200], spacing = 1 }
        [[body.springs]]
        radius = 2.3
        stiffness = 1`;
    assert.throws(() => Simulation.parse(text), { name: "SprungError", code: "TooLarge", message: /needs about .* GB of memory/ });
    Simulation.builtin("chain").frame();
});
