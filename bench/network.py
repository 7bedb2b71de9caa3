"""A network of springs, and the file in which every engine of the benchmark is handed one.

The file is little-endian and holds nothing but numbers, so that a reader is ten lines in any language:

    8 bytes   b"network1"
    uint32    points n, springs m
    float32   dt (s), gravity along y (m/s²)
    float32   position [n][3] (m), velocity [n][3] (m/s), inverse mass [n] (1/kg; 0: fixed in space)
    uint32    ends [m][2], the smaller index first
    float32   stiffness [m] (N/m), damping [m] (N·s/m), rest length [m] (m)
"""

from dataclasses import dataclass

import numpy as np

MAGIC = b"network1"


@dataclass
class Network:
    """Everything that a step needs; arrays and units as in the file."""

    dt: np.float32
    gravity: np.float32
    position: np.ndarray
    velocity: np.ndarray
    inverse_mass: np.ndarray
    ends: np.ndarray
    stiffness: np.ndarray
    damping: np.ndarray
    rest_length: np.ndarray

    @property
    def points(self):
        return len(self.position)

    @property
    def springs(self):
        return len(self.ends)

    def write(self, path):
        with open(path, "wb") as file:
            file.write(MAGIC)
            np.array([self.points, self.springs], "<u4").tofile(file)
            np.array([self.dt, self.gravity], "<f4").tofile(file)
            for array in (self.position, self.velocity, self.inverse_mass, self.ends):
                array.tofile(file)
            for array in (self.stiffness, self.damping, self.rest_length):
                array.tofile(file)

    @classmethod
    def read(cls, path):
        with open(path, "rb") as file:
            if file.read(8) != MAGIC:
                raise ValueError(f"{path} holds no network")
            n, m = map(int, np.fromfile(file, "<u4", 2))
            dt, gravity = np.fromfile(file, "<f4", 2)
            position, velocity = (np.fromfile(file, "<f4", 3 * n).reshape(n, 3) for _ in range(2))
            inverse_mass = np.fromfile(file, "<f4", n)
            ends = np.fromfile(file, "<u4", 2 * m).reshape(m, 2)
            stiffness, damping, rest_length = (np.fromfile(file, "<f4", m) for _ in range(3))
        return cls(dt, gravity, position, velocity, inverse_mass, ends, stiffness, damping, rest_length)

    def half_springs(self):
        """Every spring seen from both of its ends, sorted by point: for engines in which a point gathers its forces.

        Gives where each point's half-springs begin (n + 1 numbers), the points at the other ends, and the springs.
        """
        here, there = np.concatenate([self.ends, self.ends[:, ::-1]]).T
        order = np.argsort(here, kind="stable")
        starts = np.concatenate([[0], np.cumsum(np.bincount(here, minlength=self.points))])
        return starts.astype(np.int32), there[order].astype(np.int32), (order % self.springs).astype(np.int32)
