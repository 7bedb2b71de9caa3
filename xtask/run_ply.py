"""Reads the binary .ply files of a run: they tell which point of the run each vertex is, or −1 for one that is none.

A vertex that is no point, as of a mesh that the points inside a soft body carry along, is in no archive of the run. How it follows
from the points is a test of the exporter; in other people's readers it must be where the .ply of the same frame has it.
"""

from pathlib import Path

import numpy as np

KINDS = {"float": "<f4", "int": "<i4", "uchar": "u1"}


def read(path: Path) -> tuple[np.ndarray, np.ndarray, list[np.ndarray]]:
    """The vertices, a record each, the two ends of each edge, and the corners of each face."""
    head, _, data = path.read_bytes().partition(b"end_header\n")
    elements = {}
    for line in head.decode().splitlines():
        words = line.split()
        if words[0] == "element":
            name, fields = words[1], []
            elements[name] = (int(words[2]), fields)
        elif words[0] == "property" and words[1] == "list":
            fields.append("list")  # a byte, and as many corners
        elif words[0] == "property":
            fields.append((words[2], KINDS[words[1]]))
    arrays, at, faces = {}, 0, []
    for name, (count, fields) in elements.items():
        if fields == ["list"]:
            for _ in range(count):
                faces.append(np.frombuffer(data, "<i4", data[at], at + 1))
                at += 1 + faces[-1].nbytes
            continue
        arrays[name] = np.frombuffer(data, fields, count, at)
        at += arrays[name].nbytes
    assert at == len(data), f"{path}: {len(data) - at} bytes are left"
    edges = arrays.get("edge", np.empty(0, [("vertex1", "<i4"), ("vertex2", "<i4")]))
    return arrays["vertex"], np.stack([edges["vertex1"], edges["vertex2"]], axis=1), faces


def same_faces(found: list, expected: list, what: str) -> None:
    """The same corners in the same order."""
    found, expected = ([list(map(int, face)) for face in faces] for faces in (found, expected))
    assert found == expected, f"{what}: other faces"


def triangles(faces: list[np.ndarray]) -> np.ndarray:
    """Every face as a fan around its first corner."""
    return np.array([(face[0], face[k], face[k + 1]) for face in faces for k in range(1, len(face) - 1)], np.int64)


def columns(vertices: np.ndarray, names: str) -> np.ndarray:
    return np.stack([vertices[name] for name in names.split()], axis=1)


class Sequence:
    """Where the vertices of a run are, frame by frame: from the archive if they are points, else from the .ply files."""

    def __init__(self, stem: Path, positions: np.ndarray, velocities: np.ndarray) -> None:
        """`stem` is the files' name without number and ending; the archive's numbers are in their axes and unit."""
        frames = [read(stem.with_name(f"{stem.name}.{frame:04}.ply"))[0] for frame in range(len(positions))]
        self.point = frames[0]["point"]
        _, self.edges, self.faces = read(stem.with_name(f"{stem.name}.0000.ply"))
        is_point = self.point >= 0
        self.positions, self.velocities = (np.stack([columns(f, n) for f in frames]) for n in ("x y z", "vx vy vz"))
        for found, expected in ((self.positions, positions), (self.velocities, velocities)):
            assert (found[:, is_point] == expected[:, self.point[is_point]]).all(), f"{stem}: points are elsewhere"
        used = self.point[is_point]
        assert (np.diff(used) > 0).all(), f"{stem}: vertices are not in the points' order"
        self.vertex_of = np.full(positions.shape[1], -1)
        self.vertex_of[used] = np.flatnonzero(is_point)
