"""What a sweep is: which runs there are, and how each of them is done."""

from __future__ import annotations

import functools
import hashlib
import inspect
import json
import math
import os
import pickle
import shutil
import time
import uuid
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from .. import _engine
from ..errors import BlowUp, Error, refusal
from ..model import Model
from ..scene import Scene, Value, _plain
from ..simulation import Simulation
from .measures import Builtin, Measure

Prepare = Callable[[Simulation, np.random.Generator], object]
Row = dict[str, Any]

#: What a row has besides the parameters and what was measured, in the order of the table: before them, and
#: after them.
BEFORE = ("run",)
AFTER = (
    "status", "message", "state_hash", "simulated_seconds", "wall_seconds", "version",
    "blow_up_step", "blow_up_time", "blow_up_spring", "dt_limit", "suggested_dt",
)  # fmt: skip
OWN = {*BEFORE, "seed", *AFTER}


@dataclass(frozen=True)
class Trial:
    """One run of a sweep: its number, and what is its own."""

    run: int
    parameters: dict[str, Value]
    seed: int


@dataclass(frozen=True)
class Grid:
    """All runs of a sweep: every sample, with every combination of values, with every seed."""

    samples: list[dict[str, Value]]
    over: dict[str, list[Value]]
    seeds: Sequence[int]

    def __len__(self) -> int:
        return len(self.samples) * math.prod(map(len, self.over.values())) * len(self.seeds)

    def __getitem__(self, run: int) -> Trial:
        # Counted like an odometer: seeds fastest, samples slowest. No list of all runs is ever made.
        rest, seed = divmod(run, len(self.seeds))
        chosen: dict[str, Value] = {}
        for key, values in reversed(self.over.items()):
            rest, index = divmod(rest, len(values))
            chosen[key] = values[index]
        return Trial(run, {**self.samples[rest], **{key: chosen[key] for key in self.over}}, self.seeds[seed])

    @property
    def keys(self) -> list[str]:
        """All parameters, in the order of their columns."""
        return list(dict.fromkeys([*(key for sample in self.samples for key in sample), *self.over]))

    def check(self, source: Scene | Model) -> None:
        """Refuses keys and values that the scene does not take, before anything runs."""
        if isinstance(source, Model):
            if self.keys:
                raise refusal(
                    "over",
                    "a model has no keys to vary; a scene has, and prepare changes a model's simulation",
                )
            return
        first = {key: values[0] for key, values in self.over.items()}
        tried = [
            (key, {**self.samples[0], **first, key: value}) for key in self.over for value in self.over[key]
        ]
        tried += [("", {**sample, **first}) for sample in self.samples]
        for key, changes in tried:
            try:
                source.changed(changes)
            except Error as error:
                field = error.field if not key or error.field in changes else key
                place = f"over.{field}" if field in self.over else f"samples.{field}" if field else "samples"
                raise refusal(place, error.sentence, code=error.code, fix=error.fix) from None


@dataclass(frozen=True)
class Experiment:
    """How each run is done. It travels to the workers."""

    source: Scene | Model
    seconds: float
    fps: float | None
    noise: float
    prepare: Prepare | None
    measure: Measure
    #: The folder for trajectories, if they are kept.
    trajectories: Path | None

    def lines(self, trials: list[Trial], stopped: Callable[[], bool]) -> str:
        """Does these runs and gives a line of the journal for each. Made here, it leaves the client next to
        nothing to do."""
        return "".join(json.dumps(self.row(trial, stopped)) + "\n" for trial in trials)

    def row(self, trial: Trial, stopped: Callable[[], bool]) -> Row:
        """Does a run. Whatever goes wrong in it is a row, too; only when it is ``stopped`` there is none."""
        begin = time.perf_counter()
        run = _Run(self, stopped)
        row: Row = {"run": trial.run, "parameters": trial.parameters, "seed": trial.seed, "status": "ok"}
        try:
            run.begin(trial)
            row["measured"] = _numbers(self.measure(run.frames()), {*OWN, *trial.parameters})
        except BlowUp as blow_up:
            run.blow_up = blow_up
        except Exception as error:
            row.update(status="failed", message=_told(error))
        if run.blow_up is not None:
            row.update(status="blew up", **_explained(run.blow_up))
        if run.simulation is not None:
            row["state_hash"] = run.simulation.state_hash
            row["simulated_seconds"] = run.simulation.time
            run.keep(trial, row)
        return {**row, "wall_seconds": time.perf_counter() - begin, "version": _engine.__version__}

    def lost(self, trial: Trial, workers: int) -> str:
        """The line of a run that ended every worker that began it."""
        message = (
            f"{workers} workers died at this run, one after another; it may need more memory than they have"
        )
        row = {
            "run": trial.run,
            "parameters": trial.parameters,
            "seed": trial.seed,
            "status": "failed",
            "message": message,
        }
        return json.dumps({**row, "version": _engine.__version__}) + "\n"


