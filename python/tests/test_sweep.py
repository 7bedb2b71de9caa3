"""Sweeps: the right rows, the same bits wherever they run, and nothing lost whoever is killed."""

from __future__ import annotations

import json
import os
import random
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import sprung

pandas = pytest.importorskip("pandas")
distributed = pytest.importorskip("distributed")
zarr = pytest.importorskip("zarr")
pytest.importorskip("pyarrow")

Frames = Iterator[sprung.Simulation]
HERE = Path(__file__).parent
ROOT = HERE.parents[1]
#: Twelve runs, of which those with the longer step blow up.
GRID: dict[str, Any] = {
    "over": {"dt": [0.01, 0.02], "stiffness": [500, 750]},
    "seeds": 3,
    "noise": 0.1,
    "seconds": 2,
}


@pytest.fixture
def paths(monkeypatch: pytest.MonkeyPatch) -> None:
    """Other processes find this package and this file."""
    package = Path(sprung.__file__).parents[1]
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([str(package), str(HERE)]))


def same(one: Any, other: Any) -> None:
    """Tables are the same in all that is not about the clock."""
    pandas.testing.assert_frame_equal(one.drop(columns="wall_seconds"), other.drop(columns="wall_seconds"))


def journal(out: Path) -> list[dict[str, Any]]:
    """The whole lines of a journal."""
    content = (out / "journal.jsonl").read_bytes() if (out / "journal.jsonl").exists() else b""
    return [json.loads(line) for line in content.split(b"\n")[:-1]]


def height(frames: Frames) -> dict[str, float]:
    """What a function of one's own looks like."""
    *_, last = frames
    return {"height": float(last.positions[0, 1])}


def fragile(frames: Frames) -> dict[str, float]:
    """Fails where the stiffness is 500."""
    simulation = next(frames)
    if simulation.stiffness[0] == 500:
        raise ZeroDivisionError("nothing to divide by")
    return {"begun": simulation.time}


def wind(simulation: sprung.Simulation, rng: np.random.Generator) -> None:
    """A constant wind of some strength."""
    simulation.external_forces = np.full((simulation.point_count, 3), [rng.random(), 0, 0])


def kills_its_worker(simulation: sprung.Simulation, rng: np.random.Generator) -> None:
    """One of the seeds is the end of whoever runs it."""
    if rng.random() == np.random.Generator(np.random.PCG64(3)).random():
        os.kill(os.getpid(), signal.SIGKILL)


# Rows


def test_every_combination_and_seed_is_a_row() -> None:
    table = sprung.sweep("jelly", GRID["over"], seeds=[5, 7], seconds=0.5)
    assert list(table["run"]) == list(range(8))
    rows = list(zip(table["dt"], table["stiffness"], table["seed"], strict=True))
    assert rows == [
        (dt, stiffness, seed) for dt in (0.01, 0.02) for stiffness in (500, 750) for seed in (5, 7)
    ]
    assert (table["version"] == sprung.__version__).all()
    assert list(table.columns[:4]) == ["run", "dt", "stiffness", "seed"]


def test_samples_are_rows_and_go_with_every_value() -> None:
    samples: list[dict[str, Any]] = [{"dt": 0.01, "stiffness": 500}, {"dt": 0.005, "gravity": [0, -1.62, 0]}]
    table = sprung.sweep("jelly", {"damping": [5, 10]}, samples=samples, seconds=0.1)
    assert table["dt"].tolist() == [0.01, 0.01, 0.005, 0.005]
    assert table["damping"].tolist() == [5, 10, 5, 10]
    assert table["stiffness"].fillna(-1).tolist() == [500, 500, -1, -1]
    assert table["gravity"].fillna("").tolist() == ["", "", "[0, -1.62, 0]", "[0, -1.62, 0]"]


def test_a_row_is_the_run_that_one_would_do_by_hand() -> None:
    table = sprung.sweep("jelly", {"stiffness": [500]}, seeds=[4], noise=0.1, seconds=2, measure=height)
    jelly = sprung.scene("jelly", {"stiffness": 500}).simulation()
    random_numbers = np.random.Generator(np.random.PCG64(4)).random((1000, 3))
    jelly.set_state(velocities=jelly.velocities + (2 * random_numbers - 1) * 0.1)
    by_hand = jelly.run(2)
    row = table.iloc[0]
    assert row["state_hash"] == jelly.state_hash
    assert row["simulated_seconds"] == jelly.time
    assert row["height"] == by_hand.positions[-1, 0, 1]


