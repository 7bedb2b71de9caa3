"""Runs on Dask: this machine's processors, or a cluster."""

from __future__ import annotations

import itertools
import logging
import os
import re
import time
import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from .. import _engine
from ..errors import Error, refusal
from .plan import Experiment, Trial

if TYPE_CHECKING:
    from distributed import Client

#: A task costs Dask some milliseconds, a short run a fraction of one. So a task is a batch of runs,
#: for so long, s.
BATCH_SECONDS = 0.5
#: Where there are many workers batches take longer, as a scheduler
#: hands out no more than some hundred tasks a second.
TASKS_PER_SECOND = 200
#: Batches handed out at a time for each thread of the workers: one that it does, and one that waits for it.
AHEAD = 2
#: How long to look for a scheduler, s.
PATIENCE = 10
#: Sweeps of this process that were interrupted: their runs on its threads end with their frame.
_stopped: set[str] = set()


@contextmanager
def client_of(scheduler: str | Client | None, workers: int | None) -> Iterator[Client]:
    """Where the runs are done: on a cluster, or on threads of this process.

    Threads, as the engine lets go of Python's lock while it steps, so that they run side by side; they start
    in no time, measure functions of a notebook work, and a script needs no ``if __name__ == "__main__"``, all
    unlike processes. What a measure does in Python itself is done by one thread at a time; where that counts,
    a cluster of processes on this machine mends it: ``scheduler=distributed.Client()``.
    """
    import distributed

    if scheduler is not None and not isinstance(scheduler, str):
        yield scheduler
        return
    if scheduler is None:
        with (
            distributed.LocalCluster(
                n_workers=1,
                threads_per_worker=workers or os.cpu_count() or 1,
                processes=False,
                # Dask's web pages, which cannot be left out: for nobody but this machine.
                dashboard_address="127.0.0.1:0",
                worker_dashboard_address="127.0.0.1:0",
                # The memory of this process is not all the sweep's: nothing is to pause when it fills.
                memory_limit=0,
                silence_logs=logging.CRITICAL,
            ) as cluster,
            distributed.Client(cluster, set_as_default=False) as client,
        ):
            yield client
        return
    if re.fullmatch(r".+:\d+", scheduler) is None:
        raise refusal("scheduler", f'is "{scheduler}", and must be as "tcp://host:8786"')
    try:
        client = distributed.Client(scheduler, timeout=PATIENCE, set_as_default=False)
    except (OSError, ValueError, TypeError) as error:
        raise refusal("scheduler", f'nobody answers at "{scheduler}": {error}', code="not_found") from None
    with client:
        yield client


def results(
    client: Client, experiment: Experiment, trials: Iterator[Trial], left: int
) -> Iterator[tuple[str, int]]:
    """Does the runs, of which so many are ``left``; gives lines of the journal as they come, and how many.

    However many runs there are, only a few are handed out at a time.
    """
    import distributed
    from distributed.scheduler import KilledWorker

    name = f"sprung-{uuid.uuid4().hex}"
    names = (f"{name}-{number}" for number in itertools.count())
    handed_out: dict[Any, list[Trial]] = {}
    suspects: list[Trial] = []
    alone: Trial | None = None
    # How long a run takes, s. As long as nothing is known, a batch is one run.
    pace = BATCH_SECONDS
    finished = distributed.as_completed(loop=client.loop, with_results=True, raise_errors=False)

    def hand_out(batch: list[Trial]) -> None:
        # If its worker dies, Dask gives the batch to another one.
        future = client.submit(_do, experiment, batch, name, _engine.__version__, key=next(names), pure=False)
        handed_out[future] = batch
        finished.add(future)

    def fill() -> None:
        nonlocal left, alone
        slots = sum(client.ncores().values()) or 1
        seconds = max(BATCH_SECONDS, slots / TASKS_PER_SECOND)
        while left > 0 and len(handed_out) < AHEAD * slots:
            # Towards the end batches get smaller, so that all workers have some to the last.
            size = max(1, min(int(seconds / pace), left // (AHEAD * slots)))
            batch = list(itertools.islice(trials, size))
            left -= size
            hand_out(batch)
        if suspects and not handed_out:
            alone = suspects.pop()
            hand_out([alone])

    try:
        fill()
        for future, result in finished:
            batch = handed_out.pop(future)
            if future.status == "finished":
                lines, seconds = result
                # One quick batch does not promise that all are.
                pace = max((pace + seconds / len(batch)) / 2, pace / 8, 1e-6)
                yield lines, len(batch)
            else:
                error = result[1] if isinstance(result, tuple) else result
                if isinstance(error, Error):
                    raise error
                if not isinstance(error, KilledWorker):
                    sentence = f"the cluster could not do its runs: {type(error).__name__}: {error}"
                    raise refusal("scheduler", sentence, code="unsupported")
                # All that was with the workers that died is suspected. A run that has nothing beside it shows
                # whether it is what kills them, for want of memory perhaps.
                if alone is not None and batch == [alone]:
                    yield experiment.lost(alone, error.allowed_failures + 1), 1
                else:
                    suspects.extend(batch)
            fill()
    finally:
        if handed_out:
            _stopped.add(name)
            client.cancel(list(handed_out), force=True)


def _do(experiment: Experiment, batch: list[Trial], name: str, version: str) -> tuple[str, float]:
    """What a worker does: the lines of a batch, and how long they took, s."""
    if version != _engine.__version__:
        raise refusal(
            "scheduler", f"a worker has sprung {_engine.__version__}, and this is {version}", code="conflict"
        )
    begin = time.perf_counter()
    return experiment.lines(batch, lambda: name in _stopped), time.perf_counter() - begin
