"""Threads, Ctrl-C, forks and memory."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from pathlib import Path

import numpy as np
import pytest

import sprung


def test_other_threads_go_on_while_it_steps() -> None:
    simulation = sprung.scene("cloth512").simulation(threads=1)
    counted = 0
    done = threading.Event()

    def step() -> None:
        simulation.step(60)
        done.set()

    thread = threading.Thread(target=step)
    thread.start()
    while not done.wait(0.0001):
        counted += 1
    thread.join()
    assert counted > 10


def test_two_simulations_in_two_threads(goldens: dict[str, dict[str, str]]) -> None:
    hashes: dict[str, str] = {}

    def run(name: str) -> None:
        simulation = sprung.scene(name).simulation()
        simulation.step(1000)
        hashes[name] = simulation.state_hash

    threads = [threading.Thread(target=run, args=(name,)) for name in ("jelly", "cloth", "flag", "chain")]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert hashes == {name: goldens[name]["1000"] for name in hashes}


def test_one_simulation_in_two_threads_takes_all_steps(goldens: dict[str, dict[str, str]]) -> None:
    simulation = sprung.scene("jelly").simulation()

    def step() -> None:
        for _ in range(50):
            simulation.step(10)
            assert simulation.positions.shape == (1000, 3)

    threads = [threading.Thread(target=step) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert simulation.steps_taken == 1000 and simulation.state_hash == goldens["jelly"]["1000"]


@pytest.mark.skipif(os.name == "nt", reason="signals are sent otherwise there")
@pytest.mark.parametrize("work", ["it.step(10**9)", "it.run(1e5, every=10**5)", "it.settle(residual_force=0)"])
def test_ctrl_c_ends_it(work: str) -> None:
    # What is started in the background by a shell ignores it.
    code = f"""
import signal, sprung
signal.signal(signal.SIGINT, signal.default_int_handler)
it = sprung.scene("jelly").simulation()
print("going", flush=True)
try:
    {work}
except KeyboardInterrupt:
    it.step()
    print("ended", it.positions.shape)
"""
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None and process.stdout.readline() == "going\n"
        # Not before it is at work: what comes earlier ends it just the same.
        threading.Event().wait(0.2)
        process.send_signal(signal.SIGINT)
        assert process.communicate(timeout=300)[0] == "ended (1000, 3)\n"


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork")
def test_a_forked_process_steps_on(goldens: dict[str, dict[str, str]]) -> None:
    step, expected = max(goldens["cloth512"].items(), key=lambda golden: int(golden[0]))
    code = f"""
import os, sprung
it = sprung.scene("cloth512").simulation(threads=2)
it.step(1)
child = os.fork()
it.step({step} - 1)
assert it.state_hash == {expected!r}
if child == 0:
    os._exit(0)
assert os.waitpid(child, 0)[1] == 0
print("both")
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=300)
    assert done.stdout == "both\n", done.stderr


@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="the system does not tell")
def test_nothing_leaks() -> None:
    def resident() -> int:
        return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")

    simulation = sprung.scene("chain").simulation()
    scene = sprung.scene("spring")

    def steps(count: int) -> None:
        for number in range(count):
            simulation.step()
            _ = simulation.positions, simulation.velocities, simulation.stiffness
            if number % 100 == 0:
                simulation.external_forces = simulation.positions * 0
                _ = simulation.energy

    def simulations(count: int) -> None:
        for _ in range(count):
            made = scene.simulation()
            made.step()
            _ = made.positions
            try:
                made.dt = -1
            except sprung.Error:
                pass

    cloud = sprung.Model(np.random.default_rng(1).random((100_000, 3)), 1.0).simulation(dt=0.01)

    def winds(count: int) -> None:
        for number in range(count):
            cloud.external_forces = np.full((cloud.point_count, 3), 1.0 + number)
            cloud.step()

    winds(20)
    before = resident()
    winds(100)
    # What was done is remembered as long as somebody could go back: a hundred winds would be 400 MB and more.
    assert resident() - before < 100_000_000, f"winds: {resident() - before} bytes more"

    for work, count in ((steps, 100_000), (simulations, 10_000)):
        work(count // 10)
        before = resident()
        work(count)
        # A leak of 100 bytes each would be 1 MB of the simulations, and 10 MB of the steps.
        assert resident() - before < 1_000_000, f"{work.__name__}: {resident() - before} bytes more"