def test_noise_leaves_alone_what_is_held() -> None:
    def moved(frames: Frames) -> dict[str, float]:
        cloth = next(frames)
        return {
            "pinned": float(np.abs(cloth.velocities[cloth.pinned]).max()),
            "largest": float(np.abs(cloth.velocities).max()),
            "still": float((cloth.velocities == 0).all(axis=1).sum()) - float(cloth.pinned.sum()),
        }

    row = sprung.sweep("cloth", seconds=0, noise=0.3, measure=moved).iloc[0]
    assert (row["pinned"], row["still"]) == (0, 0)
    assert 0.25 < row["largest"] <= np.float32(0.3)


def test_without_noise_seeds_make_no_difference_and_prepare_makes_one() -> None:
    assert sprung.sweep("jelly", seeds=3, seconds=0.5)["state_hash"].nunique() == 1
    assert sprung.sweep("jelly", seeds=3, seconds=0.5, prepare=wind)["state_hash"].nunique() == 3


def test_a_model_has_seeds() -> None:
    rope = sprung.chain(10, step=[1, 0, 0])
    model = sprung.Model(rope.positions, 1, rope.springs(), stiffness=500, damping=1, pinned=[0])
    assert sprung.sweep(model, seeds=3, noise=0.1, seconds=0.5)["state_hash"].nunique() == 3
    with pytest.raises(sprung.Error, match="over: a model has no keys to vary"):
        sprung.sweep(model, {"dt": [0.01]}, seconds=1)


def test_a_blow_up_is_a_row_that_says_why() -> None:
    table = sprung.sweep("jelly", {"dt": [0.02, 0.01]}, seconds=2, measure="lowest")
    with pytest.raises(sprung.BlowUp) as caught:
        sprung.scene("jelly", {"dt": 0.02}).simulation().run(2)
    why, row = caught.value, table.iloc[0]
    assert table["status"].tolist() == ["blew up", "ok"]
    assert (row["blow_up_step"], row["blow_up_time"], row["blow_up_spring"]) == (
        why.step,
        why.time,
        why.spring,
    )
    assert (row["dt_limit"], row["suggested_dt"], row["message"]) == (
        why.certified_limit,
        why.suggested_dt,
        str(why),
    )
    assert table["blow_up_step"].isna().tolist() == [False, True]
    mended = sprung.sweep("jelly", {"dt": [row["suggested_dt"]]}, seconds=2)
    assert mended["status"].tolist() == ["ok"]


def test_a_measure_that_raises_is_a_row() -> None:
    table = sprung.sweep("jelly", {"stiffness": [500, 750]}, seconds=1, measure=fragile)
    assert table["status"].tolist() == ["failed", "ok"]
    assert table["message"][0].startswith("ZeroDivisionError: nothing to divide by (test_sweep.py, line ")
    assert table["begun"].fillna(-1).tolist() == [-1, 0]


@pytest.mark.parametrize(
    ("measured", "sentence"),
    [
        (3, "TypeError: measure gave int, and must give a dictionary of numbers"),
        ({"a": "b"}, "TypeError: measure gave 'a': str, and must give numbers by name"),
        ({"seed": 1}, 'ValueError: measure gave "seed", which is a column of its own'),
        ({"dt": 1}, 'ValueError: measure gave "dt", which is a column of its own'),
    ],
)
def test_a_measure_gives_numbers(measured: Any, sentence: str) -> None:
    table = sprung.sweep("spring", {"dt": [0.01]}, seconds=0, measure=lambda frames: measured)
    assert table["status"].tolist() == ["failed"]
    assert table["message"][0].startswith(sentence)


def test_a_run_ends_with_its_measure() -> None:
    def landing(frames: Frames) -> dict[str, float]:
        jelly = next(jelly for jelly in frames if jelly.positions[:, 1].min() < -10)
        return {"landed": jelly.time}

    row = sprung.sweep("jelly", seconds=1000, measure=landing).iloc[0]
    assert row["status"] == "ok"
    assert row["landed"] == row["simulated_seconds"] < 2


def test_built_in_measures_are_what_a_trajectory_says() -> None:
    names = [measure.name for measure in sprung.MEASURES]
    row = sprung.sweep("jelly", seconds=3, measure=names).iloc[0]
    jelly = sprung.scene("jelly").simulation()
    fall = jelly.run(3)
    a, b = jelly.springs.T
    lengths = np.linalg.norm(fall.positions[:, a] - fall.positions[:, b], axis=2)
    told = {
        "kinetic_energy": fall.energy.kinetic[-1],
        "total_energy": fall.energy.total[-1],
        "mean_height": fall.positions[-1, :, 1].mean(),
        "lowest": fall.positions[:, :, 1].min(),
        "highest": fall.positions[:, :, 1].max(),
        "top_speed": np.linalg.norm(fall.velocities, axis=2).max(),
        "largest_extension": (lengths - jelly.rest_lengths).max(),
    }
    assert list(told) == names, "every one is tried"
    for name, value in told.items():
        assert row[name] == pytest.approx(value, rel=1e-5), name


