"""Runs by the thousand: every combination of parameters and seeds, on all processors or on a cluster, as one
table."""

from __future__ import annotations

import math
import operator
import os
import tempfile
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, SupportsFloat

from ..errors import needs, refusal
from ..model import Model
from ..scene import Changes, Scene, Value
from ..scene import scene as scene_of
from ..simulation import Progress, bar
from .folder import Folder
from .measures import MEASURES, BuiltinMeasure, Measure, measure_of
from .plan import Experiment, Grid, Prepare, Trial, description, listed, plain
from .workers import client_of, results

if TYPE_CHECKING:
    import pandas
    from distributed import Client

__all__ = ["MEASURES", "BuiltinMeasure", "Measure", "sweep"]


def sweep(
    scene: str | os.PathLike[str] | Scene | Model,
    over: Mapping[str, Iterable[Value]] | None = None,
    *,
    seconds: float,
    samples: Iterable[Changes] = ({},),
    seeds: int | Iterable[int] = (0,),
    noise: float = 0.0,
    prepare: Prepare | None = None,
    measure: Measure | str | Sequence[str] = (),
    fps: float | None = None,
    keep: Literal["trajectories"] | None = None,
    out: str | os.PathLike[str] | None = None,
    scheduler: str | Client | None = None,
    workers: int | None = None,
    progress: Progress = None,
) -> pandas.DataFrame:
    """Runs a scene with every combination of the values in ``over``, for so many ``seconds`` each, and gives
    a table of all runs.

    >>> import sprung
    >>> varied = {"stiffness": [500, 750], "plane.damping": [5, 10]}
    >>> table = sprung.sweep("jelly", varied, seconds=1, measure="lowest")
    >>> table[["stiffness", "plane.damping", "status"]]
       stiffness  plane.damping status
    0        500              5     ok
    1        500             10     ok
    2        750              5     ok
    3        750             10     ok

    *Which runs.* Keys of ``over`` are those of :meth:`Scene.changed`. ``samples`` is a list of such changes,
    one set for each run; with ``over``, each is combined with every value. Each of these is run with each of
    the ``seeds``: so many, from 0, or a list.

    *How one begins.* With ``noise`` (m/s) each coordinate of every free point's velocity gets a random number
    from -noise to noise. ``prepare`` is called with the simulation and a :class:`numpy.random.Generator`,
    both seeded by the run's seed alone. The same seed and parameters give the same bits, however many workers
    there are and wherever they are.

    *What is measured.* ``measure`` is one or several of the built-in measures by name (``sprung.MEASURES``
    lists them), or a function. It is called with an iterator: over the simulation itself, at its start and at
    each frame (``fps`` a second, by default ``substeps`` steps apart). It gives a dictionary of numbers.
    Nothing is recorded, and the run ends when it returns:

    >>> def landing(frames):
    ...     for jelly in frames:
    ...         if jelly.positions[:, 1].min() < -10:
    ...             break
    ...     return {"landed_at": jelly.time}
    >>> table = sprung.sweep("jelly", seconds=5, seeds=3, noise=0.5, measure=landing)
    >>> table["landed_at"].round(2).tolist()
    [1.21, 1.21, 1.21]

    *The table* has a row for each run: ``run`` (its number), the parameters, ``seed``, what was measured,
    ``status`` (``"ok"``, ``"blew up"`` or ``"failed"``), ``message``, ``state_hash`` at the end,
    ``simulated_seconds``, ``wall_seconds``, ``version``; and of a blow-up ``blow_up_step``, ``blow_up_time``
    (s), ``blow_up_spring``, ``dt_limit`` (s) and ``suggested_dt`` (s). A run that blows up or whose measure
    raises is a row, and the others go on.

    *The folder* ``out`` has the table as ``table.parquet``, and with ``keep="trajectories"`` each run's
    positions (f, n, 3), m, velocities (f, n, 3), m/s, times (f,), s, and steps (f,) as a group of
    ``trajectories.zarr``. A sweep that was interrupted, or killed, goes on when it is called again with the
    same folder: no run is done twice or lost. A folder that holds another sweep is refused.

    *Where.* On ``workers`` threads of this process, by default one for each processor; or on a Dask cluster,
    whose ``scheduler`` is named (``"tcp://host:8786"``) or given as a ``distributed.Client``. Trajectories
    are written by the workers, so they must see ``out`` by the same path. See docs/scale.md.

    Raises :class:`Error` for arguments that are wrong, before anything runs.
    """
    needs("a sweep", "sweep", "distributed", "pandas", "pyarrow", *(("zarr",) if keep is not None else ()))
    if keep not in (None, "trajectories"):
        raise refusal("keep", f'is {keep!r}, and must be "trajectories" or nothing')
    if keep is not None and out is None:
        raise refusal("keep", "trajectories need a folder", fix="name one with out")
    if workers is not None and scheduler is not None:
        raise refusal(
            "workers",
            "are the cluster's, where there is a scheduler",
            code="conflict",
            fix="leave one of them out",
        )
    if workers is not None and _count("workers", workers) < 1:
        raise refusal("workers", f"is {workers}, and must be at least 1")
    source = scene if isinstance(scene, (Scene, Model)) else scene_of(_named(scene))
    grid = Grid(_samples(samples), _over(over), _seeds(seeds))
    grid.check(source)
    folder_path = None if out is None else Path(out).absolute()
    experiment = Experiment(
        source,
        _number("seconds", seconds, zero=True),
        None if fps is None else _number("fps", fps),
        _number("noise", noise, zero=True),
        prepare,
        measure_of(measure),
        folder_path / "trajectories.zarr" if keep is not None and folder_path is not None else None,
    )
    told = description(experiment, grid, seeds if isinstance(seeds, int) else list(grid.seeds))
    with ExitStack() as stack:
        # Without a folder of its own the journal lies in one that goes when the sweep is done.
        path = folder_path or Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="sprung")))
        folder = Folder(path, told)
        stack.callback(folder.close)
        if len(folder.done) < len(grid):
            _run(experiment, grid, folder, scheduler, workers, progress)
        return folder.table(grid.keys)


