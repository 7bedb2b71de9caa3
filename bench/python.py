"""Stepping from Python beside stepping from Rust, in turn, in one sitting.

    python bench/python.py [SPRUNG]

SPRUNG is the command of a release build (default: target/release/sprung); the package `sprung` must be installed.
For each scene both take as many steps at a time from the same start, and the fastest of all runs counts on each side.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import time

import numpy as np

import sprung

SCENES = ["cloth", "jelly", "cloth512", "jelly64"]
ROUNDS = 4
#: As `sprung bench`: springs evaluated in a run, runs in a round, and the speed of the noise at the start, m/s.
WORK, RUNS, NOISE = 20_000_000, 5, 0.1


def rust(command: str, scene: str, threads: int) -> tuple[float, int]:
    """ns for each spring and step of the Rust benchmark, and the steps in a run."""
    arguments = [command, "bench", scene, "--threads", str(threads), "--json"]
    figures = json.loads(subprocess.run(arguments, capture_output=True, check=True, text=True).stdout)
    return figures["ns_per_spring_step"], figures["steps"]


def python(scene: str, threads: int, steps: int) -> float:
    """The same from Python, in a process of its own too."""
    arguments = [sys.executable, __file__, "--one", scene, str(threads), str(steps)]
    return float(subprocess.run(arguments, capture_output=True, check=True, text=True).stdout)


def one(scene: str, threads: int, steps: int) -> float:
    """One call for all steps of a run."""
    simulation = sprung.scene(scene).simulation(threads=threads)
    noise = np.random.default_rng(1).uniform(-NOISE, NOISE, (simulation.point_count, 3))
    simulation.set_state(velocities=noise)
    # What is made once: the threads' own parts of the scene.
    simulation.step(1)
    best = float("inf")
    for _ in range(RUNS):
        begin = time.perf_counter()
        simulation.step(steps)
        best = min(best, time.perf_counter() - begin)
    return best / steps / simulation.spring_count * 1e9


def single_steps() -> float:
    """Microseconds of a call `step(1)` on the smallest scene."""
    simulation = sprung.scene("spring").simulation()
    count, best = 20_000, float("inf")
    for _ in range(20):
        begin = time.perf_counter()
        for _ in range(count):
            simulation.step(1)
        best = min(best, time.perf_counter() - begin)
    return best / count * 1e6


def main() -> None:
    if sys.argv[1:2] == ["--one"]:
        print(one(sys.argv[2], int(sys.argv[3]), int(sys.argv[4])))
        return
    command = sys.argv[1] if len(sys.argv) > 1 else "target/release/sprung"
    if shutil.which(command) is None:
        sys.exit(f"{command} is no program: first `cargo build --release`, or say where the command is")
    print("| scene | springs | threads | Rust, ns | Python, ns | ratio |\n|---|---:|---:|---:|---:|---:|")
    for scene in SCENES:
        springs = sprung.scene(scene).simulation().spring_count
        for threads in (1, 2):
            best = {"rust": float("inf"), "python": float("inf")}
            for _ in range(ROUNDS):
                figure, steps = rust(command, scene, threads)
                best["rust"] = min(best["rust"], figure)
                best["python"] = min(best["python"], python(scene, threads, steps))
            ratio = best["python"] / best["rust"]
            print(f"| {scene} | {springs:,} | {threads} | {best['rust']:.3f} | {best['python']:.3f} | {ratio:.3f} |", flush=True)
    print(f"\n`step(1)` on the spring with one mass: {single_steps():.2f} µs a call.")


if __name__ == "__main__":
    main()