def test_the_documentation_has_every_built_in_measure() -> None:
    text = (ROOT / "docs/scale.md").read_text()
    for name, unit, meaning, *_ in sprung.MEASURES:
        assert f"| `{name}` | {unit} | {meaning} |" in text


# The same wherever it runs


def test_any_number_of_workers_gives_the_same_table() -> None:
    one, four = (
        sprung.sweep("jelly", **GRID, measure=["lowest", "kinetic_energy"], workers=n) for n in (1, 4)
    )
    same(one, four)
    assert one["state_hash"].nunique() > 6


def test_a_cluster_gives_the_same_table_though_a_worker_is_killed(tmp_path: Path, paths: None) -> None:
    asked: dict[str, Any] = {"over": {"stiffness": [500, 750]}, "seeds": 60, "noise": 0.1, "seconds": 10}
    alone = sprung.sweep("jelly", **asked, measure=height)
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address="127.0.0.1:0"
    ) as cluster:
        killed = []

        def kill() -> None:
            while len(journal(tmp_path)) < 10:
                time.sleep(0.01)
            killed.append(cluster.workers[0].pid)
            os.kill(killed[0], signal.SIGKILL)

        killer = threading.Thread(target=kill)
        killer.start()
        table = sprung.sweep(
            "jelly", **asked, measure=height, out=tmp_path, scheduler=cluster.scheduler_address
        )
        killer.join()
    assert killed
    assert sorted(row["run"] for row in journal(tmp_path)) == list(range(120)), "every run once"
    same(table, alone)


def test_a_run_that_kills_its_workers_is_found_out(paths: None) -> None:
    import dask

    with (
        dask.config.set({"distributed.scheduler.allowed-failures": 0}),
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address="127.0.0.1:0"
        ) as cluster,
        distributed.Client(cluster, set_as_default=False) as client,
    ):
        table = sprung.sweep("chain", seeds=20, seconds=1, prepare=kills_its_worker, scheduler=client)
    assert table["status"].tolist() == ["failed" if seed == 3 else "ok" for seed in range(20)]
    assert "died at this run" in table["message"][3]


# Going on


def test_a_finished_sweep_is_there_again_and_another_is_refused(tmp_path: Path) -> None:
    first = sprung.sweep("jelly", **GRID, out=tmp_path)
    written = (tmp_path / "journal.jsonl").read_bytes()
    same(sprung.sweep("jelly", **GRID, out=tmp_path, workers=1), first)
    assert (tmp_path / "journal.jsonl").read_bytes() == written
    same(pandas.read_parquet(tmp_path / "table.parquet"), first)
    others: dict[str, tuple[str, dict[str, Any]]] = {
        "scene": ("cloth", GRID),
        "noise": ("jelly", {**GRID, "noise": 0.2}),
        "seeds": ("jelly", {**GRID, "seeds": 4}),
        "measure": ("jelly", {**GRID, "measure": height}),
        "prepare": ("jelly", {**GRID, "prepare": wind}),
    }
    for what, (scene, asked) in others.items():
        with pytest.raises(
            sprung.Error, match=rf"holds another sweep, with another {what}.*; choose another folder"
        ):
            sprung.sweep(scene, **asked, out=tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "journal.jsonl",
        "sweep.json",
        "table.parquet",
    ]


@pytest.mark.parametrize("torn", [b'{"run": 3, "sta', b"\x00\x00\x00", b'{"run": 3}', b'{"run": 3, "sta\n'])
def test_a_torn_line_is_run_again(tmp_path: Path, torn: bytes) -> None:
    whole = sprung.sweep("jelly", **GRID, out=tmp_path)
    lines = (tmp_path / "journal.jsonl").read_bytes().splitlines(keepends=True)
    kept = [line for line in lines if json.loads(line)["run"] < 3]
    (tmp_path / "journal.jsonl").write_bytes(b"".join(kept) + torn)
    same(sprung.sweep("jelly", **GRID, out=tmp_path), whole)
    after = (tmp_path / "journal.jsonl").read_bytes()
    assert after.startswith(b"".join(kept)), "what was done stays as it was"
    assert after.count(b"\n") == 12 + torn.count(b"\n")


