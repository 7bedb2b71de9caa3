"""Arrays in and out: views that never change under the user, and input of every kind."""

from __future__ import annotations

import gc
from typing import Any

import numpy as np
import pytest

import sprung


def test_what_was_asked_for_stays_as_it_was(jelly: sprung.Simulation) -> None:
    kept = [(jelly.positions, jelly.positions.copy())]
    for _ in range(5):
        jelly.step(3)
        kept.append((jelly.positions, jelly.positions.copy()))
    assert all((array == copy).all() for array, copy in kept)
    assert all((one[0] != other[0]).any() for one, other in zip(kept, kept[1:], strict=False))


def test_memory_is_used_again_where_nobody_looks(jelly: sprung.Simulation) -> None:
    addresses = set()
    for _ in range(20):
        jelly.step()
        addresses.add(jelly.positions.ctypes.data)
    assert len(addresses) == 1, "no copy for each step"
    held = jelly.positions
    jelly.step()
    assert jelly.positions.ctypes.data != held.ctypes.data
    part = held[::7, 1]
    del held
    before = part.copy()
    jelly.step()
    assert (part == before).all(), "a part keeps the whole alive"


def test_positions_and_velocities_are_of_one_moment_and_share_nothing(jelly: sprung.Simulation) -> None:
    jelly.step(5)
    positions, velocities = jelly.positions, jelly.velocities
    assert positions is not jelly.positions, "a view of its own"
    assert positions.ctypes.data == jelly.positions.ctypes.data, "and no copy"
    assert not np.shares_memory(positions, velocities)
    assert positions.dtype == velocities.dtype == np.float32
    assert positions.shape == velocities.shape == (1000, 3)
    assert positions.flags.c_contiguous


@pytest.mark.parametrize(
    "name", ["positions", "velocities", "mass", "stiffness", "damping", "rest_lengths", "pinned", "cut"]
)
def test_nothing_is_written_through_a_view(jelly: sprung.Simulation, name: str) -> None:
    array = getattr(jelly, name)
    with pytest.raises(ValueError, match="read-only"):
        array[0] = 0
    with pytest.raises(ValueError, match="WRITEABLE"):
        array.flags.writeable = True


@pytest.mark.parametrize("name", ["gravity", "external_forces", "springs"])
def test_nor_into_what_would_be_lost(jelly: sprung.Simulation, name: str) -> None:
    with pytest.raises(ValueError, match="read-only"):
        getattr(jelly, name)[...] = 0


def test_an_array_outlives_its_simulation() -> None:
    simulation = sprung.scene("cloth").simulation()
    simulation.step(3)
    positions, stiffness = simulation.positions, simulation.stiffness
    copies = positions.copy(), stiffness.copy()
    del simulation
    gc.collect()
    others = [sprung.scene("cloth").simulation() for _ in range(5)]
    assert (positions == copies[0]).all() and (stiffness == copies[1]).all() and others


def test_parameters_that_are_kept_stay_as_they_were(jelly: sprung.Simulation) -> None:
    before = jelly.stiffness
    copy = before.copy()
    jelly.stiffness = 123.0
    assert (before == copy).all()
    assert (jelly.stiffness == 123).all()


@pytest.mark.parametrize(
    "given",
    [
        np.arange(30.0).reshape(10, 3),
        np.arange(30, dtype=np.float32).reshape(10, 3),
        np.arange(30, dtype=np.int16).reshape(10, 3),
        np.asfortranarray(np.arange(30.0).reshape(10, 3)),
        np.arange(60.0).reshape(10, 6)[:, ::2],
        np.arange(30.0).reshape(10, 3)[::-1],
        np.arange(30, dtype=">f8").reshape(10, 3),
        np.arange(30.0).reshape(10, 3).tolist(),
    ],
)
def test_any_layout_and_type_of_numbers_is_taken(given: Any) -> None:
    array = np.array(given)
    if isinstance(given, np.ndarray):
        given.flags.writeable = False
    model = sprung.Model(given, 1.0)
    assert (model.simulation().positions == array.astype(np.float32)).all()


