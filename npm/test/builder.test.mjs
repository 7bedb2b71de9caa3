// Points and springs in code.
import assert from "node:assert/strict";
import { test } from "node:test";

import { Builder, init, Simulation } from "sprung";

await init();

test("the cloth of the report, in code, has the bits of the scene", () => {
    const builder = new Builder({ title: "Mine" });
    builder.body("cloth");
    const cloth = builder.grid({ points: [20, 20], spacing: 2, plane: "xz", origin: [-20, 10, 0], mass: 0.5 });
    assert.deepEqual([cloth.first, cloth.end, cloth.count], [0, 400, 400]);
    builder.connectWithin(cloth, 2.82942712474619, { stiffness: 600, damping: 3 });
    builder.pin([...cloth.side("left-back"), ...cloth.side("right-back")]);
    const mine = builder.simulation({ dt: 0.01, substeps: 7 });
    const theirs = Simulation.builtin("cloth");
    assert.equal(mine.title, "Mine");
    assert.deepEqual(mine.bodies, theirs.bodies);
    assert.deepEqual(mine.surfaces, theirs.surfaces);
    assert.deepEqual(mine.springs, theirs.springs);
    for (let frame = 0; frame < 100; frame++) {
        mine.frame();
        theirs.frame();
    }
    assert.equal(mine.stateHash(), theirs.stateHash());
});

test("chains, blocks and single points are joined in every way", () => {
    const builder = new Builder();
    builder.body("rope");
    const rope = builder.chain({ points: 5, step: [0, -1, 0], origin: { x: 0, y: 10, z: 0 }, mass: 0.1 });
    assert.deepEqual(builder.connect(rope, { kinds: ["structural"], stiffness: 100, damping: 1 }), [0, 4]);
    assert.deepEqual([...rope.side("start"), ...rope.side("end")], [0, 4]);
    builder.body("block");
    const block = builder.lattice({ points: [2, 3, 4], spacing: 0.5, origin: [0, 5, 0] });
    assert.deepEqual([block.first, block.end, block.index(1, 2, 3), block.index(0, 0, 1)], [5, 29, 28, 6]);
    const [first, end] = builder.connect(block, { kinds: ["structural", "shear", "bend"], stiffness: 50 });
    assert.equal(first, 4);
    builder.body("weights");
    const weights = builder.points([[0, 0, 0], { x: 1, y: 0, z: 0 }, new Float32Array([2, 0, 0])], { mass: [1, 2, 0] });
    const flat = builder.points(new Float32Array([0, 1, 0, 1, 1, 0]));
    assert.deepEqual([...weights, ...flat], [29, 30, 31, 32, 33]);
    const single = builder.point([5, 5, 5], { mass: 0 });
    builder.surface([[29, 30, 31]]);
    builder.joint("rope - block");
    assert.deepEqual(builder.connectBetween(rope, block, 1.01, { stiffness: 10 })[0], end);
    assert.equal(builder.spring(29, 30, { stiffness: 1, restLength: 0.5 }), builder.springCount - 1);
    builder.springs([[30, 31], [31, single]], { stiffness: 2 });
    builder.pin(0);
    builder.velocity(block, [1, 0, 0]);
    const simulation = builder.simulation({ gravity: [0, -2, 0], planes: [{ y: -1, stiffness: 10, damping: 1 }] });
    assert.deepEqual(simulation.bodies.map(({ name, points }) => [name, ...points]), [["rope", 0, 5], ["block", 5, 29], ["weights", 29, 35]]);
    assert.deepEqual(simulation.joints.map(({ name }) => name), ["rope - block"]);
    assert.deepEqual(simulation.surfaces.map(({ body, kind }) => [body, kind]), [["block", "skin"], ["weights", "cloth"]]);
    assert.deepEqual([30, 31, single].map((point) => simulation.get("mass", point)), [2, 0, 0]);
    assert.deepEqual([...simulation.velocities.subarray(3 * 7, 3 * 8)], [1, 0, 0]);
    assert.equal(simulation.get("restLength", builder.springCount - 3), 0.5);
    assert.equal(simulation.get("pinned", 0), true);
    simulation.step(100);
    // What was built stays, and more can be added.
    builder.point([0, 20, 0]);
    assert.equal(builder.simulation().pointCount, simulation.pointCount + 1);
});

test("mistakes are refused with their place", () => {
    const builder = new Builder();
    const sheet = builder.grid({ points: [3, 3], spacing: 1 });
    const refuse = (act, message) => assert.throws(act, { name: "SprungError", message });
    refuse(() => builder.grid({ points: [3, 0], spacing: 1 }), "points: is 0, and must be at least 1");
    refuse(() => builder.grid({ points: [3.5, 2], spacing: 1 }), "points: is 3.5, and must be a whole number of at least 0");
    refuse(() => builder.grid({ points: [3, 2], spacing: 0 }), "spacing: is 0, and must be a finite number above 0 m");
    // @ts-expect-error
    refuse(() => builder.grid({ points: [3, 2], spacin: 1 }), /^grid: has "spacin", which is not a known key; allowed here are points, spacing/);
    // @ts-expect-error
    refuse(() => builder.grid({ points: [3, 2] }), "spacing: is missing, and must be a number");
    refuse(() => builder.grid({ points: [1e5, 1e5], spacing: 1 }), /^points: makes 10000000000 points, and there may be at most /);
    // @ts-expect-error
    refuse(() => builder.grid({ points: [2, 2], spacing: 1, plane: "zx" }), 'plane: is "zx", and must be one of "xy", "xz", "yz"');
    refuse(() => sheet.side("top"), /^side: there is no side "top"; there are left, right, back, front/);
    refuse(() => sheet.index(3, 0), /no point at 3, 0, 0/);
    refuse(() => builder.point([0, 0, 0], { mass: -1 }), /^mass: is -1, and must be 0 kg/);
    refuse(() => builder.point([0, NaN, 0]), /^position: is NaN/);
    // @ts-expect-error
    refuse(() => builder.point([0, 1]), /^position: is \[0, 1\], and must be three numbers/);
    refuse(() => builder.spring(0, 0, { stiffness: 1 }), "a spring joins point 0 to itself");
    refuse(() => builder.spring(0, 99, { stiffness: 1 }), "there is no point 99; points are 0 to 8");
    refuse(() => builder.spring(0, 1, { stiffness: -1 }), /^stiffness: is -1, and must be from 0/);
    // @ts-expect-error
    refuse(() => builder.spring(0, 1), "stiffness: is missing, and must be a number");
    refuse(() => builder.connectWithin(sheet, -1, { stiffness: 1 }), /-1/);
    refuse(() => builder.pin(12), "there is no point 12; points are 0 to 8");
    refuse(() => builder.surface([0, 1]), /^triangles: has 2 corners/);
    refuse(() => builder.surface([0, 1, 77]), "there is no point 77; points are 0 to 8");
    refuse(() => builder.simulation({ planes: [{ stiffness: 3 }] }), "planes[0].y: is missing, and must be a number");
    refuse(() => builder.simulation({ dt: 0 }), /^dt: is 0, and must be from 1e-9/);
    refuse(() => new Builder().simulation(), "there are no points; a model needs at least one");
    builder.dispose();
    refuse(() => builder.point([0, 0, 0]), "this builder was disposed of, and cannot be used any more");
});
