"""PyBullet: a soft body of masses and springs in its deformable world.

It takes meshes and not springs: those are the edges of a Delaunay mesh of the points, of triangles where they lie in a
plane, else of tetrahedra. It adds damping of its own and steps partly implicitly. So it does not compute the same
motion, and its time is divided by the `springs` that it has itself.
"""

import os
import tempfile

import numpy as np
import pybullet
from scipy.spatial import Delaunay


def make(network, threads):
    return Peer(network)


class Peer:
    def __init__(self, network):
        pybullet.connect(pybullet.DIRECT)
        self.network = network
        flat = np.ptp(network.position, axis=0) < 1e-3
        cells = Delaunay(network.position[:, ~flat]).simplices
        with tempfile.TemporaryDirectory() as folder:
            self.file = os.path.join(folder, "mesh.obj" if cells.shape[1] == 3 else "mesh.vtk")
            with open(self.file, "w") as file:
                file.write(obj(network.position, cells) if cells.shape[1] == 3 else vtk(network.position, cells))
            self.load()
        pairs = [cells[:, [a, b]] for a in range(cells.shape[1]) for b in range(a)]
        self.springs = len(np.unique(np.sort(np.concatenate(pairs), axis=1), axis=0))

    def load(self):
        network = self.network
        pybullet.resetSimulation(pybullet.RESET_USE_DEFORMABLE_WORLD)
        pybullet.setGravity(0, float(network.gravity), 0)
        pybullet.setTimeStep(float(network.dt))
        self.body = pybullet.loadSoftBody(
            self.file, mass=network.points / float(network.inverse_mass.max()), useMassSpring=1, useNeoHookean=0,
            springElasticStiffness=float(network.stiffness[0]), springDampingStiffness=float(network.damping[0]),
            springDampingAllDirections=0, useBendingSprings=0, useSelfCollision=0,
        )  # fmt: skip
        for point in np.flatnonzero(network.inverse_mass == 0):
            pybullet.createSoftBodyAnchor(self.body, int(point), -1, -1)

    def reset(self):
        pass  # There is no way back; as there is no ground, it can go on.

    def step(self, n):
        for _ in range(n):
            pybullet.stepSimulation()

    def positions(self):
        return pybullet.getMeshData(self.body, -1, flags=pybullet.MESH_DATA_SIMULATION_MESH)[1]


def obj(position, triangles):
    lines = [f"v {x} {y} {z}" for x, y, z in position.tolist()]
    return "\n".join(lines + [f"f {a} {b} {c}" for a, b, c in (triangles + 1).tolist()]) + "\n"


def vtk(position, tetrahedra):
    lines = ["# vtk DataFile Version 2.0", "a mesh", "ASCII", "DATASET UNSTRUCTURED_GRID"]
    lines += [f"POINTS {len(position)} double"] + [f"{x} {y} {z}" for x, y, z in position.tolist()]
    lines += [f"CELLS {len(tetrahedra)} {5 * len(tetrahedra)}"]
    lines += [f"4 {a} {b} {c} {d}" for a, b, c, d in tetrahedra.tolist()]
    lines += [f"CELL_TYPES {len(tetrahedra)}"] + ["10"] * len(tetrahedra)
    return "\n".join(lines) + "\n"