def _run(
    experiment: Experiment,
    grid: Grid,
    folder: Folder,
    scheduler: str | Client | None,
    workers: int | None,
    progress: Progress,
) -> None:
    """Does the runs that are not done yet."""
    if experiment.trajectories is not None:
        import zarr

        zarr.open_group(str(experiment.trajectories), mode="a")
    left: Iterator[Trial] = (grid[run] for run in range(len(grid)) if run not in folder.done)
    with (
        client_of(scheduler, workers) as client,
        bar(len(grid), "run", progress, initial=len(folder.done)) as advance,
    ):
        for lines, count in results(client, experiment, left, len(grid) - len(folder.done)):
            folder.add(lines)
            advance(count)


def _named(scene: Any) -> str | os.PathLike[str]:
    if isinstance(scene, (str, os.PathLike)):
        return scene
    raise refusal("scene", f"is {scene!r}, and must be a scene, its name or file, or a model")


def _samples(samples: Any) -> list[dict[str, Value]]:
    made = listed("samples", samples, "dictionaries of changes")
    for sample in made:
        if not isinstance(sample, Mapping):
            raise refusal("samples", f"has {sample!r}, and must have dictionaries of changes")
    return [plain("samples", dict(sample)) for sample in made]


def _over(over: Any) -> dict[str, list[Value]]:
    if over is not None and not isinstance(over, Mapping):
        raise refusal("over", f"is {over!r}, and must be lists of values by key")
    return {
        key: plain(f"over.{key}", listed(f"over.{key}", values, "values"))
        for key, values in (over or {}).items()
    }


def _seeds(seeds: Any) -> Sequence[int]:
    if not isinstance(seeds, Iterable):
        count = _count("seeds", seeds)
        if count < 1:
            raise refusal("seeds", f"is {count}, and must be at least 1, or a list")
        return range(count)
    made = [_count("seeds", seed) for seed in listed("seeds", seeds, "whole numbers")]
    if min(made) < 0 or max(made) >= 2**64 or len(set(made)) < len(made):
        raise refusal("seeds", "must be whole numbers from 0 to 2^64 - 1, each once")
    return made


def _count(field: str, value: Any) -> int:
    try:
        return operator.index(value)
    except TypeError:
        raise refusal(field, f"is {value!r}, and must be a whole number") from None


def _number(field: str, value: Any, zero: bool = False) -> float:
    if isinstance(value, (bool, str)) or not isinstance(value, SupportsFloat):
        raise refusal(field, f"is {value!r}, and must be a number")
    number = float(value)
    if not math.isfinite(number) or number < 0 or (number == 0 and not zero):
        raise refusal(
            field, f"is {number:g}, and must be a finite number {'of at least' if zero else 'above'} 0"
        )
    return number