POINTS = np.zeros((4, 3))


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        ({"positions": np.zeros((4, 2))}, "positions: has shape (4, 2), and must have shape (n, 3)"),
        ({"positions": np.zeros(3)}, "positions: has shape (3,), and must have shape (n, 3)"),
        ({"positions": [[0, 0, 0], [1, 0]]}, "positions: is no array, and must be real numbers"),
        ({"positions": [["a", "b", "c"]]}, "positions: holds <U1, and must be real numbers"),
        ({"positions": POINTS + 0j}, "positions: holds complex128, and must be real numbers"),
        ({"positions": np.full((4, 3), None)}, "positions: holds object, and must be real numbers"),
        ({"positions": np.full((4, 3), np.nan)}, "points[0].position: is NaN"),
        ({"positions": np.full((4, 3), 1e300)}, "points[0].position: is inf"),
        ({"positions": np.zeros((0, 3))}, "there are no points; a model needs at least one"),
        ({"mass": [1, 2, 3]}, "mass: has shape (3,), and must have shape (4,), or be a single number"),
        ({"mass": -1}, "points[0].mass: is -1, and must be 0 kg (fixed)"),
        ({"mass": np.inf}, "points[0].mass: is inf"),
        ({"springs": [[0, 4]]}, "springs[0]"),
        ({"springs": [[0, -1]]}, "springs: holds -1, and indices count from 0"),
        ({"springs": [[0, 0]]}, "springs[0]"),
        ({"springs": [[0.5, 1]]}, "springs: holds float64, and must be whole numbers"),
        ({"springs": [0, 1]}, "springs: has shape (2,), and must have shape (n, 2)"),
        ({"springs": [[0, 1]], "stiffness": np.nan}, "springs[0].stiffness: is NaN"),
        ({"springs": [[0, 1]], "stiffness": [1, 2]}, "stiffness: has shape (2,), and must have shape (1,)"),
        ({"springs": [[0, 1]], "rest_lengths": -1}, "springs[0].rest_length: is -1"),
        ({"velocities": np.zeros((3, 3))}, "velocities: has shape (3, 3), and must have shape (4, 3)"),
        ({"pinned": [4]}, "pinned: "),
        ({"pinned": [True, False]}, "pinned: has shape (2,), and must have shape (4,)"),
        ({"triangles": [[0, 1, 9]]}, "triangles[0]: has corner 9"),
        ({"bodies": {"a": 1, "b": 2}}, "bodies: have 3 points together, and there are 4"),
    ],
)
def test_what_cannot_be_a_model_is_told_in_a_sentence(arguments: dict[str, Any], sentence: str) -> None:
    with pytest.raises(sprung.Error) as caught:
        sprung.Model(**{"positions": POINTS, "mass": 1.0, **arguments})
    assert str(caught.value).startswith(sentence), str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("name", "value", "sentence"),
    [
        ("dt", -1, "dt: is -1, and must be from 1e-9 to 1e3"),
        ("dt", float("nan"), "dt: is NaN"),
        ("dt", "soon", 'dt: is "soon", and must be a number of seconds or "auto"'),
        ("substeps", 0, "substeps: is 0"),
        ("substeps", -3, "substeps: "),
        ("gravity", [0, 1], "gravity: has shape (2,), and must have shape (3,)"),
        ("gravity", [0, np.inf, 0], "gravity: is inf"),
        ("mass", -1, "point_mass[0]: is -1"),
        ("stiffness", "soft", "stiffness: holds <U4"),
        ("stiffness", [1, 2], "stiffness: has shape (2,), and must have shape (7560,)"),
        ("damping", np.nan, "spring_damping[0]: is NaN"),
        ("pinned", [0, 1], "pinned: holds int64, and must be True and False"),
        ("cut", 1.5, "cut: holds float64"),
        ("external_forces", np.zeros((3, 3)), "external_forces: has shape (3, 3), and must have shape (1000, 3)"),
        ("planes", [sprung.Plane(normal=(0, 0, 0))], "planes[0].normal: is [0, 0, 0]"),
        ("planes", [sprung.Plane(law="pull")], 'planes[0].law: is "pull"'),
        ("planes", [sprung.Plane(y=0, stiffness=-1)], "planes[0].stiffness: is -1"),
    ],
)
def test_a_parameter_that_is_not_allowed_changes_nothing(
    jelly: sprung.Simulation, name: str, value: Any, sentence: str
) -> None:
    before = getattr(jelly, name)
    with pytest.raises(sprung.Error) as caught:
        setattr(jelly, name, value)
    assert str(caught.value).startswith(sentence), str(caught.value)
    assert np.array_equal(getattr(jelly, name), before)


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (lambda it: it.step(-1), "count: is -1, and must be a whole number of at least 0"),
        (lambda it: it.run(-1), "seconds: is -1"),
        (lambda it: it.run(float("nan")), "seconds: is nan"),
        (lambda it: it.run(1, fps=0), "fps: is 0"),
        (lambda it: it.run(1, fps=25, every=2), "fps: says what every says already"),
        (lambda it: it.run(1, every=0), "every: is 0"),
        (lambda it: it.run(1e15), "the recording needs about"),
        (lambda it: it.place(1000, [0, 0, 0]), "place: there is no point 1000; points are 0 to 999"),
        (lambda it: it.carry(-1, [0, 0, 0]), "carry: there is no point -1"),
        (lambda it: it.release(10**6), "release: there is no point 1000000"),
        (lambda it: it.drag(5000, [0, 0, 0]), "drag: there is no point 5000; points are 0 to 999"),
        (lambda it: it.set_state(positions=np.zeros((3, 3))), "positions: has shape (3, 3)"),
        (lambda it: it.set_state(velocities=np.full((1000, 3), np.nan)), "velocity[0]: is NaN"),
        (lambda it: it.picture(0, 10), "size: is 0x10"),
        (lambda it: it.settle(residual_force=-1), "residual_force: is -1"),
        (lambda it: it.save("a.bmp"), "a.bmp: has the ending .bmp"),
        (lambda it: it.save("/nowhere/at/all/a.ply"), "/nowhere/at/all/a.ply: "),
    ],
)
def test_so_is_a_call(jelly: sprung.Simulation, call: Any, sentence: str) -> None:
    before = jelly.state_hash
    with pytest.raises(sprung.Error) as caught:
        call(jelly)
    assert str(caught.value).startswith(sentence), str(caught.value)
    assert jelly.state_hash == before
