// A cube of jelly falls on its plane: the skin of a thousand points, and the limit on dt as it changes.
import { init, Simulation } from "sprung";
import { BufferAttribute, BufferGeometry, GridHelper, Mesh, MeshPhysicalMaterial } from "three";

import { play, pull, say, stage } from "./stage.js";

const { scene, draw, ...view } = stage({ eye: [46, 16, 70], centre: [0, -2, 0] });
await init();
const jelly = Simulation.builtin("jelly");

const geometry = new BufferGeometry();
geometry.setAttribute("position", new BufferAttribute(jelly.positions, 3));
geometry.setIndex(new BufferAttribute(jelly.surfaces[0].triangles, 1));
const skin = new Mesh(geometry, new MeshPhysicalMaterial({ color: 0xff9a5c, roughness: 0.25, clearcoat: 1, flatShading: false }));
skin.frustumCulled = false;
const [{ point }] = jelly.get("planes");
const ground = new GridHelper(80, 20, 0x596273, 0x323945);
ground.position.y = point[1];
scene.add(skin, ground);

pull(jelly, view);
let picture = 0;
play((seconds) => {
    jelly.advance(3 * seconds);
    geometry.attributes.position.needsUpdate = true;
    geometry.computeVertexNormals();
    draw();
    if (picture++ % 30 === 0) {
        const { dt, setBy } = jelly.certifiedLimit();
        say(`Pull at it. dt = ${jelly.get("dt")} s is safe up to ${dt.toPrecision(3)} s, which ${setBy} sets.`);
    }
});
