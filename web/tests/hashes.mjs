// The bits of every scene, in whichever browser this runs.

// Run in the page: the hashes of each scene at the steps of `goldens`.
export async function hashes(goldens) {
  const engine = await import("./engine.js");
  await engine.default({ module_or_path: "engine_bg.wasm" });
  const found = {};
  for (const [name, hashes] of Object.entries(goldens)) {
    const simulation = engine.EngineSimulation.builtin(name, []);
    found[name] = {};
    let taken = 0;
    for (const step of Object.keys(hashes)) {
      simulation.step(Number(step) - taken);
      taken = Number(step);
      found[name][step] = simulation.state_hash();
    }
    simulation.free();
  }
  return found;
}

// Both side by side.
export function printed(goldens, found, browser) {
  const rows = Object.entries(goldens).flatMap(([name, hashes]) =>
    Object.entries(hashes).map(
      ([step, native]) => `${name.padEnd(12)} ${step.padStart(5)}  ${native}  ${found[name][step]}`,
    ),
  );
  return [`${"scene".padEnd(12)} ${"step".padStart(5)}  ${"native".padEnd(16)}  ${browser}`, ...rows].join("\n");
}
