"""NumPy: whole arrays at a time, forces summed with `bincount`. In float64 it is the twin of all others."""

import numpy as np


def make(network, threads, dtype=np.float32):
    return Peer(network, dtype)


class Peer:
    def __init__(self, network, dtype):
        self.start = network.position.astype(dtype), network.velocity.astype(dtype)
        self.i, self.j = network.ends.T.astype(np.intp)
        self.stiffness, self.damping = network.stiffness.astype(dtype), network.damping.astype(dtype)
        self.rest_length = network.rest_length.astype(dtype)
        self.inverse_mass = network.inverse_mass.astype(dtype)[:, None]
        self.dt = dtype(network.dt)
        self.gravity = np.array([0, network.gravity, 0], dtype) * (self.inverse_mass > 0)
        self.reset()

    def reset(self):
        self.x, self.v = self.start[0].copy(), self.start[1].copy()

    def step(self, n):
        for _ in range(n):
            axis = self.x[self.i] - self.x[self.j]
            length = np.sqrt(np.einsum("ij,ij->i", axis, axis))
            axis /= length[:, None]
            speed = np.einsum("ij,ij->i", self.v[self.i] - self.v[self.j], axis)
            tension = self.stiffness * (length - self.rest_length) + self.damping * speed
            pull = axis * tension[:, None]
            self.v += (self.sum_at_points(pull) * self.inverse_mass + self.gravity) * self.dt
            self.x += self.v * self.dt

    def sum_at_points(self, pull):
        n = len(self.x)
        sums = [np.bincount(self.j, along, n) - np.bincount(self.i, along, n) for along in pull.T]
        return np.stack(sums, axis=1).astype(self.x.dtype)

    def positions(self):
        return self.x
