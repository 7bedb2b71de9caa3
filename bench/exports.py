"""How fast meshio writes the frames that the example export_speed wrote before it, in the formats that both know.

    cargo run --release -p sprung-io --example export_speed -- FOLDER
    python bench/exports.py FOLDER          # with NumPy and meshio

Each file is made to reach the disk before it counts, as sprung's are. The points and triangles are the same; of what else a
file may hold, meshio is given what it takes: velocities in a .vtu.
"""

import os
import sys
import time
from pathlib import Path

import meshio
import numpy as np


def main(folder: Path) -> None:
    archive = np.load(folder / "npz" / "cloth.npz")
    positions, velocities = archive["positions"], archive["velocities"]
    triangles = meshio.read(folder / "obj" / "cloth.0000.obj").get_cells_type("triangle").astype(np.int32)
    out = folder / "meshio"
    out.mkdir(exist_ok=True)
    print("| meshio | MB/frame | frames/s | MB/s |\n|---|---:|---:|---:|")
    for ending, options in [("obj", {}), ("ply", {"binary": True}), ("vtu", {"compression": None})]:
        best, size = float("inf"), 0
        for _ in range(3):
            size, begun = 0, time.perf_counter()
            for frame, points in enumerate(positions):
                fields = {"velocity": velocities[frame]} if ending == "vtu" else {}
                mesh = meshio.Mesh(points, [("triangle", triangles)], point_data=fields)
                path = out / f"cloth.{frame:04}.{ending}"
                mesh.write(path, **options)
                with open(path, "rb+") as file:
                    os.fsync(file.fileno())
                size += path.stat().st_size
            best = min(best, time.perf_counter() - begun)
        megabytes, frames = size / 1e6, len(positions)
        print(f"| `.{ending}` | {megabytes / frames:.1f} | {frames / best:.1f} | {megabytes / best:.0f} |")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
