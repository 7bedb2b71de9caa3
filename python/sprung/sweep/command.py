"""``python -m sprung sweep sweep.toml -o out/``: a sweep that a file describes."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..errors import Error, refusal
from .measures import MEASURES, function_named, likely

#: What a file may say: the arguments of :func:`sprung.sweep` that are about the sweep, not about where it
#: runs.
KEYS = ["scene", "seconds", "over", "samples", "seeds", "noise", "prepare", "measure", "fps", "keep"]

ABOUT = """\
Runs a scene with every combination of parameters and seeds, and writes a table of all runs. FILE is TOML:

  scene = "jelly"                # built in, or a scene file by its path from this file
  seconds = 2                    # of each run
  seeds = 10                     # so many, or a list
  noise = 0.1                    # m/s, of each coordinate of the first velocities, at random
  measure = ["lowest", "kinetic_energy"]
  keep = "trajectories"          # if they are wanted

  [over]                         # keys as of `sprung run --set`
  body.jelly.stiffness = [500, 750, 1000]
  plane.damping = [5, 10]

`samples = [{ dt = 0.01, stiffness = 500 }, …]` lists sets of parameters. `fps` is how often it is measured.
`measure` and `prepare` may name a Python function of your own, as "module:function"; the module may lie
beside the file.

Measures that are built in:
"""


def main(arguments: list[str]) -> int:
    """Runs the command with these arguments, those after ``sweep``; gives its exit status."""
    listed = "".join(f"  {name:18} {unit:4} {meaning}\n" for name, unit, meaning, *_ in MEASURES)
    parser = argparse.ArgumentParser(
        "sprung sweep", description=ABOUT + listed, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("file", metavar="FILE", help="what to run")
    parser.add_argument(
        "-o",
        "--out",
        metavar="FOLDER",
        required=True,
        help="where the table goes; an interrupted sweep goes on",
    )
    parser.add_argument("--scheduler", metavar="ADDRESS", help="of a Dask cluster, as tcp://host:8786")
    parser.add_argument(
        "--workers", metavar="N", type=int, help="threads on this machine (default: one for each processor)"
    )
    parser.add_argument("-q", "--quiet", action="store_true", help="show no bar, and say nothing at the end")
    asked = parser.parse_args(arguments)
    try:
        _sweep(asked)
    except Error as error:
        print(f"sprung: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print(f"sprung: interrupted; the same command goes on with what is in {asked.out}", file=sys.stderr)
        return 130
    return 0


def _sweep(asked: argparse.Namespace) -> None:
    from . import sweep

    file = Path(asked.file)
    try:
        content = read(file)
        options: dict[str, Any] = {"scheduler": asked.scheduler, "workers": asked.workers}
        table = sweep(**content, **options, out=asked.out, progress=False if asked.quiet else None)
    except Error as error:
        # What the file says is the file's; the rest is the command's, or has its own file.
        if error.file is None and (error.field or "").split(".")[0].split("[")[0] in KEYS:
            error.args = (f"{file}: {error}",)
        raise
    if not asked.quiet:
        counts = table["status"].value_counts()
        parts = ", ".join(f"{counts.get(status, 0)} {status}" for status in ("ok", "blew up", "failed"))
        print(f"{len(table)} runs: {parts}; {Path(asked.out) / 'table.parquet'}")


def read(file: Path) -> dict[str, Any]:
    """The arguments of :func:`sprung.sweep` that a file gives."""
    if sys.version_info >= (3, 11):
        import tomllib
    else:
        import tomli as tomllib
    try:
        content: dict[str, Any] = tomllib.loads(file.read_text(encoding="utf-8"))
    except OSError as error:
        raise Error(f"{file}: {(error.strerror or str(error)).lower()}", code="io", file=str(file)) from None
    except ValueError as error:
        raise Error(f"{file}: {error}", code="syntax", file=str(file)) from None
    for key in content:
        if key not in KEYS:
            sentence = f"is not a known key; allowed here are {', '.join(KEYS)}"
            raise _at(file, refusal(key, sentence, code="unknown_key", fix=likely(key, KEYS)))
    for key in ("scene", "seconds"):
        if key not in content:
            raise _at(file, refusal(key, "is missing", code="missing"))
    if isinstance(content["scene"], str) and content["scene"].endswith(".toml"):
        content["scene"] = os.fspath(file.parent / content["scene"])
    if isinstance(content.get("over"), Mapping):
        content["over"] = _flat(content["over"])
    if isinstance(content.get("samples"), list):
        content["samples"] = [
            _flat(sample) if isinstance(sample, dict) else sample for sample in content["samples"]
        ]
    for key in ("measure", "prepare"):
        if isinstance(content.get(key), str) and ":" in content[key]:
            content[key] = _function_beside(file, key, content[key])
    if not callable(content.get("prepare", len)):
        raise _at(file, refusal("prepare", f'is {content["prepare"]!r}, and must be "module:function"'))
    return content


def _at(file: Path, error: Error) -> Error:
    return Error(f"{file}: {error}", **{**vars(error), "file": str(file)})


def _flat(table: Mapping[str, Any], before: str = "") -> dict[str, Any]:
    """``plane.y = [1, 2]`` is a table in a table to TOML, and a key to a scene."""
    made: dict[str, Any] = {}
    for key, value in table.items():
        made.update(_flat(value, f"{before}{key}.") if isinstance(value, Mapping) else {before + key: value})
    return made


def _function_beside(file: Path, key: str, name: str) -> Any:
    """A function of a module in the file's folder, or of one that is installed."""
    import importlib.util

    folder = str(file.parent.absolute())
    sys.path.insert(0, folder)
    function = function_named(key, name)
    module = sys.modules[name.partition(":")[0]]
    if (getattr(module, "__file__", None) or "").startswith(folder) and importlib.util.find_spec(
        "cloudpickle"
    ):
        import cloudpickle

        # The workers of a cluster need not have it.
        cloudpickle.register_pickle_by_value(module)
    return function
