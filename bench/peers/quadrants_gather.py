"""Quadrants, which went on from Taichi: the same kernel."""

import quadrants

from peers.kernels import Peer


def make(network, threads):
    quadrants.init(arch=quadrants.cpu, cpu_max_num_threads=threads, offline_cache=False, log_level=quadrants.WARN)
    return Peer(quadrants, network)