class Stopped(BaseException):
    """The sweep was interrupted. No measure takes this for an error of its own."""


class _Run:
    """A run under way."""

    def __init__(self, experiment: Experiment, stopped: Callable[[], bool]) -> None:
        self.experiment = experiment
        self.stopped = stopped
        self.simulation: Simulation | None = None
        self.blow_up: BlowUp | None = None
        self.recorder: _engine.Recorder | None = None

    def begin(self, trial: Trial) -> None:
        """Makes the simulation as it is at the start."""
        source, noise, prepare = self.experiment.source, self.experiment.noise, self.experiment.prepare
        if isinstance(source, Scene) and trial.parameters:
            source = source.changed(trial.parameters)
        # A sweep has a run for each processor, so a run has one thread.
        self.simulation = simulation = source.simulation(threads=1)
        # A generator whose bits NumPy promises to keep, where `default_rng` may become another one.
        rng = np.random.Generator(np.random.PCG64(trial.seed))
        if noise > 0:
            # Exact but for one rounding, and so the same on every machine: a normal distribution takes
            # logarithms.
            kick = (2 * rng.random((simulation.point_count, 3)) - 1) * noise
            free = ~simulation.pinned & (simulation.mass > 0)
            simulation.set_state(velocities=simulation.velocities + kick * free[:, None])
        if prepare is not None:
            prepare(simulation, rng)

    def frames(self) -> Iterator[Simulation]:
        """The simulation at its start and at each frame. A measure that takes no more ends the run."""
        simulation, asked = self.simulation, self.experiment
        assert simulation is not None
        every = simulation.substeps if asked.fps is None else max(1, round(1 / (asked.fps * simulation.dt)))
        # As in `Simulation.run`.
        frame_time = every * simulation.dt
        count = int(asked.seconds / frame_time * (1 + 1e-12) + 1e-9)
        if asked.trajectories is not None:
            self.recorder = _engine.Recorder(simulation, frame_time, count + 1, True)
        for frame in range(count + 1):
            if self.stopped():
                raise Stopped
            if frame:
                try:
                    simulation.step(every)
                except BlowUp as blow_up:
                    self.blow_up = blow_up
                    raise
            if self.recorder is not None:
                self.recorder.take(simulation)
            yield simulation

    def keep(self, trial: Trial, row: Row) -> None:
        """Writes the trajectory as a Zarr group, beside, and gives it its name when it is whole."""
        folder = self.experiment.trajectories
        if self.recorder is None or folder is None:
            return
        if not (folder.parent / "sweep.json").exists():
            raise refusal(
                "out", f"a worker does not see the folder {folder.parent}, where it is to write trajectories"
            )
        import zarr

        frames = self.recorder.finish(self.blow_up is not None)
        # Two workers may be at the same run, if one was given up for dead.
        partial = folder.parent / "partial" / f"{trial.run}-{uuid.uuid4().hex}"
        group = zarr.open_group(str(partial), mode="w")
        for name in ("times", "steps", "positions", "velocities"):
            group[name] = getattr(frames, name)
        kept = ("run", "parameters", "seed", "status", "state_hash")
        group.attrs.update({"title": frames.title, **{key: row[key] for key in kept}})
        try:
            os.rename(partial, folder / str(trial.run))
        except OSError:
            if not (folder / str(trial.run)).is_dir():
                raise
            # It is there already, with the same bits.
            shutil.rmtree(partial)


