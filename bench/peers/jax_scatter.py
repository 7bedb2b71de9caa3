"""JAX on the processor: one compiled loop over steps, forces summed with `at[].add`."""

import functools
import os

os.environ["JAX_PLATFORMS"] = "cpu"

import jax
import jax.numpy as jnp


def make(network, threads):
    return Peer(network)


class Peer:
    def __init__(self, network):
        self.start = jnp.array(network.position), jnp.array(network.velocity)
        i, j = network.ends.T
        laws = network.stiffness, network.damping, network.rest_length, network.inverse_mass
        self.arrays = [jnp.array(a) for a in (i, j, *laws)]
        self.gravity = jnp.array([0, network.gravity, 0]) * (self.arrays[-1] > 0)[:, None]
        self.dt = network.dt
        self.reset()

    def reset(self):
        self.x, self.v = (a.copy() for a in self.start)

    def step(self, n):
        self.x, self.v = steps(n, self.x, self.v, *self.arrays, self.gravity, self.dt)
        self.x.block_until_ready()

    def positions(self):
        return self.x


@functools.partial(jax.jit, donate_argnums=(1, 2))
def steps(n, x, v, i, j, stiffness, damping, rest_length, inverse_mass, gravity, dt):
    def step(_, state):
        x, v = state
        axis = x[i] - x[j]
        length = jnp.sqrt(jnp.sum(axis * axis, axis=1))
        axis = axis / length[:, None]
        speed = jnp.sum((v[i] - v[j]) * axis, axis=1)
        pull = axis * (stiffness * (length - rest_length) + damping * speed)[:, None]
        force = jnp.zeros_like(x).at[i].add(-pull).at[j].add(pull)
        v = v + (force * inverse_mass[:, None] + gravity) * dt
        return x + v * dt, v

    return jax.lax.fori_loop(0, n, step, (x, v))
