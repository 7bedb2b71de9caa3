"""Talking to an engine in a process of its own; what is said stands at the head of measure.py."""

import json
import os
import select
import subprocess

PATIENCE = 900  # s to wait for one answer


class Failed(Exception):
    """An engine did not start, fell silent or fell over."""


class Talk:
    """A running engine. It is bound to as many processors as it has threads, so that no pool of its own takes more."""

    def __init__(self, command, processors, log):
        count = str(len(processors))
        pools = dict.fromkeys(["OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS"], count)
        bind = (lambda: os.sched_setaffinity(0, processors)) if hasattr(os, "sched_setaffinity") else None
        self.log = log
        with open(log, "w") as errors:
            self.process = subprocess.Popen(
                [str(part) for part in command], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=errors,
                env=os.environ | pools, text=True, preexec_fn=bind,
            )  # fmt: skip
        self.ready = self.listen()

    def ask(self, *words):
        try:
            print(*words, file=self.process.stdin, flush=True)
        except BrokenPipeError:
            pass  # it has died; listening says why
        return self.listen()

    def listen(self):
        if not select.select([self.process.stdout], [], [], PATIENCE)[0]:
            self.end()
            raise Failed(f"no answer within {PATIENCE} s")
        line = self.process.stdout.readline()
        if not line:
            self.end()
            with open(self.log) as log:
                said = [line.strip() for line in log if line.strip()]
            raise Failed(said[-1] if said else f"it ended with status {self.process.returncode}")
        return json.loads(line)

    def peak_mb(self):
        """The most memory it has held so far, where the system tells (Linux)."""
        try:
            with open(f"/proc/{self.process.pid}/status") as status:
                kilobytes = next(line.split()[1] for line in status if line.startswith("VmHWM"))
        except (OSError, StopIteration):
            return None
        return int(kilobytes) * 1024 / 1e6

    def end(self):
        """Lets it end, or ends it."""
        try:
            self.process.stdin.close()
            self.process.wait(10)
        except (OSError, subprocess.TimeoutExpired):
            self.process.kill()
            self.process.wait()
