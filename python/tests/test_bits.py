"""The same bits as the command, the Rust library and every other door."""

from __future__ import annotations

import copy
import pickle
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import sprung

Goldens = dict[str, dict[str, str]]


@pytest.mark.parametrize("name", [scene.name for scene in sprung.scenes()])
def test_every_scene_has_the_hashes_of_the_native_program(name: str, goldens: Goldens) -> None:
    simulation = sprung.scene(name).simulation()
    for step, expected in goldens[name].items():
        simulation.step(int(step) - simulation.steps_taken)
        assert simulation.state_hash == expected, f"{name} after {step} steps"


def test_all_goldens_are_met(goldens: Goldens) -> None:
    assert sorted(goldens) == sorted(scene.name for scene in sprung.scenes())


def test_the_command_in_the_package_says_the_same_hash(jelly: sprung.Simulation) -> None:
    command = [sys.executable, "-m", "sprung", "run", "jelly", "--frames", "8"]
    said = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    found = re.search(r"state hash ([0-9a-f]{16})", said)
    assert found is not None, said
    jelly.step(8 * jelly.substeps)
    assert jelly.state_hash == found[1]


@pytest.mark.parametrize("name", ["cloth", "jelly", "cloth512"])
def test_threads_and_portions_change_no_bit(name: str) -> None:
    scene = sprung.scene(name)
    hashes = set()
    for threads, portions in [(1, [12]), (2, [5, 7]), (3, [1] * 12)]:
        simulation = scene.simulation(threads=threads)
        for portion in portions:
            simulation.step(portion)
        hashes.add(simulation.state_hash)
    assert len(hashes) == 1


def test_arrays_make_the_model_that_a_scene_makes() -> None:
    by_scene = sprung.Scene.from_toml("""
dt = 0.002
[[plane]]
y = -1.0
stiffness = 50
damping = 0.5
[[body]]
name = "cloth"
grid = { points = [12, 9], spacing = 0.1, plane = "xy", origin = [0.5, 1, 0] }
point_mass = 0.01
pins = ["left"]
[[body.springs]]
kinds = ["structural", "shear", "bend"]
stiffness = 80
damping = 0.05
""").simulation()
    sheet = sprung.grid(12, 9, spacing=0.1, plane="xy", origin=[0.5, 1, 0])
    model = sprung.Model(
        sheet.positions,
        0.01,
        sheet.springs("structural", "shear", "bend"),
        stiffness=80,
        damping=0.05,
        pinned=sheet.side("left"),
    )
    by_arrays = model.simulation(dt=0.002, planes=[sprung.Plane(y=-1, stiffness=50, damping=0.5)])
    assert (by_scene.springs == by_arrays.springs).all()
    by_scene.step(500)
    by_arrays.step(500)
    assert by_scene.state_hash == by_arrays.state_hash


@pytest.mark.parametrize("again", [copy.deepcopy, copy.copy, lambda one: pickle.loads(pickle.dumps(one))])
@pytest.mark.parametrize("made", ["scene", "model"])
def test_a_copy_goes_on_with_the_same_bits(made: str, again: object) -> None:
    if made == "scene":
        one = sprung.scene("jelly").simulation()
    else:
        block = sprung.lattice(5, 4, 3, spacing=0.2)
        one = sprung.Model(block.positions, 0.1, block.springs(), stiffness=200, damping=0.1).simulation(
            planes=[sprung.Plane(y=-0.3, stiffness=80, damping=0.2)]
        )
    one.step(41)
    one.stiffness = one.stiffness * 1.5
    one.cut = np.arange(one.spring_count) % 50 == 0
    one.keeps_ledger = True
    other = again(one)  # type: ignore[operator]
    for simulation in (one, other):
        simulation.step(77)
    assert one.state_hash == other.state_hash
    assert one.energy == other.energy
    assert other.keeps_ledger
    assert (other.cut == one.cut).all()


def test_checkpoints_go_on_in_another_process(jelly: sprung.Simulation, tmp_path: Path) -> None:
    jelly.step(60)
    path = jelly.save(tmp_path / "jelly.sprung")
    jelly.step(60)
    code = f"import sprung; it = sprung.load({str(path)!r}, threads=1); it.step(60); print(it.state_hash)"
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert said.strip() == jelly.state_hash
    assert sprung.load(path).title == jelly.title


def test_reset_goes_back_to_the_start(jelly: sprung.Simulation) -> None:
    start = jelly.state_hash
    jelly.step(10)
    jelly.gravity = [0, 0, 0]
    jelly.step(10)
    jelly.reset()
    assert jelly.state_hash == start
    assert jelly.gravity.tolist() == pytest.approx([0, -9.81, 0])


def test_threads_settle_to_the_same_bits() -> None:
    sheet = sprung.grid(300, 300, spacing=0.1)
    springs = sheet.springs("structural", "shear")
    model = sprung.Model(
        sheet.positions, 0.01, springs, stiffness=80, damping=0.05, pinned=sheet.side("left")
    )
    hashes = set()
    for threads in (1, 2, 3):
        simulation = model.simulation(threads=threads)
        # A little more than half of a point's weight: some dozens of steps, with several stops.
        assert simulation.settle(residual_force=0.06) <= 0.06
        hashes.add(simulation.state_hash)
    assert len(hashes) == 1