def _numbers(measured: Any, taken: set[str]) -> dict[str, float]:
    """What a measure gave, if it is numbers by name."""
    if not isinstance(measured, Mapping):
        raise TypeError(f"measure gave {type(measured).__name__}, and must give a dictionary of numbers")
    for name, value in measured.items():
        if not isinstance(name, str) or not np.isscalar(value) or isinstance(value, (str, bytes, complex)):
            raise TypeError(f"measure gave {name!r}: {type(value).__name__}, and must give numbers by name")
        if name in taken:
            raise ValueError(f'measure gave "{name}", which is a column of its own')
    return {name: float(value) for name, value in measured.items()}


def _explained(blow_up: BlowUp) -> Row:
    return {
        "message": str(blow_up),
        "blow_up_step": blow_up.step,
        "blow_up_time": blow_up.time,
        "blow_up_spring": blow_up.spring,
        "dt_limit": blow_up.certified_limit,
        "suggested_dt": blow_up.suggested_dt,
    }


def _told(error: Exception) -> str:
    """An error in a line, with the place in the code of whoever wrote the measure."""
    if isinstance(error, Error):
        return str(error)
    place, trace = "", error.__traceback__
    while trace is not None:
        code = trace.tb_frame.f_code
        if not code.co_filename.startswith(str(Path(__file__).parent)):
            place = f" ({Path(code.co_filename).name}, line {trace.tb_lineno})"
        trace = trace.tb_next
    return f"{type(error).__name__}: {error}{place}"


def description(experiment: Experiment, grid: Grid, seeds: int | list[int]) -> dict[str, Any]:
    """What makes a sweep this one and no other, as ``sweep.json`` says it."""
    source = experiment.source
    packed = source._pack() if isinstance(source, Scene) else pickle.dumps(source, protocol=5)
    measure = experiment.measure
    return {
        "version": _engine.__version__,
        "scene": source.to_toml() if isinstance(source, Scene) else repr(source),
        # Meshes and arrays count, too.
        "scene_hash": hashlib.sha256(packed).hexdigest(),
        "seconds": experiment.seconds,
        "fps": experiment.fps,
        "samples": grid.samples,
        "over": grid.over,
        "seeds": seeds,
        "noise": experiment.noise,
        "prepare": None if experiment.prepare is None else _signed(experiment.prepare),
        "measure": measure.names if isinstance(measure, Builtin) else _signed(measure),
        "keep": None if experiment.trajectories is None else "trajectories",
    }


def _signed(function: Any) -> dict[str, str]:
    """A function's name, and a hash of its source."""
    arguments = ""
    while isinstance(function, functools.partial):
        arguments += repr((function.args, function.keywords))
        function = function.func
    bare = function if inspect.isroutine(function) else type(function)
    try:
        text = inspect.getsource(bare)
    except (OSError, TypeError):
        # Typed in at a prompt.
        code = getattr(bare, "__code__", None)
        text = "" if code is None else repr((code.co_code.hex(), code.co_consts, code.co_names))
    return {"name": bare.__qualname__, "hash": hashlib.sha256((text + arguments).encode()).hexdigest()}


def plain(field: str, value: Any) -> Any:
    """A value as JSON keeps it: lists, texts, numbers."""
    try:
        return json.loads(json.dumps(value, default=_plain))
    except TypeError as error:
        raise refusal(field, str(error)) from None


def listed(field: str, values: Any, of: str) -> list[Any]:
    """A list that is not empty, of any iterable that is not a text."""
    if isinstance(values, (str, bytes, Mapping)) or not isinstance(values, (Iterable, np.ndarray)):
        raise refusal(field, f"is {values!r}, and must be a list of {of}")
    made = list(values)
    if not made:
        raise refusal(field, f"is empty, and must have at least one of {of}")
    return made
