// The sentences of the command: sentences.json holds them, and the command's own tests meet them too.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { test } from "node:test";

import { init, Simulation, SprungError } from "sprung";

test("before the engine is loaded, everything says so", () => {
    assert.throws(() => Simulation.builtin("cloth"), { name: "SprungError", message: "the engine is not loaded yet; call `await init()` first" });
});

test("an engine that is not there says where it was looked for", async () => {
    await assert.rejects(init(new URL("file:///nowhere/engine_bg.wasm")), { code: "Unreadable", message: /^the engine cannot be loaded from file:\/\/\/nowhere/ });
    await assert.rejects(init(new Uint8Array([1, 2, 3])), { code: "Unsupported", message: /^the engine cannot be compiled here/ });
    await init(); // and then the right one is loaded
});

const cases = JSON.parse(await readFile(new URL("sentences.json", import.meta.url), "utf8"));

for (const { about, scene, builtin, set, sentence } of cases) {
    test(about, async () => {
        await init();
        let error;
        try {
            if (builtin !== undefined) Simulation.builtin(builtin, set);
            else Simulation.parse(scene, set, "bad.toml");
        } catch (thrown) {
            error = thrown;
        }
        assert.ok(error instanceof SprungError, "it is refused");
        assert.equal(error.message, sentence);
        // The parts make up the whole.
        const { file, line, column, field, fix } = error;
        const place = file === undefined ? "" : line === undefined ? `${file}: ` : `${file}:${line}:${column}: `;
        const whole = `${place}${field === undefined ? "" : `${field}: `}${error.sentence}${fix === undefined ? "" : `; ${fix}`}`;
        assert.equal(whole, sentence);
        assert.match(error.code, /^[A-Z][A-Za-z]+$/);
    });
}

test("a scene with a mesh says that nobody can read it here", async () => {
    await init();
    const scene = '[[body]]\nname = "towel"\nmesh = "towel.obj"\ncloth = { density = 0.4, stiffness = 150 }\n';
    assert.throws(() => Simulation.parse(scene), { name: "SprungError", code: "Unreadable", field: "body[0].mesh", line: 3 });
});

test("what is of the wrong kind is said as clearly", async () => {
    await init();
    const cloth = Simulation.builtin("cloth");
    const refuse = (act, message) => assert.throws(act, { name: "SprungError", message });
    const any = (value) => /** @type {any} */ (value);
    refuse(() => Simulation.builtin(any(undefined)), "name: is missing, and must be a text");
    refuse(() => Simulation.parse(any(7)), "scene: is 7, and must be a text");
    refuse(() => Simulation.builtin("cloth", any("dt=3")), 'set: is "dt=3", and must be an object');
    refuse(() => Simulation.builtin("cloth", any({ dt: null })), /^dt: is null, and must be a number, a text/);
    refuse(() => new (any(Simulation))(), "a simulation is not made with new; use Simulation.builtin, Simulation.parse or a Builder");
    refuse(() => cloth.step(1.5), "step: is 1.5, and must be a whole number of at least 0");
    refuse(() => cloth.step(-1), "step: is -1, and must be a whole number of at least 0");
    refuse(() => cloth.step(any("3")), 'step: is "3", and must be a number');
    refuse(() => cloth.step(NaN), "step: is NaN, and must be a whole number of at least 0");
    refuse(() => cloth.advance(-1), "seconds: is -1, and must be from 0 to 1e9 s");
    refuse(() => cloth.set("dt", 0), /^dt: is 0, and must be from 1e-9 to 1e3/);
    refuse(() => cloth.set("gravity", any([0, 1])), /^gravity: is \[0, 1\], and must be three numbers/);
    refuse(() => cloth.set("mass", -2), /^mass: is -2, and must be 0 kg/);
    refuse(() => cloth.set("mass", 1, "cloht"), 'mass: there is nothing called "cloht"; there are "cloth"');
    refuse(() => cloth.set("mass", 1, [390, 500]), "mass: names indices 390 to 499, and there are 400");
    refuse(() => cloth.set(any("stifness"), 1), /^name: is "stifness", and must be one of "dt"/);
    refuse(() => cloth.get(any("stifness")), /did you mean "stiffness"\?$/);
    refuse(() => cloth.get("mass", 400), "mass: there is no point 400; points are 0 to 399");
    refuse(() => cloth.pin(400), /400/);
    refuse(() => cloth.force(3, any("up")), /^force: is "up", and must be three numbers/);
    refuse(() => cloth.place(-1, [0, 0, 0]), "place: is -1, and must be a whole number of at least 0");
    refuse(() => cloth.copyPositions(any([])), "target: must be a Float32Array with three numbers for each point");
    refuse(() => cloth.copyPositions(new Float32Array(3)), "target: has room for 3 numbers, and 1200 are needed: three for each point");
    // Whatever was refused, nothing has changed.
    assert.equal(cloth.stateHash(), Simulation.builtin("cloth").stateHash());
});
