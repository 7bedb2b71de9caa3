"""A sitting: every engine on every scene, in turn, in one go."""

import json
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np

import machine
import plot
import scenes
import table
from engines import ENGINES, SPRUNG_COMMAND, build
from entrant import CHECKED_STEPS, Entrant
from peers import numpy_bincount


def sit(args):
    """Builds, measures scene by scene, and writes what was found; after each scene, so that little is lost."""
    engines = chosen(args.engines)
    failures = build_all(engines)
    limits = machine.Limits()
    results = {
        "when": time.strftime("%Y-%m-%d"),
        "quick": args.quick,
        "machine": machine.described(),
        "versions": {engine.package: engine.version() for engine in engines if engine.package},
        "limits": [],
        "scenes": [],
    }
    args.results.mkdir(parents=True, exist_ok=True)
    for name in args.scenes:
        limits.take_turn()
        results["limits"] = limits.found()
        results["scenes"].append(measure(name, engines, failures, args.rounds, budget=0.05 if args.quick else 0.5))
        (args.results / "results.json").write_text(json.dumps(results, indent=1) + "\n")
        (args.results / "table.md").write_text(table.of(results))
        plot.write(results, args.results)
    print(f"written: {args.results}")


def chosen(keys):
    if unknown := set(keys or []) - {engine.key for engine in ENGINES}:
        known = ", ".join(engine.key for engine in ENGINES)
        raise SystemExit(f"no engine is called {', '.join(sorted(unknown))}; there are {known}")
    return [engine for engine in ENGINES if not keys or engine.key in keys]


def build_all(engines):
    """Builds everything; gives what went wrong, by engine."""
    failures = {}
    for key, source in [("limits", "limits.cpp"), *((engine.key, engine.source) for engine in engines)]:
        try:
            build(key, source)
        except (OSError, subprocess.CalledProcessError) as error:
            failures[key] = f"it could not be built: {error}"
    return failures


def measure(name, engines, failures, rounds, budget):
    """One scene: the engines start and are checked one after the other, and then take turns of `budget` seconds."""
    network = scenes.make(name)
    check_against_sprung(name, network)
    print(f"{name}: {network.points:,} points, {network.springs:,} springs")
    twin = numpy_bincount.make(network, 1, np.float64)
    twin.step(CHECKED_STEPS)
    # Each step rounds every coordinate once, by at most half of the last place of the largest.
    tolerance = CHECKED_STEPS * 2.0**-24 * float(np.abs(network.position).max())

    processors = machine.processors()
    entrants = [
        Entrant(engine, threads, network.springs)
        for engine in engines
        if engine.takes(network)
        for threads in engine.thread_counts(len(processors))
    ]
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "network"
        network.write(file)
        for entrant in entrants:
            entrant.failed = failures.get(entrant.engine.key, "")
            if not entrant.failed:
                entrant.start(file, processors, twin.positions(), tolerance)
        for _ in range(rounds):
            for entrant in entrants:
                entrant.take_turn(budget)
        for entrant in entrants:
            entrant.leave()
    found = [entrant.result() for entrant in entrants]
    for entry in found:
        print(f"  {table.label(entry):32} {entry['failed'] or table.number(entry['ns']):>8}")
    return {
        "name": name,
        "points": network.points,
        "springs": network.springs,
        "tolerance_m": tolerance,
        "entries": found,
    }


def check_against_sprung(name, network):
    """The scenes that sprung brings along must be the ones that are measured."""
    scene = scenes.IN_SPRUNG.get(name)
    if scene and SPRUNG_COMMAND.exists():
        shown = subprocess.run([SPRUNG_COMMAND, "show", scene, "--json"], capture_output=True, text=True, check=True)
        shown = json.loads(shown.stdout)
        here = {"points": network.points, "springs": network.springs, "pinned": int((network.inverse_mass == 0).sum())}
        there = {key: shown[key] for key in here}
        if here != there:
            raise SystemExit(f"{name} has {here}, and in sprung it has {there}")
