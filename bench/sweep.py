"""Runs a second of a sweep, and what a run costs besides its steps.

    python bench/sweep.py [WORKERS]

The package `sprung[sweep]` must be installed. It takes a minute or two. docs/scale.md has what it printed.
"""

from __future__ import annotations

import os
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import distributed

import sprung
from sprung.sweep.measures import measure_of
from sprung.sweep.plan import Experiment, Grid
from sprung.sweep.workers import client_of

SCENES = ["chain", "cloth", "jelly", "flag"]
#: Simulated time of a run, s, and the noise at its start, m/s.
SECONDS, NOISE = 2, 0.1
#: How long a sweep is to take, s; how often it is done, the best of which counts; and empty tasks.
BUDGET, ROUNDS, TASKS = 1, 4, 1000


def cost(runs: int, work: Callable[[], object]) -> tuple[float, float]:
    """Seconds for each run: of the clock, and of all processors, which hardly mind what else the machine does."""
    clock, processors = time.perf_counter(), time.process_time()
    work()
    return (time.perf_counter() - clock) / runs, (time.process_time() - processors) / runs


def steps_alone(name: str) -> float:
    """Seconds for nothing but the steps of a run, as many as a sweep takes."""
    simulation = sprung.scene(name).simulation(threads=1)
    steps = round(SECONDS / simulation.dt)
    steps -= steps % simulation.substeps
    return min(cost(1, lambda: (simulation.reset(), simulation.step(steps)))[0] for _ in range(20))


def one_by_one(name: str) -> float:
    """Seconds for a run as a worker does it, with the making of the simulation and its line of the journal."""
    experiment = Experiment(sprung.scene(name), SECONDS, None, NOISE, None, measure_of(()), None)
    grid = Grid([{}], {}, range(10**9))
    trials = [grid[run] for run in range(max(1, int(0.05 / steps_alone(name))))]
    return min(cost(len(trials), lambda: experiment.lines(trials, lambda: False))[0] for _ in range(20))


def swept(name: str, runs: int, workers: int) -> tuple[float, float, float]:
    """Seconds for each run of a whole sweep, of the clock and of processors; and the bytes of its line."""
    costs = []
    for _ in range(ROUNDS):
        with tempfile.TemporaryDirectory() as out:

            def work(out: str = out) -> None:
                sprung.sweep(
                    name, seconds=SECONDS, seeds=runs, noise=NOISE, out=out, workers=workers, progress=False
                )

            costs.append(cost(runs, work))
            size = (Path(out) / "journal.jsonl").stat().st_size / runs
    return min(clock for clock, _ in costs), min(processors for _, processors in costs), size


def empty_task(client: distributed.Client) -> float:
    """Seconds for a task that does nothing, handed out as a sweep does."""

    def work() -> None:
        futures = [client.submit(abs, number, pure=False) for number in range(TASKS)]
        for _ in distributed.as_completed(futures, loop=client.loop, with_results=True):
            pass

    return min(cost(TASKS, work)[0] for _ in range(3))


def main() -> None:
    workers = int(sys.argv[1]) if len(sys.argv) > 1 else os.cpu_count() or 1
    print("| scene | steps alone | a run alone | a run of a sweep, processor | runs a second | its line |")
    print("|---|---:|---:|---:|---:|---:|")
    for name in SCENES:
        alone, one = steps_alone(name), one_by_one(name)
        clock, processors, size = swept(name, max(8, int(BUDGET * workers / one)), workers)
        times = " | ".join(f"{seconds * 1e3:.2f} ms" for seconds in (alone, one, processors))
        print(f"| {name} | {times} | {1 / clock:.0f} | {size:.0f} bytes |", flush=True)
    with client_of(None, workers) as client:
        print(
            f"\nAn empty task: {empty_task(client) * 1e3:.1f} ms on {workers} threads of this process,",
            end="",
        )
    with (
        distributed.LocalCluster(
            n_workers=workers, threads_per_worker=1, dashboard_address="127.0.0.1:0"
        ) as cluster,
        distributed.Client(cluster, set_as_default=False) as client,
    ):
        print(f" {empty_task(client) * 1e3:.1f} ms on {workers} processes over TCP.")
    runs = 100_000
    with tempfile.TemporaryDirectory() as out:

        def table() -> None:
            sprung.sweep("spring", seconds=0, seeds=runs, out=out, progress=False)

        table()
        print(f"The table of {runs} finished runs: {cost(1, table)[0]:.1f} s.")


if __name__ == "__main__":
    main()
