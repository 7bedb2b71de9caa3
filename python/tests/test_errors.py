"""Errors are exceptions with the sentences of the command."""

from __future__ import annotations

import pickle
from typing import Any

import pytest

import sprung


def test_the_sentences_are_those_of_the_command(sentences: list[dict[str, Any]]) -> None:
    for case in sentences:
        with pytest.raises(sprung.Error) as caught:
            if "builtin" in case:
                sprung.scene(case["builtin"], case.get("set")).simulation()
            else:
                sprung.Scene.from_toml(case["scene"], case.get("set"), name="bad.toml").simulation()
        assert str(caught.value) == case["sentence"], case["about"]
        error = caught.value
        assert error.sentence in str(error)
        assert error.fix is None or str(error).endswith(error.fix)
        assert isinstance(error, ValueError)
    assert len(sentences) > 10


def test_a_place_has_its_parts() -> None:
    with pytest.raises(sprung.Error) as caught:
        sprung.Scene.from_toml("dt = -1\n[[body]]\nname = 'a'\npoints = [[0, 0, 0]]\n", name="mine.toml")
    error = caught.value
    assert (error.code, error.file, error.line, error.column, error.field) == ("out_of_range", "mine.toml", 1, 6, "dt")


def test_a_blow_up_says_why_and_what_mends_it() -> None:
    jelly = sprung.scene("jelly", {"dt": 0.013}).simulation()
    with pytest.raises(sprung.BlowUp) as caught:
        jelly.run(5)
    blow_up = caught.value
    assert blow_up.code == "blew_up"
    assert blow_up.cause in ("not_finite", "energy_from_nowhere")
    assert blow_up.certified_limit is not None and blow_up.certified_limit < blow_up.dt == 0.013
    assert blow_up.good_step < blow_up.step and blow_up.time == pytest.approx(blow_up.step * blow_up.dt)
    assert jelly.steps_taken == blow_up.good_step, "it is back at the last good state"
    assert blow_up.spring is not None and jelly.springs[blow_up.spring].tolist() == blow_up.points
    trajectory = blow_up.trajectory
    assert trajectory is not None and trajectory.times[-1] <= blow_up.time
    assert trajectory.energy.total.max() < 1.001 * trajectory.energy.total[0], "no frame of the explosion is kept"
    assert blow_up.suggested_dt is not None
    jelly.dt = blow_up.suggested_dt
    jelly.run(3)


def test_errors_travel(jelly: sprung.Simulation) -> None:
    jelly.dt = 0.02
    with pytest.raises(sprung.BlowUp) as caught:
        jelly.step(1000)
    again = pickle.loads(pickle.dumps(caught.value))
    assert type(again) is sprung.BlowUp
    assert (str(again), vars(again)) == (str(caught.value), vars(caught.value))


def test_a_scene_that_never_rests_says_so() -> None:
    swinging = sprung.Scene.from_toml("""
[[body]]
name = "a"
points = [[0, 0, 0], [1, 0, 0]]
pins = [0]
[[body.springs]]
pairs = [[0, 1]]
stiffness = 10
""").simulation()
    with pytest.raises(sprung.Error) as caught:
        swinging.settle(residual_force=0, max_steps=10)
    assert caught.value.code == "not_settled"
