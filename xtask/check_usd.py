"""Opens USD files with OpenUSD itself and holds them against the NumPy archive of the same run.

    python check_usd.py RUN.npz TITLE UP UNITS_PER_METRE FRAME_TIME FILE...

Every vertex of every time sample must have the archive's bits, metadata must be there and right, and OpenUSD's own validators
must have nothing to say. `primvars:point` says which point a vertex is; points that no surface has may be missing. A prim without
it is a mesh that points carry along, and held against RUN.NNNN.ply, written with the same options.
"""

import sys
from pathlib import Path

import numpy as np
import run_ply
from pxr import Sdf, Usd, UsdGeom, UsdValidation

TURNED = {"Y": lambda v: v, "Z": lambda v: np.stack([v[..., 0], -v[..., 2], v[..., 1]], axis=-1)}


def same(found, expected, what):
    found, expected = np.ascontiguousarray(found), np.ascontiguousarray(expected)
    assert found.shape == expected.shape, f"{what}: {found.shape}, and not {expected.shape}"
    assert found.dtype == expected.dtype, f"{what}: {found.dtype}, and not {expected.dtype}"
    assert found.tobytes() == expected.tobytes(), f"{what} differs"


def sample(attribute, time):
    return np.array(attribute.Get(time))


def faces_of(mesh):
    counts = np.array(mesh.GetFaceVertexCountsAttr().Get())
    return np.split(np.array(mesh.GetFaceVertexIndicesAttr().Get()), counts.cumsum()[:-1])


def check_normals(mesh, points, time, what):
    """Of length one, and the mean of the triangles' around, as far as rounding lets them."""
    corners = run_ply.triangles(faces_of(mesh))
    a, b, c = (points[corners[:, k]].astype(np.float64) for k in range(3))
    across = np.cross(b - a, c - a)
    expected = np.zeros(points.shape)
    for k in range(3):
        np.add.at(expected, corners[:, k], across)
    length = np.linalg.norm(expected, axis=1, keepdims=True)
    found = sample(mesh.GetNormalsAttr(), time)
    assert len(found) == len(points), f"{what}: {len(found)} normals"
    some = length[:, 0] > 0
    # A sum of a few float32 vectors, each with an error of a few units in the last place of its largest term.
    around = np.zeros(len(points))
    size = np.linalg.norm(across, axis=1) + np.abs(points).max() ** 2 * 2.0**-20
    for k in range(3):
        np.add.at(around, corners[:, k], size)
    tolerance = 64 * 2.0**-23 * np.maximum(1, around / np.maximum(length[:, 0], 1e-30))
    off = np.linalg.norm(found - expected / np.maximum(length, 1e-30), axis=1)
    clear = some & (tolerance < 0.1)
    assert (off[clear] <= tolerance[clear]).all(), f"{what}: normals are off by {off[clear].max()}"


def check(path, run, archive, title, up, scale, frame_time):
    stage = Usd.Stage.Open(path)
    frames, points, _ = archive["positions"].shape
    assert UsdGeom.GetStageUpAxis(stage) == up
    assert UsdGeom.GetStageMetersPerUnit(stage) == 1 / scale
    assert stage.HasAuthoredTimeCodeRange()
    assert stage.GetStartTimeCode() == 0 and stage.GetEndTimeCode() == frames - 1
    assert abs(stage.GetTimeCodesPerSecond() * frame_time - 1) < 1e-9
    assert stage.GetFramesPerSecond() == stage.GetTimeCodesPerSecond()
    root = stage.GetDefaultPrim()
    assert root.IsValid() and len(stage.GetPseudoRoot().GetChildren()) == 1

    scaled = np.float32(scale)
    positions, velocities = (TURNED[up](archive[name]) * scaled for name in ("positions", "velocities"))
    codes = [float(frame) for frame in range(frames)]
    left, vertices, carried = set(range(points)), 0, 0
    for prim in root.GetChildren():
        motion = positions, velocities
        based = UsdGeom.PointBased(prim)
        for attribute in (based.GetPointsAttr(), based.GetVelocitiesAttr(), based.GetExtentAttr()):
            assert attribute.GetTimeSamples() == codes, f"{prim.GetPath()}: {attribute.GetTimeSamples()}"
        colour = UsdGeom.Gprim(prim).GetDisplayColorAttr().Get()
        assert len(colour) == 1 and all(0 <= part <= 1 for part in colour[0])
        if prim.GetTypeName() == "BasisCurves":
            assert UsdGeom.BasisCurves(prim).GetTypeAttr().Get() == "linear"
            ends = archive["springs"].reshape(-1)
            assert (np.array(UsdGeom.Curves(prim).GetCurveVertexCountsAttr().Get()) == 2).all()
            chosen = ends
        elif not UsdGeom.PrimvarsAPI(prim).HasPrimvar("point"):
            shown = run_ply.Sequence(Path(run).with_suffix(""), positions, velocities)
            motion = shown.positions, shown.velocities
            # The .ply has them all in the order of the bodies.
            chosen = np.flatnonzero(shown.point < 0)[carried:][: len(sample(based.GetPointsAttr(), 0))]
            carried += len(chosen)
            left.clear()
        else:
            chosen = np.array(UsdGeom.PrimvarsAPI(prim).GetPrimvar("point").Get())
            assert (np.diff(chosen) > 0).all() and left.issuperset(chosen), f"{prim.GetPath()}: {chosen}"
            left.difference_update(chosen)
        if prim.IsA(UsdGeom.Mesh) and Path(run).with_suffix(".0000.ply").exists():
            # There is one mesh then.
            _, _, faces = run_ply.read(Path(run).with_suffix(".0000.ply"))
            run_ply.same_faces(faces_of(UsdGeom.Mesh(prim)), faces, f"{path}{prim.GetPath()}")
        for frame in range(frames):
            what = f"{path}{prim.GetPath()} at {frame}"
            found = sample(based.GetPointsAttr(), frame)
            same(found, motion[0][frame, chosen], what)
            same(sample(based.GetVelocitiesAttr(), frame), motion[1][frame, chosen], what)
            low, high = sample(based.GetExtentAttr(), frame)
            margin = 0
            if not prim.IsA(UsdGeom.Mesh):
                curve_or_points = UsdGeom.Curves(prim) if prim.IsA(UsdGeom.Curves) else UsdGeom.Points(prim)
                margin = np.float32(curve_or_points.GetWidthsAttr().Get()[0]) / 2
            same(low, found.min(axis=0) - np.float32(margin), what)
            same(high, found.max(axis=0) + np.float32(margin), what)
            if prim.IsA(UsdGeom.Mesh):
                check_normals(UsdGeom.Mesh(prim), found, frame, what)
            vertices += len(found)
    check_rules(stage, path, title)
    inside = f"; {len(left)} points lie inside" if left else ""
    print(f"{path}: {vertices} vertices in {frames} time samples have the bits of the run{inside}")


def check_rules(stage, path, title):
    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    errors = UsdValidation.ValidationContext(validators).Validate(stage)
    said = [f"{error.GetName()}: {error.GetMessage()}" for error in errors]
    assert not said, f"{path}: {said}"
    layer = Sdf.Layer.FindOrOpen(path)
    assert layer.documentation.startswith(f"{title}, simulated by sprung"), layer.documentation


def main():
    run, title, up, scale, frame_time, *paths = sys.argv[1:]
    archive = np.load(run)
    for path in paths:
        check(path, run, archive, title, up, float(scale), float(frame_time))


main()
