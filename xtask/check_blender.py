"""Opens what one run wrote in Blender, steps through it, and compares every vertex with the run's NumPy archive.

Run by `cargo xtask blender` as: check_blender.py FOLDER, where FOLDER holds run.npz, run.pc2, run.mdd and the sequences
run.NNNN.obj and run.NNNN.ply of the same run, written with `--up z`. It does what docs/export.md says to click. A vertex that
is no point is held against the .ply, as it is in no archive.
"""

import sys
from pathlib import Path

import bpy
import numpy as np
import run_ply


def vertices(mesh: bpy.types.Mesh) -> np.ndarray:
    found = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", found)
    return found.reshape(-1, 3)


def same(found: np.ndarray, expected: np.ndarray, what: str) -> None:
    assert found.shape == expected.shape, f"{what}: {found.shape}, and not {expected.shape}"
    assert (found == expected).all(), f"{what}: differs by up to {np.abs(found - expected).max()}"


def opened(path: Path) -> bpy.types.Object:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    read = bpy.ops.wm.obj_import if path.suffix == ".obj" else bpy.ops.wm.ply_import
    read(filepath=str(path), forward_axis="Y", up_axis="Z")
    return bpy.context.selected_objects[0]


def main(folder: Path) -> None:
    archive = np.load(folder / "run.npz")

    def turn(vectors: np.ndarray) -> np.ndarray:
        x, y, z = np.moveaxis(vectors, -1, 0)
        return np.stack([x, -z, y], axis=-1)

    shown = run_ply.Sequence(folder / "run", turn(archive["positions"]), turn(archive["velocities"]))
    positions = shown.positions
    frames = len(positions)

    for ending in (".obj", ".ply"):
        for frame in range(frames):
            thing = opened(folder / f"run.{frame:04}{ending}")
            same(vertices(thing.data), positions[frame], f"frame {frame} of {ending}")
            run_ply.same_faces([face.vertices for face in thing.data.polygons], shown.faces, f"{frame} of {ending}")
            # The importer's turn is a matrix of the object: this one is none.
            assert np.allclose(thing.matrix_world, np.eye(4), atol=1e-6), thing.matrix_world

    for ending in (".pc2", ".mdd"):
        thing = opened(folder / "run.0000.obj")
        cache = thing.modifiers.new("motion", "MESH_CACHE")
        cache.cache_format = ending[1:].upper()
        cache.filepath = str(folder / f"run{ending}")
        cache.frame_start = 0
        for frame in range(frames):
            bpy.context.scene.frame_set(frame)
            evaluated = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
            same(vertices(evaluated.data), positions[frame], f"frame {frame} of {ending}")

    count = positions.shape[0] * positions.shape[1]
    version = bpy.app.version_string
    print(f"{frames} frames, {count} vertices: Blender {version} shows .obj, .ply, .pc2 and .mdd where the run has them")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
