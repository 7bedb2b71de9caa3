"""Mass-spring animation: physical, fast, and the same bits everywhere.

    import sprung

    jelly = sprung.scene("jelly").simulation()
    fall = jelly.run(3, fps=25)  # seconds
    fall.save("jelly.gif")
    print(fall.positions.shape)  # frames, points, x y z

A *scene* (a small TOML file, or one that is built in: :func:`scenes`) or a *model* (arrays: :class:`Model`) becomes a
*simulation*, which steps; what it runs through is a *trajectory*, which plots, animates and exports. Units are SI, +y is up.
When something is wrong an :class:`Error` says what, where, and what would mend it; a simulation that explodes raises
:class:`BlowUp`, which says why.

``python -m sprung`` is the command ``sprung`` without its window.
"""

from __future__ import annotations

import os as _os

from . import _engine
from ._engine import EXPORTERS, __version__
from .errors import BlowUp, Error
from .model import Lattice, Model, Plane, chain, connect_between, connect_within, grid, lattice
from .scene import BuiltinScene, Scene, View, from_mesh, scene, scenes
from .simulation import Body, Energy, Joint, Limit, Simulation, Stability, Surface, load
from .sweep import MEASURES, BuiltinMeasure, sweep
from .trajectory import Animation, Trajectory

__all__ = [
    "EXPORTERS",
    "MEASURES",
    "Animation",
    "BlowUp",
    "Body",
    "BuiltinMeasure",
    "BuiltinScene",
    "Energy",
    "Error",
    "Joint",
    "Lattice",
    "Limit",
    "Model",
    "Plane",
    "Scene",
    "Simulation",
    "Stability",
    "Surface",
    "Trajectory",
    "View",
    "__version__",
    "chain",
    "connect_between",
    "connect_within",
    "from_mesh",
    "grid",
    "lattice",
    "load",
    "scene",
    "scenes",
    "sweep",
]

for _public in (BlowUp, Error, Scene, Model, Plane, Lattice, Simulation, Trajectory, Animation, View):
    _public.__module__ = "sprung"
for _public_function in (chain, connect_between, connect_within, from_mesh, grid, lattice, load, scene, scenes, sweep):
    _public_function.__module__ = "sprung"

# The engine's threads do not come along into a process that is forked off.
if hasattr(_os, "register_at_fork"):
    _os.register_at_fork(after_in_child=_engine.after_fork)
