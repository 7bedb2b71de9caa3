// A hanging cloth: three.js draws the array that the simulation keeps current.
import { init, Simulation } from "sprung";
import { BufferAttribute, BufferGeometry, DoubleSide, Mesh, MeshStandardMaterial } from "three";

import { play, pull, say, stage } from "./stage.js";

const { scene, draw, ...view } = stage({ eye: [0, 2, 85], centre: [0, -8, 0] });
await init();
const cloth = Simulation.builtin("cloth");

const geometry = new BufferGeometry();
geometry.setAttribute("position", new BufferAttribute(cloth.positions, 3));
geometry.setIndex(new BufferAttribute(cloth.surfaces[0].triangles, 1));
const mesh = new Mesh(geometry, new MeshStandardMaterial({ color: 0xd1495b, roughness: 0.8, side: DoubleSide }));
mesh.frustumCulled = false; // it moves out of the bounds that it begins with
scene.add(mesh);

pull(cloth, view);
say("Pull at it.");
play((seconds) => {
    cloth.advance(3 * seconds); // a cloth of 40 m is slow: three times as fast as in nature
    geometry.attributes.position.needsUpdate = true;
    geometry.computeVertexNormals();
    draw();
});
