// Writes how a chain swings as a table: node node-csv.mjs > chain.csv
import { init, Simulation } from "sprung";

await init();
const chain = Simulation.builtin("chain", { substeps: 4 });
const { positions, pointCount } = chain;

console.log("time_s,x_m,y_m,z_m,energy_J");
for (let frame = 0; frame <= 250; frame++) {
    const end = positions.subarray(3 * (pointCount - 1));
    console.log([chain.time.toFixed(2), ...end, chain.energy().total].join(","));
    chain.frame();
}
