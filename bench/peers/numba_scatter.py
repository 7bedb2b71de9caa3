"""Numba on one thread: the plain loop over springs, compiled."""

import numba
import numpy as np


def make(network, threads):
    return Peer(network)


class Peer:
    def __init__(self, network):
        self.network = network
        self.force = np.zeros_like(network.position)
        self.reset()

    def reset(self):
        self.x, self.v = self.network.position.copy(), self.network.velocity.copy()

    def step(self, n):
        net = self.network
        laws = net.ends, net.stiffness, net.damping, net.rest_length
        steps(n, self.x, self.v, self.force, net.inverse_mass, *laws, net.gravity, net.dt)

    def positions(self):
        return self.x


@numba.njit(fastmath=True, error_model="numpy")
def steps(n, x, v, force, inverse_mass, ends, stiffness, damping, rest_length, gravity, dt):
    for _ in range(n):
        for s in range(len(ends)):
            i, j = ends[s]
            ex, ey, ez = x[i, 0] - x[j, 0], x[i, 1] - x[j, 1], x[i, 2] - x[j, 2]
            length = np.sqrt(ex * ex + ey * ey + ez * ez)
            ex, ey, ez = ex / length, ey / length, ez / length
            speed = (v[i, 0] - v[j, 0]) * ex + (v[i, 1] - v[j, 1]) * ey + (v[i, 2] - v[j, 2]) * ez
            tension = stiffness[s] * (length - rest_length[s]) + damping[s] * speed
            force[i, 0] -= tension * ex
            force[i, 1] -= tension * ey
            force[i, 2] -= tension * ez
            force[j, 0] += tension * ex
            force[j, 1] += tension * ey
            force[j, 2] += tension * ez
        for p in range(len(x)):
            if inverse_mass[p] > 0:
                force[p, 1] += gravity / inverse_mass[p]
                for axis in range(3):
                    v[p, axis] += force[p, axis] * inverse_mass[p] * dt
                    x[p, axis] += v[p, axis] * dt
            force[p] = 0