def command(*arguments: str, cwd: Path) -> subprocess.Popen[str]:
    """The command, in a process that heeds Ctrl-C even if this one does not."""
    return subprocess.Popen(
        [sys.executable, "-m", "sprung", "sweep", *arguments],
        cwd=cwd,
        text=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler) and None,
    )


@pytest.fixture
def long_sweep(tmp_path: Path, paths: None) -> Path:
    """A folder with a sweep.toml that takes some seconds, with a function of its own."""
    (tmp_path / "own.py").write_text(
        "from test_sweep import height\n\ndef mine(frames):\n    return height(frames)\n"
    )
    (tmp_path / "sweep.toml").write_text(
        'scene = "jelly"\nseconds = 10\nseeds = 60\nnoise = 0.1\nmeasure = "own:mine"\nfps = 1\n'
        'keep = "trajectories"\n[over]\nbody.jelly.stiffness = [500, 750]\n'
    )
    return tmp_path


def test_killed_at_any_moment_it_goes_on(long_sweep: Path) -> None:
    out, moments, interrupted = long_sweep / "out", random.Random(1), 0
    for _ in range(5):
        running, before = command("sweep.toml", "-o", "out", cwd=long_sweep), len(journal(out))
        while len(journal(out)) == before and running.poll() is None:
            time.sleep(0.01)
        time.sleep(moments.uniform(0, 0.4))
        running.kill()
        running.communicate()
        interrupted += len(journal(out)) < 120
    assert interrupted >= 2
    last = command("sweep.toml", "-o", "out", cwd=long_sweep)
    said, complained = last.communicate()
    assert (last.returncode, complained) == (0, "")
    assert said == f"120 runs: 120 ok, 0 blew up, 0 failed; {Path('out/table.parquet')}\n"
    over = {"body.jelly.stiffness": [500, 750]}
    alone = sprung.sweep("jelly", over, seconds=10, seeds=60, noise=0.1, measure=height, fps=1)
    same(pandas.read_parquet(out / "table.parquet"), alone)
    assert sorted(row["run"] for row in journal(out)) == list(range(120)), "every run once"
    kept = zarr.open_group(str(out / "trajectories.zarr"), mode="r")
    assert sorted(map(int, kept.group_keys())) == list(range(120))
    for run in (0, 59, 119):
        group = kept[str(run)]
        assert group.attrs["state_hash"] == alone["state_hash"][run]
        assert group["positions"].shape == group["velocities"].shape == (11, 1000, 3)
        assert float(group["positions"][-1, 0, 1]) == alone["height"][run]
    assert sorted(path.name for path in out.iterdir()) == [
        "journal.jsonl", "sweep.json", "table.parquet", "trajectories.zarr",
    ]  # fmt: skip


def test_ctrl_c_leaves_it_ready_to_go_on(long_sweep: Path) -> None:
    running = command("sweep.toml", "-o", "out", cwd=long_sweep)
    while not journal(long_sweep / "out"):
        time.sleep(0.01)
    with pytest.raises(sprung.Error, match="a sweep is running in .* already"):
        sprung.sweep("jelly", seconds=1, out=long_sweep / "out")
    running.send_signal(signal.SIGINT)
    _, complained = running.communicate()
    assert running.returncode == 130
    assert complained.endswith("sprung: interrupted; the same command goes on with what is in out\n")
    assert "Traceback" not in complained
    assert 0 < len(journal(long_sweep / "out")) < 120
    assert command("sweep.toml", "-o", "out", "--quiet", cwd=long_sweep).communicate() == ("", "")
    assert sorted(row["run"] for row in journal(long_sweep / "out")) == list(range(120))


# What is wrong is said in a sentence


@pytest.mark.parametrize(
    ("asked", "sentence"),
    [
        ({"seconds": -1}, "seconds: is -1, and must be a finite number of at least 0"),
        ({"seconds": "long"}, "seconds: is 'long', and must be a number"),
        ({"fps": 0}, "fps: is 0, and must be a finite number above 0"),
        ({"noise": -0.1}, "noise: is -0.1, and must be a finite number of at least 0"),
        ({"seeds": 0}, "seeds: is 0, and must be at least 1, or a list"),
        ({"seeds": [1, 1]}, "seeds: must be whole numbers from 0 to 2^64 - 1, each once"),
        ({"over": {"dt": 0.01}}, "over.dt: is 0.01, and must be a list of values"),
        ({"over": {"dt": []}}, "over.dt: is empty, and must have at least one of values"),
        ({"keep": "trajectories"}, "keep: trajectories need a folder; name one with out"),
        ({"scheduler": "nowhere"}, 'scheduler: is "nowhere", and must be as "tcp://host:8786"'),
        (
            {"scheduler": "tcp://h:1", "workers": 2},
            "workers: are the cluster's, where there is a scheduler; leave",
        ),
        ({"workers": 0}, "workers: is 0, and must be at least 1"),
        (
            {"samples": [{"dt": "0.01.1"}]},
            "samples: is not valid TOML: invalid float; write the value as in a scene",
        ),
        ({"samples": [{}, {"stifness": 1}]}, "samples.stifness: is not a known key; "),
        ({"over": {"dt": [0.01, "0.01.1"]}}, "over.dt: is not valid TOML: invalid float; "),
    ],
)
def test_arguments_are_checked_before_anything_runs(
    asked: dict[str, Any], sentence: str, tmp_path: Path
) -> None:
    with pytest.raises(sprung.Error) as caught:
        sprung.sweep("jelly", **{"seconds": 1, **asked})
    assert str(caught.value).startswith(sentence)


