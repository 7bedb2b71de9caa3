#!/usr/bin/env python3
"""Measures sprung beside its peers: see README.md. It runs on any Python from 3.11 on and needs nothing installed.

It makes an environment of its own under target/, installs what requirements.txt pins, and starts again in there.
"""

import argparse
import os
import subprocess
import sys
import venv
from pathlib import Path

BENCH = Path(__file__).resolve().parent
HOME = BENCH.parent / "target" / "bench-peers"
REQUIREMENTS = BENCH / "requirements.txt"

SCENES = "jelly10 cloth20 cloth512 jelly64 cloth512-random jelly64-random irregular64"
QUICK_SCENES = "jelly10 cloth20 cloth64 jelly16 cloth64-random jelly16-random irregular16"
GROWTH_SCENES = "jelly5 jelly10 jelly22 jelly48 jelly105"


def arguments():
    parser = argparse.ArgumentParser(description="Measure sprung beside its peers. Results go to bench/results.")
    parser.add_argument("--engines", nargs="+", metavar="KEY", help="only these (default: all; see engines.py)")
    parser.add_argument("--scenes", nargs="+", metavar="NAME", help=f"default: {SCENES}")
    parser.add_argument("--growth", action="store_true", help=f"one shape from 10³ to 10⁷ springs: {GROWTH_SCENES}")
    parser.add_argument("--quick", action="store_true", help="small scenes and short runs: does all work?")
    parser.add_argument("--rounds", type=int, metavar="N", help="turns of each engine on a scene (5; quick: 2)")
    parser.add_argument("--results", type=Path, metavar="FOLDER", default=BENCH / "results")
    args = parser.parse_args()
    default = GROWTH_SCENES if args.growth else QUICK_SCENES if args.quick else SCENES
    args.scenes = args.scenes or default.split()
    args.rounds = args.rounds or (2 if args.quick else 5)
    return args


def environment():
    """The Python of an environment that holds what requirements.txt pins, made or renewed if need be."""
    python = HOME / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    installed = HOME / "installed.txt"
    wanted = REQUIREMENTS.read_text()
    if installed.exists() and installed.read_text() == wanted:
        return python
    if not python.exists():
        venv.create(HOME, with_pip=True)
    pins = [line for line in wanted.splitlines() if line and not line.startswith("#")]
    if subprocess.run([python, "-m", "pip", "install", "-q", *pins]).returncode != 0:
        # Some engine has no package for this system or this Python: the sitting does without it and says so.
        for pin in pins:
            subprocess.run([python, "-m", "pip", "install", "-q", "--only-binary=:all:", pin])
    installed.write_text(wanted)
    return python


if __name__ == "__main__":
    args = arguments()
    if Path(sys.prefix).resolve() != HOME.resolve():
        python = environment()
        sys.exit(subprocess.run([python, "-u", *sys.argv]).returncode)
    from sitting import sit

    sit(args)
