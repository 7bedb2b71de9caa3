"""One Python engine in a process of its own: `measure.py MODULE NETWORK THREADS`, driven through standard input.

A module of peers/ offers `make(network, threads)`, which gives an object with

    step(n)      n steps on from where it is
    reset()      back to the start
    positions()  where the points are now, [n][3], m, in the network's order

Every program of the benchmark, in whatever language, speaks as this one does. It begins with a line of JSON that says
how long it took from the numbers in memory to the end of the first step (`setup_s`), and how many springs it has if not
those of the network (`springs`). Then it answers each command with a line of JSON:

    run STEPS TIMES   from the start, so many steps, so many times over: the seconds of the fastest (`best_s`)
    save FILE         writes the positions as float64, little-endian
"""

import importlib
import json
import os
import sys
from time import perf_counter

import numpy as np

from network import Network


def main(name, path, threads):
    # Packages print what they please when they are loaded; the answers have a way of their own.
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)

    def say(**answer):
        print(json.dumps(answer), file=answers, flush=True)

    network = Network.read(path)
    module = importlib.import_module(f"peers.{name}")
    begun = perf_counter()
    peer = module.make(network, int(threads))
    peer.step(1)
    springs = getattr(peer, "springs", network.springs)
    say(setup_s=perf_counter() - begun, springs=springs)

    for line in sys.stdin:
        match line.split():
            case ["run", steps, times]:
                say(best_s=min(run(peer, int(steps)) for _ in range(int(times))))
            case ["save", file]:
                np.asarray(peer.positions(), "<f8").tofile(file)
                say()


def run(peer, steps):
    peer.reset()
    begun = perf_counter()
    peer.step(steps)
    return perf_counter() - begun


if __name__ == "__main__":
    main(*sys.argv[1:])
