"""Physics through this door: the independent twin in NumPy, closed forms, and the books."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

import sprung

Array = NDArray[np.float64]


def twin(simulation: sprung.Simulation, steps: int) -> tuple[Array, Array]:
    """Semi-implicit Euler in float64, written down from the formulas: springs, dampers, gravity and one level plane."""
    x, v = simulation.positions.astype(float), simulation.velocities.astype(float)
    i, j = simulation.springs.T
    mass = simulation.mass.astype(float)[:, None]
    k, c = (getattr(simulation, name).astype(float) for name in ("stiffness", "damping"))
    rest = simulation.rest_lengths.astype(float)
    free = ((simulation.mass > 0) & ~simulation.pinned)[:, None]
    gravity, dt = simulation.gravity.astype(float), simulation.dt
    for _ in range(steps):
        apart = x[i] - x[j]
        length = np.linalg.norm(apart, axis=1)
        axis = apart / length[:, None]
        approach = ((v[i] - v[j]) * axis).sum(axis=1)
        pull = (-(k * (length - rest) + c * approach))[:, None] * axis
        force = mass * gravity
        np.add.at(force, i, pull)
        np.add.at(force, j, -pull)
        for plane in simulation.planes:
            depth = plane.point[1] - x[:, 1]
            push = np.where(depth > 0, np.maximum(plane.stiffness * depth - plane.damping * v[:, 1], 0), 0)
            force[:, 1] += push
        v = np.where(free, v + dt * force / np.where(mass > 0, mass, 1), 0)
        x = x + dt * v
    return x, v


@pytest.mark.parametrize("name", ["spring", "chain", "cloth", "jelly"])
def test_the_twin_in_float64_goes_the_same_way(name: str) -> None:
    simulation = sprung.scene(name).simulation()
    steps = 150
    x, v = twin(simulation, steps)
    simulation.step(steps)
    extent = np.ptp(x, axis=0).max()
    # Positions carry what rounding drops: what is left are float32 forces, a relative 2⁻²⁴ each. In 150 steps the stretched
    # motions here amplify that by less than a thousand.
    assert np.abs(simulation.positions - x).max() < 1000 * 2**-24 * extent
    assert np.abs(simulation.velocities - v).max() < 1000 * 2**-24 * max(1.0, np.abs(v).max()) * 10


def test_an_oscillator_keeps_its_period() -> None:
    k, m, dt = 40.0, 0.5, 1e-4
    model = sprung.Model([[0.0, 0, 0], [1.2, 0, 0]], [0, m], [[0, 1]], stiffness=k, rest_lengths=1)
    trajectory = model.simulation(dt=dt, gravity=[0, 0, 0]).run(2, every=10)
    omega = np.sqrt(k / m)
    expected = 1 + 0.2 * np.cos(omega * trajectory.times)
    # First order: the phase of semi-implicit Euler is off by half a step, so x by 0.2·ω·dt/2 at the most, and rounding.
    assert np.abs(trajectory.positions[:, 1, 0] - expected).max() < 0.2 * omega * dt / 2 + 1e-6


def test_the_books_balance(jelly: sprung.Simulation) -> None:
    jelly.keeps_ledger = True
    energy = jelly.run(3, fps=50).energy
    booked = energy.start + energy.work_in - energy.lost_in_dampers - energy.lost_in_contact + energy.integrator_error
    assert np.abs(energy.total - booked).max() < 1e-6 * np.abs(energy.kinetic).max()
    assert energy.lost_in_dampers[-1] > 0 and energy.lost_in_contact[-1] > 0


def test_forces_from_an_array_do_work() -> None:
    push = np.array([[0.0, 0, 0], [3.0, 0, 0]])
    simulation = sprung.Model([[0, 0, 0], [1, 0, 0]], 2.0).simulation(dt=0.01, gravity=[0, 0, 0])
    simulation.external_forces = push
    assert (simulation.external_forces == push).all()
    assert np.allclose(simulation.forces(), push)
    simulation.step(100)
    # v = F/m·t, exactly but for rounding, and x = ½F/m·t(t + dt) with this integrator.
    assert simulation.velocities[1, 0] == pytest.approx(1.5, rel=1e-6)
    assert simulation.positions[1, 0] == pytest.approx(1 + 0.5 * 1.5 * 1.01, rel=1e-6)
    assert simulation.energy.work_in == pytest.approx(3 * 0.5 * 1.5, rel=1e-5)
    simulation.external_forces = None
    simulation.step(100)
    assert simulation.velocities[1, 0] == pytest.approx(1.5, rel=1e-6)


def test_stability_is_told(jelly: sprung.Simulation) -> None:
    stability = jelly.stability
    assert stability.is_stable
    assert stability.every_configuration.dt <= stability.certified.dt <= stability.sharp * 1.001
    assert jelly.certified_limit.dt == pytest.approx(stability.certified.dt, rel=2e-5)
    assert stability.certified.spring is not None
    assert jelly.springs[stability.certified.spring].tolist() == stability.certified.points


def test_a_step_that_is_safe_in_every_shape(jelly: sprung.Simulation) -> None:
    jelly.dt = "auto"
    assert jelly.dt == pytest.approx(0.95 * jelly.stability.every_configuration.dt, rel=1e-3)


def test_hands(jelly: sprung.Simulation) -> None:
    jelly.place(0, [1, 2, 3])
    assert jelly.positions[0].tolist() == [1, 2, 3]
    jelly.carry(0, [1, 0, 0])
    jelly.step(10)
    assert jelly.positions[0, 0] == pytest.approx(1 + 10 * jelly.dt, rel=1e-5)
    jelly.release(0)
    jelly.drag(999, [0, 50, 0])
    jelly.step(20)
    jelly.release(999)
    with pytest.raises(sprung.Error, match="fixed"):
        jelly.pinned = True
        jelly.drag(1, [0, 0, 0])


def test_a_state_can_be_set(jelly: sprung.Simulation) -> None:
    jelly.step(20)
    positions, velocities = jelly.positions * 2, jelly.velocities * 0 + [1, 0, 0]
    jelly.set_state(positions, velocities)
    assert (jelly.positions == positions).all() and (jelly.velocities == velocities).all()
    begun = jelly.state_hash
    jelly.step(3)
    jelly.reset()
    assert jelly.state_hash == begun


def test_surfaces_follow_the_points() -> None:
    cloth = sprung.scene("cloth").simulation()
    surface = cloth.surfaces[0]
    assert (surface.kind, surface.vertices.shape[1], surface.triangles.shape[1]) == ("cloth", 3, 3)
    assert (surface.vertices == cloth.positions).all()
    trajectory = cloth.run(0.1)
    assert (trajectory.surface() == trajectory.positions).all()
