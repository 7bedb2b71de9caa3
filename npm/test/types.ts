// What the types allow, and what they refuse: compiled only.
import { BlowUpError, Builder, init, type Limit, type Picked, scenes, Simulation, SimulationInWorker, spawn, SprungError } from "sprung";
import { BufferAttribute, Raycaster, Vector3 } from "three";

export async function everything(canvas: HTMLCanvasElement): Promise<void> {
    await init();
    await init(new URL("https://example.org/engine_bg.wasm"));
    await init(fetch("engine_bg.wasm"));
    const kinds: ("report" | "gallery" | "benchmark")[] = scenes().map(({ kind }) => kind);
    const jelly = Simulation.builtin("jelly", { dt: 0.005, gravity: [0, -1.62, 0], "body.jelly.rotation": { axis: [1, 0, 0], degrees: 5 } });
    new BufferAttribute(jelly.positions, 3);
    const raycaster = new Raycaster();
    const picked: Picked | null = jelly.pick(raycaster.ray.origin, raycaster.ray.direction);
    if (picked) jelly.drag(picked.index, raycaster.ray.at(picked.distance, new Vector3()));
    const dt: number = jelly.get("dt");
    const masses: Float32Array = jelly.get("mass");
    const mass: number = jelly.get("mass", 3);
    const pinned: boolean = jelly.get("pinned", 3);
    const gravity: [number, number, number] = jelly.get("gravity");
    const limit: Limit = jelly.stability().everyConfiguration;
    const lowest: number = jelly.withViews((positions) => positions[1]);
    // @ts-expect-error
    jelly.get("stifness");
    // @ts-expect-error
    jelly.set("dt", "quick");
    // @ts-expect-error
    jelly.set("gravity", 9.81);
    // @ts-expect-error
    jelly.positions = new Float32Array(3);
    // @ts-expect-error
    new Simulation();
    // @ts-expect-error
    new SimulationInWorker();

    const builder = new Builder();
    const cloth = builder.grid({ points: [3, 3], spacing: 0.1 });
    builder.pin(cloth);
    builder.pin([0, 1]);
    builder.connectWithin([0, 9], 0.15, { stiffness: 50 });
    using simulation = builder.simulation({ planes: [{ y: 0, stiffness: 10 }] });
    simulation.set("mass", 1, cloth);

    const there: SimulationInWorker = await spawn({ text: "" }, { velocities: true });
    const taken: number = await there.advance(1 / 60);
    const stiffness: Float32Array = await there.get("stiffness");
    try {
        await there.step(3);
    } catch (error) {
        if (error instanceof BlowUpError) await there.set("dt", error.suggestedDt ?? "auto");
        else if (error instanceof SprungError && error.code === "OutOfRange") console.log(error.field, error.line);
    }
    console.log(kinds, dt, masses, mass, pinned, gravity, limit, lowest, canvas, taken, stiffness);
}
