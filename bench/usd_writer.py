"""Writes what a .usdc of ours holds again with OpenUSD's own writer, and says how long that takes.

    cargo run --release -p sprung-io --example export_speed -- FOLDER
    python bench/usd_writer.py FOLDER       # with usd-core and NumPy

The arrays are read before the clock starts. As a program that has a frame after the other would, each is set with
`Attribute.Set` at its time; then the layer is saved, and flushed to the disk as ours is. The fastest of three tries counts.
"""

import os
import sys
import time

import numpy as np
from pxr import Sdf, Usd, Vt


def values(stage):
    """Each attribute with its samples, as arrays that no file is behind."""
    found = []
    for prim in stage.Traverse():
        for attribute in prim.GetAttributes():
            samples = attribute.GetTimeSamples()
            if samples:
                arrays = [Vt.Vec3fArray.FromNumpy(np.array(attribute.Get(t))) for t in samples]
                found.append((attribute.GetPath(), samples, arrays))
    return found


def main(folder):
    ours = os.path.join(folder, "usdc", "cloth.usdc")
    theirs = os.path.join(folder, "theirs.usdc")
    held = values(Usd.Stage.Open(ours))
    best = float("inf")
    for _ in range(3):
        # The static part is there already: names, topology, metadata.
        source = Sdf.Layer.OpenAsAnonymous(ours)
        for path, samples, _arrays in held:
            for code in samples:
                source.EraseTimeSample(path, code)
        if os.path.exists(theirs):
            os.remove(theirs)
        start = time.perf_counter()
        layer = Sdf.Layer.CreateNew(theirs)
        layer.TransferContent(source)
        stage = Usd.Stage.Open(layer)
        attributes = [stage.GetAttributeAtPath(path) for path, *_ in held]
        for frame, code in enumerate(held[0][1]):
            for attribute, (_path, _samples, arrays) in zip(attributes, held):
                attribute.Set(arrays[frame], code)
        layer.Save()
        with open(theirs, "rb+") as file:
            os.fsync(file.fileno())
        best = min(best, time.perf_counter() - start)
        del stage, layer
    size = os.path.getsize(theirs) / 1e6
    frames = len(held[0][1])
    print(f"OpenUSD {Usd.GetVersion()}: {size:.1f} MB, {size / best:.0f} MB/s, {frames / best:.0f} frames/s")


main(sys.argv[1])
