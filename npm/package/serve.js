// A simulation in a thread of its own: takes the name of a method and its arguments, and answers with what that gives.
//
// With every answer comes how things are now: step, time and positions, and velocities if they are wanted. The arrays travel
// back and forth and are copied on neither way.

import { load } from "./engine-door.js";
import { packedError } from "./errors.js";
import { Simulation } from "./simulation.js";

export function serve(post, receive) {
    let simulation;
    let wanted = []; // the arrays to send
    const spare = {}; // those that came back

    async function begin({ module, scene, velocities }) {
        await load(() => module);
        const { builtin, text, file, set } = scene;
        simulation = text === undefined ? Simulation.builtin(builtin, set) : Simulation.parse(text, set, file);
        wanted = velocities ? ["positions", "velocities"] : ["positions"];
        const { title, description, pointCount, springCount, springs, bodies, joints, surfaces } = simulation;
        return { title, description, pointCount, springCount, springs, bodies, joints, surfaces };
    }

    function taken(name) {
        const length = 3 * simulation.pointCount;
        const array = spare[name]?.length === length ? spare[name] : new Float32Array(length);
        delete spare[name];
        return name === "positions" ? simulation.copyPositions(array) : simulation.copyVelocities(array);
    }

    function invoke(method, args) {
        if (method === "keepLedger") {
            simulation.keepsLedger = args[0];
            return undefined;
        }
        return simulation[method](...args);
    }

    receive(async ({ id, method, args, returned }) => {
        Object.assign(spare, returned);
        const answer = { id };
        try {
            answer.value = method === "begin" ? await begin(args[0]) : invoke(method, args);
        } catch (error) {
            answer.error = packedError(error);
        }
        const transfer = [];
        // After an error too: a simulation that blew up is back at its last good state.
        if (simulation !== undefined) {
            const arrays = Object.fromEntries(wanted.map((name) => [name, taken(name)]));
            answer.now = { stepCount: simulation.stepCount, time: simulation.time, arrays };
            transfer.push(...Object.values(arrays).map((array) => array.buffer));
        }
        post(answer, transfer);
    });
}
