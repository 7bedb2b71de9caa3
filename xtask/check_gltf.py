"""Plays glTF files and holds them against the NumPy archive of the same run.

    python check_gltf.py RUN.npz FRAME_TIME SHOWN FILE...

SHOWN is `clip`, or the number of the one frame that the files hold. The first shape must have the archive's bits; others are
sums of two float32 and may be off by the rounding of the difference and of the sum. If RUN.NNNN.ply are there, written with the
same options, vertices are held against theirs: a mesh that points carry along has vertices that are no points.
"""

import sys
from pathlib import Path

import numpy as np
import pygltflib
import run_ply
import trimesh

HALF_ULP = 2.0**-24
KINDS = {5126: np.float32, 5125: np.uint32}
WIDTHS = {"SCALAR": 1, "VEC3": 3}


def array(gltf, number):
    accessor = gltf.accessors[number]
    view = gltf.bufferViews[accessor.bufferView]
    width = WIDTHS[accessor.type]
    start = view.byteOffset + (accessor.byteOffset or 0)
    assert view.byteStride in (None, 4 * width)
    found = np.frombuffer(gltf.binary_blob(), KINDS[accessor.componentType], accessor.count * width, start)
    found = found.reshape(accessor.count, width)
    if accessor.min:
        assert (np.float32(accessor.min) == found.min(axis=0)).all(), f"accessor {number}: min"
        assert (np.float32(accessor.max) == found.max(axis=0)).all(), f"accessor {number}: max"
    return found


def weights_at(gltf, node, frames, frame_time):
    """What the animation says of a node, frame by frame."""
    if frames == 1:
        assert not gltf.animations
        return np.zeros((1, 0), np.float32)
    (animation,) = gltf.animations
    (channel,) = (c for c in animation.channels if c.target.node == node)
    assert channel.target.path == "weights"
    sampler = animation.samplers[channel.sampler]
    assert sampler.interpolation == "LINEAR"
    times = array(gltf, sampler.input)[:, 0]
    expected = (np.arange(frames) * frame_time).astype(np.float32)
    assert len(times) == frames and np.abs(times - expected).max() <= np.spacing(expected[-1]), "times"
    return array(gltf, sampler.output).reshape(frames, frames - 1)


def check(path, run, archive, frame_time, shown):
    gltf = pygltflib.GLTF2().load(path)
    positions, springs = archive["positions"], archive["springs"]
    points = positions.shape[1]
    has_ply = Path(run).with_suffix(".0000.ply").exists()
    if has_ply:
        # All of the vertices in their order stand for the points.
        sequence = run_ply.Sequence(Path(run).with_suffix(""), positions, archive["velocities"])
        positions, springs = sequence.positions, sequence.edges
        points = positions.shape[1]
    if shown != "clip":
        positions = positions[[int(shown)]]
    frames = len(positions)
    (scene,) = gltf.scenes
    # Which point a vertex is follows from where it is in the first frame, in which no two points are in one place; of the
    # vertices of a .ply two may be, but there they are all in the order of the meshes.
    point_at = {position.tobytes(): point for point, position in enumerate(positions[0])}
    assert has_ply or len(point_at) == points
    left, vertices, worst = set(range(points)), 0, 0.0
    for number in scene.nodes:
        node = gltf.nodes[number]
        (primitive,) = gltf.meshes[node.mesh].primitives
        indices = None if primitive.indices is None else array(gltf, primitive.indices)[:, 0]
        base = array(gltf, primitive.attributes.POSITION)
        if has_ply:
            chosen = np.arange(points) if primitive.mode == 1 else min(left) + np.arange(len(base))
        else:
            chosen = np.array([point_at[position.tobytes()] for position in base])
        assert (np.diff(chosen) > 0).all(), f"{path}: the vertices of {node.name} are out of order"
        if primitive.mode == 1:
            assert (indices.reshape(-1, 2) == springs).all(), f"{path}: springs"
            left.clear()
        else:
            assert left.issuperset(chosen)
            left.difference_update(chosen)
        shapes = [array(gltf, target["POSITION"]) for target in primitive.targets or []]
        for frame, weights in enumerate(weights_at(gltf, number, frames, frame_time)):
            found = base.copy()
            for weight, shape in zip(weights, shapes):
                found += np.float32(weight) * shape
            expected = positions[frame, chosen].astype(np.float64)
            allowed = HALF_ULP * (np.abs(expected - base) + np.abs(expected)) * (1 + 2.0**-20)
            off = np.abs(found - expected)
            assert (off <= allowed).all(), f"{path}: frame {frame} is off by {off.max()}"
            if frame == 0:
                assert off.max() == 0
            worst = max(worst, off.max())
            vertices += len(found)
        if primitive.attributes.NORMAL is not None:
            normals = array(gltf, primitive.attributes.NORMAL)
            assert np.abs(np.linalg.norm(normals, axis=1) - 1).max() < 1e-6

    # Another reader, which knows no shapes that are blended: the first frame.
    for geometry in trimesh.load(path, process=False, maintain_order=True).geometry.values():
        if isinstance(geometry, trimesh.Trimesh):
            found = geometry.vertices.astype(np.float32)
            assert all(position.tobytes() in point_at for position in found), f"{path}: trimesh reads other vertices"
    inside = f"; {len(left)} points lie inside" if left else ""
    print(f"{path}: {vertices} vertices in {frames} frames, the worst off by {worst:.1e} m{inside}")


def main():
    run, frame_time, shown, *paths = sys.argv[1:]
    archive = np.load(run)
    for path in paths:
        check(path, run, archive, float(frame_time), shown)


main()
