"""Compares a table and a NumPy archive of the same run: the same numbers, to the bit.

Run by `cargo xtask numpy` as: check_outputs.py RUN.csv RUN.npz
"""

import sys

import numpy as np


def main(table_path: str, archive_path: str) -> None:
    archive = np.load(archive_path)
    assert set(archive.files) == {"time", "positions", "velocities", "springs", "mass"}, archive.files

    time, springs, mass = archive["time"], archive["springs"], archive["mass"]
    positions, velocities = archive["positions"], archive["velocities"]
    frames, points = len(time), len(mass)
    expected = {
        "time": ((frames,), np.float64),
        "positions": ((frames, points, 3), np.float32),
        "velocities": ((frames, points, 3), np.float32),
        "springs": ((len(springs), 2), np.uint32),
        "mass": ((points,), np.float32),
    }
    for name, (shape, kind) in expected.items():
        array = archive[name]
        assert array.shape == shape and array.dtype == kind, f"{name}: {array.shape} {array.dtype}"
    assert (springs[:, 0] < springs[:, 1]).all() and springs.max() < points

    with open(table_path, encoding="ascii") as file:
        assert file.readline() == "frame,time,point,x,y,z,vx,vy,vz\n"
        rows = [line.rstrip("\n").split(",") for line in file]
    assert len(rows) == frames * points, f"{len(rows)} rows for {frames} frames of {points} points"
    numbers = np.array([[np.float32(cell) for cell in row[3:]] for row in rows])
    numbers = numbers.reshape(frames, points, 6)
    assert (numbers[..., :3].view(np.uint32) == positions.view(np.uint32)).all(), "positions differ"
    assert (numbers[..., 3:].view(np.uint32) == velocities.view(np.uint32)).all(), "velocities differ"
    assert [int(row[0]) for row in rows] == [frame for frame in range(frames) for _ in range(points)]
    assert [int(row[2]) for row in rows] == list(range(points)) * frames
    assert [float(row[1]) for row in rows[::points]] == time.tolist()
    print(f"{frames} frames of {points} points and {len(springs)} springs: the table and the archive agree")


if __name__ == "__main__":
    main(*sys.argv[1:])
