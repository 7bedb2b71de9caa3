"""Imports files into Blender, steps to every frame, and holds each vertex against the NumPy archive of the same run.

    python check_blender_usd.py RUN.npz FRAME_TIME PICTURE.png FILE...

Python must have Blender as a module: `pip install bpy`. PICTURE shows the last frame of the first file, drawn by Cycles; with
`-` none is drawn. If RUN.NNNN.ply are there, vertices that are no points are held against them. Z is up in Blender, and its importers say so by turning the object (USD) or the vertices (glTF).
"""

import sys
from pathlib import Path

import bpy
import numpy as np
import run_ply


def load(path, frame_time):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    if path.endswith(".glb"):
        bpy.ops.import_scene.gltf(filepath=path)
    else:
        bpy.ops.wm.usd_import(filepath=path)
        assert scene.frame_start == 0
    return [o for o in scene.objects if o.type in ("MESH", "POINTCLOUD", "CURVES")]


def vertices(thing, graph):
    """Of a thing as it is at the current frame, in its own axes."""
    data = thing.evaluated_get(graph).data
    positions = data.attributes["position"].data
    found = np.empty(3 * len(positions), np.float32)
    positions.foreach_get("vector", found)
    return found.reshape(-1, 3)


def points_of(thing, found, first, place_of, is_gltf):
    """The place in `first` of each vertex: by the point that the file says it is, or else by where it is in the first frame."""
    if "point" in thing.data.attributes:
        numbers = thing.data.attributes["point"].data
        points = np.empty(len(numbers), np.int32)
        numbers.foreach_get("value", points)
        return place_of[points]
    # Plus zero, as a turned zero may have another sign. No two points are in one place then.
    point_at = {tuple(position + 0.0): point for point, position in enumerate(first)}
    upright = np.stack([found[:, 0], found[:, 2], -found[:, 1]], axis=1) if is_gltf else found
    return np.array([point_at[tuple(position + 0.0)] for position in upright])


def check(path, run, archive, frame_time):
    things = load(path, frame_time)
    positions, springs = archive["positions"], archive["springs"]
    place_of = np.arange(positions.shape[1])
    if Path(run).with_suffix(".0000.ply").exists():
        # All of the vertices in their order stand for the points.
        sequence = run_ply.Sequence(Path(run).with_suffix(""), positions, archive["velocities"])
        positions, springs, place_of = sequence.positions, sequence.edges, sequence.vertex_of
    frames = len(positions)
    is_gltf = path.endswith(".glb")
    # A sample of USD is a frame of Blender's, whatever the rates; a key of glTF lies where its time is.
    frames_apart = frame_time * bpy.context.scene.render.fps if is_gltf else 1.0
    if is_gltf and frames > 1:
        (action,) = bpy.data.actions
        assert abs(action.frame_range[1] - (frames - 1) * frames_apart) < 1e-3, action.frame_range
    count = worst = 0.0
    points = {}
    for frame in range(frames):
        whole, part = divmod(frame * frames_apart, 1)
        bpy.context.scene.frame_set(int(whole), subframe=part)
        graph = bpy.context.evaluated_depsgraph_get()
        for thing in things:
            found = vertices(thing, graph)
            turned = np.array(thing.matrix_world.to_3x3())
            if frame == 0:
                is_curves = thing.type == "CURVES"
                points[thing] = springs.reshape(-1) if is_curves else points_of(
                    thing, found, positions[0], place_of, is_gltf
                )
            chosen = positions[frame, points[thing]]
            if is_gltf:
                # Vertices are turned, and are sums of two float32, rounded twice, here of all weights and their shapes.
                assert (turned == np.eye(3)).all()
                expected = np.stack([chosen[:, 0], -chosen[:, 2], chosen[:, 1]], axis=1)
                motion = np.abs(positions - positions[0]).max()
                # The weights of a frame are found by its time, to a few units in the last place of that.
                allowed = 2.0**-24 * (np.abs(expected) + motion) + 4 * frames * 2.0**-24 * motion
            else:
                assert np.abs(turned - [[1, 0, 0], [0, 0, -1], [0, 1, 0]]).max() < 1e-6, turned
                expected, allowed = chosen, np.zeros_like(chosen)
            off = np.abs(found - expected)
            assert off.shape == allowed.shape, f"{path}: {len(found)} vertices"
            assert (off <= allowed).all(), f"{path}: {thing.name} at {frame} is off by {off.max()}"
            worst = max(worst, off.max())
            count += len(found)
    print(f"{path}: {int(count)} vertices in {frames} frames, the worst off by {worst:.1e}")


def draw(path, frame_time, picture):
    """The last frame of a file, from in front and above."""
    things = load(path, frame_time)
    scene = bpy.context.scene
    scene.frame_set(scene.frame_end)
    graph = bpy.context.evaluated_depsgraph_get()
    in_space = [
        vertices(t, graph) @ np.array(t.matrix_world.to_3x3()).T for t in things
    ]
    low, high = np.concatenate(in_space).min(axis=0), np.concatenate(in_space).max(axis=0)
    middle, size = (low + high) / 2, np.linalg.norm(high - low)

    material = bpy.data.materials.new("displayColor")
    material.use_nodes = True
    shader = material.node_tree.nodes["Principled BSDF"]
    colour = material.node_tree.nodes.new("ShaderNodeAttribute")
    colour.attribute_name = "displayColor"
    material.node_tree.links.new(colour.outputs["Color"], shader.inputs["Base Color"])
    for thing in things:
        thing.data.materials.clear()
        thing.data.materials.append(material)

    eye = middle + size * np.array([0.8, -1.6, 0.6])
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    target = bpy.data.objects.new("target", None)
    camera.location, target.location = eye, middle
    track = camera.constraints.new("TRACK_TO")
    track.target = target
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    sun.data.energy, sun.rotation_euler = 3.0, (0.7, 0.2, 0.3)
    for thing in (camera, target, sun):
        scene.collection.objects.link(thing)
    scene.camera = camera
    scene.world = bpy.data.worlds.new("world")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.8, 0.85, 0.9, 1)
    scene.render.engine = "CYCLES"
    scene.cycles.device, scene.cycles.samples = "CPU", 16
    scene.render.resolution_x, scene.render.resolution_y = 640, 400
    scene.render.filepath = picture
    bpy.ops.render.render(write_still=True)


def main():
    run, frame_time, picture, *paths = sys.argv[1:]
    archive = np.load(run)
    for path in paths:
        check(path, run, archive, float(frame_time))
    if picture != "-":
        draw(paths[0], float(frame_time), picture)


main()
