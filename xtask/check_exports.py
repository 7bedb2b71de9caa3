"""Opens what one run wrote with other people's readers, and compares every vertex with the run's NumPy archive.

Run by `cargo xtask exports` as: check_exports.py FOLDER UP SCALE, where FOLDER holds run.npz, run.pc2, run.mdd, run.pvd and the
sequences run.NNNN.obj and run.NNNN.ply of the same run. Which point a vertex is stands in the .ply and .vtp files; one that is
none is held against the .ply of the same frame.
"""

import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import meshio
import numpy as np
import run_ply
import trimesh
import vtk
from vtk.util.numpy_support import vtk_to_numpy


def same(found: np.ndarray, expected: np.ndarray, what: str) -> None:
    """The same float32. Decimal digits that were read to float64 become it when they are rounded."""
    narrow = np.asarray(found).astype(np.float32)
    assert narrow.shape == expected.shape, f"{what}: {narrow.shape}, and not {expected.shape}"
    # Zeros may have lost their sign in a text reader.
    assert (narrow == expected).all(), f"{what}: differs by up to {np.abs(narrow - expected).max()}"


def check_pc2(path: Path, expected: np.ndarray) -> None:
    data = path.read_bytes()
    head = np.frombuffer(data[:32], dtype=[("magic", "S12"), ("version", "<i4"), ("points", "<i4"), ("start", "<f4"),
                                           ("rate", "<f4"), ("frames", "<i4")])[0]
    assert head["magic"] == b"POINTCACHE2" and head["version"] == 1 and head["start"] == 0 and head["rate"] == 1, head
    assert (head["frames"], head["points"]) == expected.shape[:2], head
    same(np.frombuffer(data[32:], "<f4").reshape(expected.shape), expected, path.name)


def check_mdd(path: Path, expected: np.ndarray, time: np.ndarray) -> None:
    data = path.read_bytes()
    frames, points = np.frombuffer(data[:8], ">i4")
    assert (frames, points) == expected.shape[:2], (frames, points)
    same(np.frombuffer(data[8 : 8 + 4 * frames], ">f4"), time.astype(np.float32), f"{path.name}: times")
    same(np.frombuffer(data[8 + 4 * frames :], ">f4").reshape(expected.shape), expected, path.name)


def check_obj(path: Path, expected: np.ndarray, faces: list[np.ndarray]) -> None:
    mesh = meshio.read(path)
    same(mesh.points, expected, f"{path.name} in meshio")
    found = [face for block in mesh.cells if block.type in ("triangle", "quad", "polygon") for face in block.data]
    run_ply.same_faces(found, faces, f"{path.name} in meshio")
    mesh = trimesh.load(path, process=False, group_material=False, split_object=False, maintain_order=True)
    same(np.asarray(mesh.vertices), expected, f"{path.name} in trimesh")


def check_ply(path: Path, expected: np.ndarray, velocities: np.ndarray, polygons: list, springs: np.ndarray) -> None:
    faces = run_ply.triangles(polygons)
    mesh = trimesh.load(path, process=False)
    same(np.asarray(mesh.vertices), expected, f"{path.name} in trimesh")
    raw = mesh.metadata["_ply_raw"]
    vertex = raw["vertex"]["data"]
    same(np.stack([vertex[name] for name in ("vx", "vy", "vz")], axis=1), velocities, f"{path.name}: velocities")
    # Of a face with four corners this reader makes two triangles, in an order of its own.
    assert (in_any_order(np.asarray(mesh.faces)) == in_any_order(faces)).all(), f"{path.name}: faces"
    corners = expected.astype(np.float64)[faces]
    normal = np.zeros(expected.shape)
    of_face = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    np.add.at(normal, faces.ravel(), of_face.repeat(3, axis=0))
    weight = np.zeros(len(expected))
    np.add.at(weight, faces.ravel(), np.linalg.norm(of_face, axis=1).repeat(3))
    found = np.stack([vertex[name] for name in ("nx", "ny", "nz")], axis=1)
    length = np.linalg.norm(normal, axis=1)
    is_flat = length > 0.5 * weight  # where triangles do not turn against each other and cancel
    # Coordinates of ten, with 24 bits, in products of edges of about one.
    assert 2 * is_flat.sum() > (weight > 0).sum()
    assert (np.abs(found[is_flat] - normal[is_flat] / length[is_flat, None]) < 1e-4).all(), f"{path.name}: normals"
    if "edge" in raw:
        edges = raw["edge"]["data"]
        found = np.stack([np.asarray(edges[name]).ravel() for name in ("vertex1", "vertex2")], axis=1)
        assert (found == springs).all(), f"{path.name}: springs"
    else:  # which meshio does not read
        same(meshio.read(path).points, expected, f"{path.name} in meshio")

    reader = vtk.vtkPLYReader()
    reader.SetFileName(str(path))
    reader.Update()
    same(vtk_to_numpy(reader.GetOutput().GetPoints().GetData()), expected, f"{path.name} in VTK")
    run_ply.same_faces(polygons_of(reader.GetOutput()), polygons, f"{path.name} in VTK")


def in_any_order(triangles: np.ndarray) -> np.ndarray:
    """Each from its smallest corner on, and all of them sorted."""
    turn = triangles.argmin(axis=1)[:, None] + np.arange(3)
    turned = np.take_along_axis(triangles, turn % 3, axis=1)
    return turned[np.lexsort(turned.T)]


def polygons_of(data: vtk.vtkPolyData) -> list[np.ndarray]:
    polys = data.GetPolys()
    corners, ends = vtk_to_numpy(polys.GetConnectivityArray()), vtk_to_numpy(polys.GetOffsetsArray())
    return np.split(corners, ends[1:-1])