#: A file that is right, and what could be written below it.
RIGHT = "scene = 'jelly'\nseconds = 2\n"
NO_MEASURE = (
    '"lowes" is no built-in measure; there are kinetic_energy, total_energy, mean_height, lowest, highest, '
)
NO_KEY = "is not a known key; allowed here are title, description, dt, substeps, gravity, "


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        ("scene = 'jelly'", "sweep.toml: seconds: is missing\n"),
        ("seconds = 2", "sweep.toml: scene: is missing\n"),
        (
            "scene = 3\nseconds = 2",
            "sweep.toml: scene: is 3, and must be a scene, its name or file, or a model\n",
        ),
        ("scene = 'jely'\nseconds = 2", 'there is no built-in scene "jely"; '),
        ("scene = 'absent.toml'\nseconds = 2", "absent.toml: there is no such file\n"),
        ("scene = 'jelly'\nseconds = true", "sweep.toml: seconds: is True, and must be a number\n"),
        (
            RIGHT + "sedes = 2",
            "sweep.toml: sedes: is not a known key; allowed here are scene, seconds, over, ",
        ),
        (RIGHT + "[over]\nstifness = [1]", "sweep.toml: over.stifness: " + NO_KEY),
        (
            RIGHT + "[over]\nplane.damping = [1, -1]",
            "sweep.toml: over.plane.damping: is -1 N·s/m, and must be from 0",
        ),
        (
            RIGHT + "[over]\nplane.damping = 1",
            "sweep.toml: over.plane.damping: is 1, and must be a list of values\n",
        ),
        (RIGHT + "measure = 'lowes'", "sweep.toml: measure: " + NO_MEASURE),
        (
            RIGHT + "measure = 3",
            "sweep.toml: measure: is 3, and must be a function, a name, or a list of names of ",
        ),
        (RIGHT + "measure = 'no:f'", "sweep.toml: measure: there is no \"no:f\": No module named 'no'\n"),
        (RIGHT + "prepare = 'wind'", "sweep.toml: prepare: is 'wind', and must be \"module:function\"\n"),
        (RIGHT + "keep = 'all'", "sweep.toml: keep: is 'all', and must be \"trajectories\" or nothing\n"),
        (RIGHT + "seeds = []", "sweep.toml: seeds: is empty, and must have at least one of whole numbers\n"),
        (RIGHT + "noise = '", "sweep.toml: "),
    ],
)
def test_a_file_that_is_wrong(
    content: str,
    sentence: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    from sprung.sweep.command import main

    monkeypatch.chdir(tmp_path)
    Path("sweep.toml").write_text(content)
    assert main(["sweep.toml", "-o", "out"]) == 2
    said = capsys.readouterr().err
    assert said.startswith(f"sprung: {sentence}")
    assert said.count("\n") == 1
    assert "sedes" not in content or said.endswith('; did you mean "seeds"?\n')
    assert not Path("out").exists()


def test_the_help_has_every_built_in_measure(capsys: pytest.CaptureFixture[str]) -> None:
    from sprung.sweep.command import main

    with pytest.raises(SystemExit) as ended:
        main(["--help"])
    assert ended.value.code == 0
    said = capsys.readouterr().out
    assert all(measure.name in said and measure.meaning in said for measure in sprung.MEASURES)


def test_what_is_not_installed_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None if name == "pyarrow" else name)
    with pytest.raises(sprung.Error) as caught:
        sprung.sweep("jelly", seconds=1)
    sentence = (
        'a sweep needs pyarrow, which is not installed; pip install ".[sweep]" in the folder of sprung brings what is needed'
    )
    assert str(caught.value) == sentence
