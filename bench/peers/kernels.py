"""The kernel of Taichi and of Quadrants, whose names for things are the same: `ti` is either."""

import numpy as np


class Peer:
    def __init__(self, ti, network):
        self.network = network
        starts, other, spring = network.half_springs()
        laws = np.stack([network.stiffness, network.damping, network.rest_length], axis=1)[spring]

        def field(values, vector=0):
            shape = len(values)
            kind = ti.i32 if values.dtype.kind == "i" else ti.f32
            made = ti.Vector.field(vector, kind, shape) if vector else ti.field(kind, shape)
            made.from_numpy(values)
            return made

        self.x, self.v = field(network.position, 3), field(network.velocity, 3)
        self.synchronize = ti.sync
        self.kernel = kernel(
            ti, self.x, self.v, field(network.inverse_mass), field(starts), field(other), field(laws, 3),
            float(network.gravity), float(network.dt),
        )  # fmt: skip

    def reset(self):
        self.x.from_numpy(self.network.position)
        self.v.from_numpy(self.network.velocity)

    def step(self, n):
        for _ in range(n):
            self.kernel()
        self.synchronize()

    def positions(self):
        return self.x.to_numpy()


def kernel(ti, x, v, inverse_mass, starts, other, laws, gravity, dt):
    new_v = ti.Vector.field(3, ti.f32, x.shape)

    @ti.kernel
    def step():
        for i in x:
            xi, vi = x[i], v[i]
            force = ti.Vector([0.0, 0.0, 0.0])
            for s in range(starts[i], starts[i + 1]):
                axis = xi - x[other[s]]
                length = axis.norm()
                axis /= length
                law = laws[s]
                force -= axis * (law[0] * (length - law[2]) + law[1] * (vi - v[other[s]]).dot(axis))
            w = inverse_mass[i]
            weight = ti.Vector([0.0, gravity if w > 0 else 0.0, 0.0])
            new_v[i] = vi + (force * w + weight) * dt
        for i in x:
            v[i] = new_v[i]
            x[i] += new_v[i] * dt

    return step
