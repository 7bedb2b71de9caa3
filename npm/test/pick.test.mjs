// Picking with a ray, and dragging what was met.
import assert from "node:assert/strict";
import { test } from "node:test";

import { init, Simulation } from "sprung";
import { PerspectiveCamera, Raycaster, Vector2, Vector3 } from "three";

await init();

/** What three.js casts through a place of the picture, from (−1, −1) to (1, 1). */
function cast(camera, at) {
    const raycaster = new Raycaster();
    raycaster.setFromCamera(at, camera);
    return raycaster.ray;
}

function cameraAt(x, y, z) {
    const camera = new PerspectiveCamera(40, 16 / 9, 0.1, 1000);
    camera.position.set(x, y, z);
    camera.lookAt(0, 0, 0);
    camera.updateMatrixWorld();
    return camera;
}

test("every point of the jelly that can be seen is met where three.js draws it", () => {
    const jelly = Simulation.builtin("jelly");
    const camera = cameraAt(40, 30, 50);
    const skin = new Set(jelly.surfaces[0].triangles);
    let met = 0;
    for (let point = 0; point < jelly.pointCount; point += 13) {
        const place = new Vector3(...jelly.positions.subarray(3 * point, 3 * point + 3));
        const seen = place.clone().project(camera);
        const ray = cast(camera, new Vector2(seen.x, seen.y));
        const picked = jelly.pick(ray.origin, ray.direction, { spread: 0.005 });
        assert.ok(picked !== null);
        const corners = picked.kind === "point" ? [picked.index] : [...jelly.springs.subarray(2 * picked.index, 2 * picked.index + 2)];
        assert.ok(corners.every((corner) => skin.has(corner)), `${picked.name} is inside`);
        if (picked.kind === "point" && picked.index === point) {
            met++;
            assert.ok(place.distanceTo(new Vector3(...picked.position)) < 1e-5);
            assert.equal(picked.name, `point ${point} of jelly`);
        }
    }
    assert.ok(met > 10, `${met} points were met`);
    const ray = cast(camera, new Vector2(0.99, 0.99));
    assert.equal(jelly.pick(ray.origin, ray.direction), null);
});

test("a point that is dragged follows, and is let go with its speed", () => {
    const cloth = Simulation.builtin("cloth");
    const camera = cameraAt(0, 40, 60);
    const point = 399;
    const place = new Vector3(...cloth.positions.subarray(3 * point));
    const seen = place.clone().project(camera);
    const ray = cast(camera, new Vector2(seen.x, seen.y));
    const picked = cloth.pick(ray.origin, ray.direction);
    assert.deepEqual([picked?.kind, picked?.index], ["point", point]);
    const limit = cloth.certifiedLimit().dt;

    const target = new Vector3(10, 20, 45);
    cloth.drag(point, target);
    assert.ok(cloth.certifiedLimit().dt > cloth.get("dt") && cloth.certifiedLimit().dt <= limit, "the pull keeps dt within its limit");
    for (let frame = 0; frame < 60; frame++) cloth.frame();
    const near = () => target.distanceTo(new Vector3(...cloth.positions.subarray(3 * point)));
    assert.ok(near() < 6, `${near()} m away`);
    assert.ok(cloth.energy().workIn > 0);
    target.set(-10, 25, 40);
    cloth.drag(point, target);
    for (let frame = 0; frame < 60; frame++) cloth.frame();
    assert.ok(near() < 6, `${near()} m away`);
    cloth.release(point);
    const before = cloth.positions[3 * point + 1];
    for (let frame = 0; frame < 30; frame++) cloth.frame();
    assert.ok(cloth.positions[3 * point + 1] < before, "it falls");

    cloth.drag(200, [0, 0, 0], { stiffness: 5, damping: 0.1 });
    cloth.frame();
});

test("what cannot be picked or dragged says so", () => {
    const cloth = Simulation.builtin("cloth");
    const refuse = (act, message) => assert.throws(act, { name: "SprungError", message });
    refuse(() => cloth.drag(0, [0, 0, 0]), "drag: point 0 of cloth is fixed, and a pull does not move it; unpin it");
    refuse(() => cloth.drag(400, [0, 0, 0]), "drag: there is no point 400; points are 0 to 399");
    refuse(() => cloth.drag(1.5, [0, 0, 0]), "drag: is 1.5, and must be a whole number of at least 0");
    // @ts-expect-error
    refuse(() => cloth.drag(5, [0, 0]), /^target: is \[0, 0\], and must be three numbers/);
    refuse(() => cloth.drag(5, [0, 0, 1e30]), /1e30|1000000000000000/);
    refuse(() => cloth.pick([0, 0, 0], [0, 0, 0]), "direction: is [0, 0, 0], and must be finite and not zero");
    refuse(() => cloth.pick([0, 0, 0], [0, 0, 1], { radius: -1 }), /^radius: is -1/);
    refuse(() => cloth.pick(/** @type {any} */ (undefined), [0, 0, 1]), /^origin: is missing, and must be three numbers/);
});