def read_vtp(path: Path) -> vtk.vtkPolyData:
    reader = vtk.vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    errors = []
    reader.AddObserver("ErrorEvent", lambda *_: errors.append(path.name))
    reader.Update()
    assert not errors, errors
    return reader.GetOutput()


def check_vtp(data: vtk.vtkPolyData, expected: np.ndarray, velocities: np.ndarray, time: float) -> None:
    same(vtk_to_numpy(data.GetPoints().GetData()), expected, "points in VTK")
    same(vtk_to_numpy(data.GetPointData().GetArray("velocity")), velocities, "velocities in VTK")
    assert data.GetFieldData().GetArray("TimeValue").GetValue(0) == time


def check_springs(data: vtk.vtkPolyData, archive: dict, frame: int, turn, law: tuple[float, float]) -> None:
    """Strain, tension and force, computed anew in float64 from positions and velocities."""
    stiffness, damping = law
    springs = archive["springs"].astype(np.int64)
    x, v = (archive[name].astype(np.float64) for name in ("positions", "velocities"))
    lines = vtk_to_numpy(data.GetLines().GetConnectivityArray()).reshape(-1, 2)
    assert (lines == springs).all(), "springs in VTK"
    i, j = springs.T
    axis = x[frame, i] - x[frame, j]
    length = np.linalg.norm(axis, axis=1)
    # The scenes begin at rest, but for what float32 makes of their lattice.
    rest = np.linalg.norm(x[0, i] - x[0, j], axis=1)
    axis /= length[:, None]
    tension = stiffness * (length - rest) + damping * ((v[frame, i] - v[frame, j]) * axis).sum(axis=1)
    # Rest lengths are float32 of ten metres and less, which the stiffness multiplies.
    slack = stiffness * 10 * 2.0**-23 + 1e-6 * np.abs(tension).max()
    found = vtk_to_numpy(data.GetCellData().GetArray("tension"))
    assert (np.abs(found - tension) <= slack).all(), f"tension: off by {np.abs(found - tension).max()}"
    found = vtk_to_numpy(data.GetCellData().GetArray("strain"))
    assert (np.abs(found - (length / rest - 1)) <= 10 * 2.0**-23).all(), "strain"

    if law == CLOTH:  # which touches nothing: springs and weight are all there is
        force = np.zeros_like(x[frame])
        pull = tension[:, None] * axis
        np.add.at(force, i, -pull)
        np.add.at(force, j, pull)
        fixed = vtk_to_numpy(data.GetPointData().GetArray("fixed")) != 0
        mass = archive["mass"].astype(np.float64)
        assert (vtk_to_numpy(data.GetPointData().GetArray("mass")) == archive["mass"]).all()
        force[~fixed, 1] -= 9.81 * mass[~fixed]
        found = vtk_to_numpy(data.GetPointData().GetArray("force"))
        assert fixed.sum() == 2
        assert (np.abs(found - turn(force)) <= 16 * slack).all(), f"force: off by {np.abs(found - turn(force)).max()}"


JELLY, CLOTH = (750.0, 10.0), (600.0, 3.0)


def main(folder: Path, up: str, scale: float) -> None:
    archive = dict(np.load(folder / "run.npz"))

    def turn(vectors: np.ndarray) -> np.ndarray:
        x, y, z = np.moveaxis(vectors, -1, 0)
        return np.stack([x, -z, y] if up == "z" else [x, y, z], axis=-1)

    positions, velocities = (turn(archive[name]) * np.float32(scale) for name in ("positions", "velocities"))
    time, springs = archive["time"], archive["springs"].astype(np.int64)
    shown = run_ply.Sequence(folder / "run", positions, velocities)
    check_pc2(folder / "run.pc2", shown.positions)
    check_mdd(folder / "run.mdd", shown.positions, time)

    entries = ElementTree.parse(folder / "run.pvd").getroot().findall("Collection/DataSet")
    listed = {(float(entry.get("timestep")), entry.get("name")): entry.get("file") for entry in entries}
    assert sorted({at for at, _ in listed}) == time.tolist(), "times in the collection"
    law = {1000: JELLY, 400: CLOTH}.get(len(archive["mass"]))
    for frame, at in enumerate(time.tolist()):
        surface = read_vtp(folder / listed[at, "surface"])
        skin = vtk_to_numpy(surface.GetPointData().GetArray("point"))
        # Vertices that are no points are those of the one body there is then, and the first of all.
        place = np.where(skin < 0, np.arange(len(skin)), shown.vertex_of[skin])
        check_vtp(surface, shown.positions[frame, place], shown.velocities[frame, place], at)
        points = read_vtp(folder / listed[at, "points"])
        check_vtp(points, positions[frame], velocities[frame], at)
        if points.GetNumberOfLines() and law is None:  # springs that are not all alike
            lines = vtk_to_numpy(points.GetLines().GetConnectivityArray()).reshape(-1, 2)
            assert (lines == springs).all(), "springs in VTK"
        elif points.GetNumberOfLines():
            check_springs(points, archive, frame, turn, law)
        else:
            assert points.GetNumberOfVerts() == len(archive["mass"]), "without springs each point is a cell"
        faces = [place[corners] for corners in polygons_of(surface)]
        check_obj(folder / f"run.{frame:04}.obj", shown.positions[frame], faces)
        ply, edges = folder / f"run.{frame:04}.ply", shown.vertex_of[springs]
        check_ply(ply, shown.positions[frame], shown.velocities[frame], faces, edges)
    count = len(time) * len(shown.point)
    print(f"{len(time)} frames, {count} vertices: .pc2, .mdd, .obj, .ply and .vtp hold the run's numbers")


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2], float(sys.argv[3]))
