"""The scenes that all engines are measured on, made from their rules.

A name is a shape, how many points it has along an edge, and how its points are numbered:

    jelly10          the report's cube of jelly; jelly64 is the same rule with 64 x 64 x 64 points
    cloth20          its hanging cloth; cloth512 is the same rule with 512 x 512 points
    irregular64      64³ random points in a cube, each joined to about 16 neighbours, no two springs alike
    cloth512-random  the same motion, with the points numbered at random

There is gravity and no ground: every engine has its own idea of contact, and none is touched in so few steps.
"""

import re

import numpy as np
from scipy.spatial import cKDTree

from network import Network

DT = 0.01  # s
GRAVITY = -9.81  # m/s² along y
SPACING = 2.0  # m
LATTICE_RADIUS = 8**0.5 + 0.001  # m: just over the diagonal of a square of four points
NOISE = 0.1  # m/s: no scene starts at rest, as a scene at rest tells nothing
DEGREE = 16  # neighbours of a point of the irregular network

#: What `sprung` calls the scenes that it brings along.
IN_SPRUNG = {"jelly10": "jelly", "cloth20": "cloth", "cloth512": "cloth512", "jelly64": "jelly64"}


def make(name):
    """The network with this name."""
    match = re.fullmatch(r"(jelly|cloth|irregular)(\d+)(-random)?", name)
    if not match:
        raise SystemExit(f"no scene is called {name}: they are called jelly10, cloth20, irregular64 or cloth512-random")
    shape, side, renumbered = SHAPES[match[1]], int(match[2]), match[3]
    network = shape(side)
    return with_random_numbers(network) if renumbered else network


def jelly(side):
    """A lattice, i outermost and k innermost, turned by 12.5° about (1, 1, 1)."""
    i, j, k = np.indices((side, side, side)).reshape(3, -1)
    flat = np.stack([SPACING * i - side, SPACING * j, SPACING * k], axis=1)
    position = (flat @ rotation([1, 1, 1], 12.5).T).astype(np.float32)
    return uniform(position, np.ones(len(position)), stiffness=750, damping=10)


def cloth(side):
    """A level sheet, column j outermost and row i innermost, held at the two corners with i = 0."""
    j, i = np.indices((side, side)).reshape(2, -1)
    position = np.stack([SPACING * j - side, np.full(j.shape, 10.0), SPACING * i], axis=1).astype(np.float32)
    inverse_mass = np.full(len(position), 1 / 0.5)
    inverse_mass[[0, (side - 1) * side]] = 0
    return uniform(position, inverse_mass, stiffness=600, damping=3)


def irregular(side):
    """side³ random points as dense as those of the jelly; stiffness and damping differ from spring to spring."""
    count, edge = side**3, SPACING * side
    position = (edge * random(count * 3, seed=2).reshape(count, 3)).astype(np.float32)
    radius = SPACING * (DEGREE * 3 / (4 * np.pi)) ** (1 / 3)
    ends = pairs_within(position, radius)
    stiffness, damping = 100 + 400 * random(len(ends), seed=3), 1 + 4 * random(len(ends), seed=4)
    return network(position, np.ones(count), ends, stiffness, damping)


SHAPES = {"jelly": jelly, "cloth": cloth, "irregular": irregular}


def with_random_numbers(old):
    """The same network as a user might have numbered it: the numbers of the points tell nothing about their places."""
    place = np.argsort(random(old.points, seed=5), kind="stable")  # old number of each new point
    number = np.empty_like(place)
    number[place] = np.arange(old.points)
    ends = np.sort(number[old.ends].astype(np.uint32), axis=1)
    order = np.lexsort((ends[:, 1], ends[:, 0]))  # springs as the double loop over the new numbers finds them
    springs = [array[order] for array in (old.stiffness, old.damping, old.rest_length)]
    points = [array[place] for array in (old.position, old.velocity, old.inverse_mass)]
    return Network(old.dt, old.gravity, *points, ends[order], *springs)


def uniform(position, inverse_mass, stiffness, damping):
    """A network whose springs are all of one material."""
    ends = pairs_within(position, LATTICE_RADIUS)
    return network(position, inverse_mass, ends, np.full(len(ends), stiffness), np.full(len(ends), damping))


def network(position, inverse_mass, ends, stiffness, damping):
    """Springs at rest, and points with seeded noise in their velocities, those that are fixed excepted."""
    i, j = ends.T
    rest_length = np.linalg.norm(position[i] - position[j], axis=1)
    velocity = (NOISE * (2 * random(position.size) - 1)).reshape(position.shape) * (inverse_mass > 0)[:, None]
    floats = [a.astype("<f4") for a in (position, velocity, inverse_mass)]
    laws = [a.astype("<f4") for a in (stiffness, damping, rest_length)]
    return Network(np.float32(DT), np.float32(GRAVITY), *floats, ends.astype("<u4"), *laws)


def pairs_within(position, radius):
    """All pairs i < j no further apart than the radius, in the order of the double loop."""
    pairs = cKDTree(position).query_pairs(radius, output_type="ndarray")
    return pairs[np.lexsort((pairs[:, 1], pairs[:, 0]))]


def rotation(axis, degrees):
    """Rodrigues' formula."""
    x, y, z = np.array(axis) / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    angle = np.radians(degrees)
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def random(count, seed=1):
    """Numbers in [0, 1) from splitmix64 (Steele, Lea, Flood 2014), those that `sprung bench` uses for its noise.

    The 64-bit seed advances by a constant, so that the k-th number needs none before it.
    """
    z = np.uint64(seed) + np.arange(1, count + 1, dtype=np.uint64) * np.uint64(0x9E3779B97F4A7C15)
    z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return ((z ^ (z >> np.uint64(31))) >> np.uint64(40)) / float(1 << 24)
