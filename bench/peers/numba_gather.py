"""Numba on several threads: every point gathers its forces, so that no two threads write to one place."""

import numba
import numpy as np


def make(network, threads):
    numba.set_num_threads(threads)
    return Peer(network)


class Peer:
    def __init__(self, network):
        self.network = network
        self.starts, self.other, spring = network.half_springs()
        self.laws = [law[spring] for law in (network.stiffness, network.damping, network.rest_length)]
        self.spare = np.empty_like(network.position), np.empty_like(network.velocity)
        self.reset()

    def reset(self):
        self.x, self.v = self.network.position.copy(), self.network.velocity.copy()

    def step(self, n):
        net = self.network
        for _ in range(n):
            new = self.spare
            step(self.x, self.v, *new, net.inverse_mass, self.starts, self.other, *self.laws, net.gravity, net.dt)
            self.spare = self.x, self.v
            self.x, self.v = new

    def positions(self):
        return self.x


@numba.njit(parallel=True, fastmath=True, error_model="numpy")
def step(x, v, new_x, new_v, inverse_mass, starts, other, stiffness, damping, rest_length, gravity, dt):
    for i in numba.prange(len(x)):
        fx, fy, fz = np.float32(0), np.float32(0), np.float32(0)
        for s in range(starts[i], starts[i + 1]):
            j = other[s]
            ex, ey, ez = x[i, 0] - x[j, 0], x[i, 1] - x[j, 1], x[i, 2] - x[j, 2]
            length = np.sqrt(ex * ex + ey * ey + ez * ez)
            ex, ey, ez = ex / length, ey / length, ez / length
            speed = (v[i, 0] - v[j, 0]) * ex + (v[i, 1] - v[j, 1]) * ey + (v[i, 2] - v[j, 2]) * ez
            tension = stiffness[s] * (length - rest_length[s]) + damping[s] * speed
            fx -= tension * ex
            fy -= tension * ey
            fz -= tension * ez
        w = inverse_mass[i]
        weight = gravity if w > 0 else np.float32(0)
        new_v[i, 0] = v[i, 0] + fx * w * dt
        new_v[i, 1] = v[i, 1] + (fy * w + weight) * dt
        new_v[i, 2] = v[i, 2] + fz * w * dt
        for axis in range(3):
            new_x[i, axis] = x[i, axis] + new_v[i, axis] * dt
