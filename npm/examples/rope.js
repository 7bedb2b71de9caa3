// A rope, built in code: a chain of points between two hooks, with a weight in the middle.
import { Builder, init } from "sprung";
import { CatmullRomCurve3, Mesh, MeshStandardMaterial, SphereGeometry, TubeGeometry, Vector3 } from "three";

import { play, pull, say, stage } from "./stage.js";

const { scene, draw, ...view } = stage({ eye: [0, 0, 4.5], centre: [0, -0.3, 0] });
await init();

const builder = new Builder({ title: "A rope" });
const rope = builder.chain({ points: 41, step: [0.05, 0, 0], origin: [-1, 0.8, 0], mass: 0.01 }); // m, kg
builder.connect(rope, { kinds: ["structural"], stiffness: 400, damping: 0.05 }); // N/m, N·s/m
builder.connect(rope, { kinds: ["bend"], stiffness: 20 });
builder.pin([rope.first, rope.end - 1]);
const simulation = builder.simulation();
const middle = rope.index(20);
simulation.set("mass", 0.3, middle);
simulation.set("dt", "auto");

const { positions } = simulation;
const at = (point) => new Vector3().fromArray(positions, 3 * point);
const tube = new Mesh(undefined, new MeshStandardMaterial({ color: 0xc9a26b, roughness: 0.9 }));
const weight = new Mesh(new SphereGeometry(0.09, 32, 16), new MeshStandardMaterial({ color: 0x7d8794, roughness: 0.3, metalness: 0.6 }));
scene.add(tube, weight);

pull(simulation, view);
say("Pull at it.");
play((seconds) => {
    simulation.advance(seconds);
    tube.geometry.dispose();
    tube.geometry = new TubeGeometry(new CatmullRomCurve3([...rope].map(at)), 160, 0.015, 8);
    weight.position.copy(at(middle));
    draw();
});
