"""The machine: what it is called, which processors this process may use, and what it can do at most."""

import json
import os
import platform
import shutil
import subprocess

from engines import BUILT


def processors():
    """The processors that this process may use."""
    return sorted(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else list(range(os.cpu_count()))


def described():
    """What has to be said about the machine and its compilers."""
    return {
        "processor": model_name(),
        "processors": len(processors()),
        "system": f"{platform.system()} {platform.machine()}",
        "python": platform.python_version(),
        "g++": first_line("g++", "--version"),
        "rustc": first_line("rustc", "--version"),
    }


def model_name():
    try:
        with open("/proc/cpuinfo") as info:
            return next(line.split(":")[1].strip() for line in info if line.startswith("model name"))
    except (OSError, StopIteration):
        return platform.processor() or platform.machine()


def first_line(*command):
    if not shutil.which(command[0]):
        return "none"
    return subprocess.run(command, capture_output=True, text=True).stdout.partition("\n")[0]


class Limits:
    """The best that limits.cpp has measured so far, on one processor and on all. It takes its turns like any engine."""

    def __init__(self):
        self.best = {}

    def take_turn(self):
        for threads in sorted({1, len(processors())}):
            try:
                output = subprocess.run([BUILT / "limits", str(threads)], capture_output=True, text=True, check=True)
            except (OSError, subprocess.CalledProcessError):
                continue
            measured = json.loads(output.stdout)
            best = self.best.setdefault(threads, measured)
            for key, value in measured.items():
                best[key] = min(best[key], value) if key.endswith("_ns") else max(best[key], value)

    def found(self):
        return list(self.best.values())
