"""Taichi: every point gathers the forces of its springs; the two loops of the kernel run on all threads."""

import taichi

from peers.kernels import Peer


def make(network, threads):
    taichi.init(arch=taichi.cpu, cpu_max_num_threads=threads, offline_cache=False, log_level=taichi.WARN)
    return Peer(taichi, network)
