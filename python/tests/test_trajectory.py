"""What was recorded, as arrays, tables, plots, pictures and files."""

from __future__ import annotations

import pickle
from pathlib import Path

import numpy as np
import pytest

import sprung


@pytest.fixture(scope="module")
def fall() -> sprung.Trajectory:
    return sprung.scene("jelly").simulation().run(2, fps=25)


def test_frames_are_those_of_single_steps(fall: sprung.Trajectory) -> None:
    jelly = sprung.scene("jelly").simulation()
    assert len(fall) == 51 and fall.frame_time == pytest.approx(0.04)
    for frame in range(len(fall)):
        assert fall.steps[frame] == jelly.steps_taken and fall.times[frame] == jelly.time
        assert (fall.positions[frame] == jelly.positions).all()
        assert (fall.velocities[frame] == jelly.velocities).all()
        assert fall.energy.total[frame] == jelly.energy.total
        jelly.step(4)


def test_it_is_read_only_and_no_copy(fall: sprung.Trajectory) -> None:
    assert np.shares_memory(fall.positions, fall.positions)
    with pytest.raises(ValueError, match="read-only"):
        fall.positions[0] = 0


def test_it_travels(fall: sprung.Trajectory) -> None:
    again = pickle.loads(pickle.dumps(fall))
    for name in ("positions", "velocities", "times", "steps"):
        assert (getattr(again, name) == getattr(fall, name)).all()
    assert (again.energy.total == fall.energy.total).all() and again.title == fall.title


def test_velocities_can_be_left_out() -> None:
    cloth = sprung.scene("cloth").simulation().run(0.2, velocities=False)
    with pytest.raises(AttributeError, match="velocities=True"):
        _ = cloth.velocities
    assert (pickle.loads(pickle.dumps(cloth)).positions == cloth.positions).all()


@pytest.mark.parametrize("ending", [ending for ending, _ in sprung.EXPORTERS if ending not in ("mp4",)])
def test_every_exporter_writes_it(fall: sprung.Trajectory, ending: str, tmp_path: Path) -> None:
    path = fall.save(tmp_path / f"fall.{ending}")
    assert path == tmp_path / f"fall.{ending}"
    left = list(tmp_path.iterdir())
    assert left and not any(file.name.endswith(".partial") for file in left)


def test_the_archive_holds_the_same_numbers(fall: sprung.Trajectory, tmp_path: Path) -> None:
    with np.load(fall.save(tmp_path / "fall.npz")) as archive:
        assert (archive["positions"] == fall.positions).all()
        assert (archive["velocities"] == fall.velocities).all()
        assert (archive["time"] == fall.times).all()


def test_what_an_exporter_refuses_is_told(fall: sprung.Trajectory, tmp_path: Path) -> None:
    with pytest.raises(sprung.Error, match="and the endings that can be written are"):
        fall.save(tmp_path / "fall.bmp")
    with pytest.raises(sprung.Error, match='up: is "x", and must be "y" or "z"'):
        fall.save(tmp_path / "fall.usdc", up="x")
    with pytest.raises(sprung.Error, match="body|bodies"):
        fall.save(tmp_path / "fall.usdc", bodies=["nobody"])
    with pytest.raises(sprung.Error, match="size"):
        fall.save(tmp_path / "fall.gif", size=(1, 1))
    assert list(tmp_path.iterdir()) == []


def test_a_bar_that_is_broken_off_leaves_no_file(fall: sprung.Trajectory, tmp_path: Path) -> None:
    def told(_: float) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        fall._frames.write(
            tmp_path / "a.gif",
            size=None,
            at=None,
            up="y",
            scale=1,
            springs=None,
            bodies=None,
            points=False,
            told=told,
        )
    assert list(tmp_path.iterdir()) == []


def test_pictures(jelly: sprung.Simulation, fall: sprung.Trajectory, tmp_path: Path) -> None:
    assert jelly._repr_png_().startswith(b"\x89PNG")
    animation = fall.animate(size=(160, 90))
    assert animation.content.startswith(b"GIF89a")
    assert animation._repr_html_().startswith('<img src="data:image/gif;base64,')
    assert animation.save(tmp_path / "a.gif").read_bytes() == animation.content
    with pytest.raises(sprung.Error, match='"gif" or "mp4"'):
        fall.animate(format="avi")


def test_plots(fall: sprung.Trajectory) -> None:
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    axes = fall.plot_energy()
    lines = {str(line.get_label()): line for line in axes.get_lines()}
    assert {"kinetic", "elastic", "total"} <= set(lines)
    assert np.array_equal(np.asarray(lines["total"].get_ydata()), fall.energy.total)
    assert axes.get_ylabel() == "energy (J)"
    axes = fall.plot([0, 999], "vy")
    assert np.array_equal(np.asarray(axes.get_lines()[1].get_ydata()), fall.velocities[:, 999, 1])
    with pytest.raises(sprung.Error, match="speed"):
        fall.plot(0, "w")


def test_tables(fall: sprung.Trajectory) -> None:
    pytest.importorskip("pandas")
    pytest.importorskip("xarray")
    table = fall.to_pandas()
    assert len(table) == 51 * 1000
    row = table[(table["point"] == 7) & (table["time"] == fall.times[3])].iloc[0]
    assert row["vy"] == fall.velocities[3, 7, 1]
    data = fall.to_xarray()
    assert (data["position"].sel(axis="y").isel(point=5).values == fall.positions[:, 5, 1]).all()
    assert data["kinetic"].attrs["units"] == "J"


def test_something_is_done_before_each_frame() -> None:
    flag = sprung.scene("flag").simulation()
    seen: list[float] = []
    trajectory = flag.run(0.2, before_frame=lambda it: seen.append(it.time))
    assert seen == trajectory.times[:-1].tolist()
