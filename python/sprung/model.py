"""Points and springs in code, from arrays."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _engine
from .errors import refusal

if TYPE_CHECKING:
    from .simulation import Simulation

__all__ = ["Lattice", "Model", "Plane", "chain", "connect_between", "connect_within", "grid", "lattice"]

#: Standard gravity, m/s².
GRAVITY = (0.0, -9.81, 0.0)
#: Springs that are made at most, unless more are allowed.
MAX_SPRINGS = 20_000_000


@dataclass(frozen=True)
class Plane:
    """The ground: a point that sinks in is pushed back out.

    Say ``y`` for a level one, or ``point`` (m) and ``normal``, the direction out of the ground, of any length.

    >>> import sprung
    >>> sprung.Plane(y=-12, stiffness=500, damping=5).point
    (0.0, -12, 0.0)
    """

    #: Height of a level plane, m.
    y: float | None = None
    #: Push for each metre of depth, for each point, N/m.
    stiffness: float = 0.0
    #: Push against the speed of sinking in, for each point, N·s/m.
    damping: float = 0.0
    #: Any point of it, m.
    point: tuple[float, float, float] = (0.0, 0.0, 0.0)
    #: The direction out of the ground.
    normal: tuple[float, float, float] = (0.0, 1.0, 0.0)
    #: ``"push"`` never pulls; ``"report"`` is the report's law, which near lift-off can hold a point down.
    law: str = "push"

    def __post_init__(self) -> None:
        if self.y is not None:
            object.__setattr__(self, "point", (0.0, self.y, 0.0))


@dataclass(frozen=True)
class Lattice:
    """Points in a row, a sheet or a block, and the springs between neighbours.

    >>> import sprung
    >>> cloth = sprung.grid(3, 2, spacing=1)
    >>> cloth.positions.shape, cloth.structural.shape, cloth.triangles.shape
    ((6, 3), (7, 2), (4, 3))
    >>> cloth.sides[:4]
    ('left', 'right', 'back', 'front')
    """

    #: Positions, (n, 3), m.
    positions: NDArray[np.float64]
    #: Pairs of neighbours along the axes, (m, 2).
    structural: NDArray[np.uint32]
    #: Pairs across squares and cubes.
    shear: NDArray[np.uint32]
    #: Pairs two apart along the axes.
    bend: NDArray[np.uint32]
    #: Its surface, (t, 3); none of a row.
    triangles: NDArray[np.uint32]
    #: The names that :meth:`side` takes.
    sides: tuple[str, ...]
    #: How many points along x, y and z.
    counts: tuple[int, int, int]

    def springs(self, *kinds: str) -> NDArray[np.uint32]:
        """Pairs of points of these kinds, in turn: ``"structural"``, ``"shear"``, ``"bend"``; all without any.

        >>> import sprung
        >>> sprung.grid(2, 2, spacing=1).springs("shear").tolist()
        [[0, 3], [1, 2]]
        """
        return np.concatenate([getattr(self, kind) for kind in kinds or ("structural", "shear", "bend")])

    def side(self, name: str) -> NDArray[np.uint32]:
        """The points of a side, by its name.

        >>> import sprung
        >>> sprung.grid(3, 2, spacing=1).side("left").tolist()
        [0, 1]
        """
        return _engine.lattice_side(self.counts, name)


def lattice(x: int, y: int, z: int, *, spacing: float, origin: ArrayLike = (0, 0, 0)) -> Lattice:
    """A block of so many points along each axis, ``spacing`` m apart; the first is at ``origin``. The last axis counts fastest.

    >>> import sprung
    >>> sprung.lattice(4, 4, 4, spacing=0.5).positions.shape
    (64, 3)
    """
    return _lattice(_engine.lattice((x, y, z), spacing, origin), (x, y, z))


def grid(x: int, y: int, *, spacing: float, plane: str = "xz", origin: ArrayLike = (0, 0, 0)) -> Lattice:
    """A flat sheet along the two axes that ``plane`` names: ``"xz"`` (level), ``"xy"`` or ``"yz"`` (upright).

    >>> import sprung
    >>> cloth = sprung.grid(20, 20, spacing=0.1)
    >>> cloth.springs("structural", "shear").shape
    (1482, 2)
    """
    if plane not in ("xz", "xy", "yz"):
        raise refusal("plane", f'is "{plane}", and must be "xz", "xy" or "yz"')
    along = dict(zip(plane, (x, y), strict=True))
    return lattice(along.get("x", 1), along.get("y", 1), along.get("z", 1), spacing=spacing, origin=origin)


def chain(points: int, *, step: ArrayLike, origin: ArrayLike = (0, 0, 0)) -> Lattice:
    """Points in a row, each a ``step`` (m) from the one before.

    >>> import sprung
    >>> sprung.chain(3, step=[0.5, 0, 0]).positions[:, 0].tolist()
    [0.0, 0.5, 1.0]
    """
    return _lattice(_engine.chain(points, step, origin), (points, 1, 1))


def connect_within(
    positions: ArrayLike, radius: float, *, max_springs: int = MAX_SPRINGS
) -> NDArray[np.uint32]:
    """All pairs i < j of points no further apart than ``radius`` (m), (m, 2), in the order of the double loop.

    >>> import sprung
    >>> sprung.connect_within([[0, 0, 0], [1, 0, 0], [2, 0, 0]], 1).tolist()
    [[0, 1], [1, 2]]
    """
    return _engine.connect_within(positions, radius, max_springs)


def connect_between(
    a: ArrayLike, b: ArrayLike, radius: float, *, max_springs: int = MAX_SPRINGS
) -> NDArray[np.uint32]:
    """All pairs of a point of ``a`` and one of ``b`` no further apart than ``radius`` (m), (m, 2), by the index in each.

    >>> import sprung
    >>> sprung.connect_between([[0, 0, 0]], [[5, 0, 0], [0, 1, 0]], 2).tolist()
    [[0, 1]]
    """
    return _engine.connect_between(a, b, radius, max_springs)


class Model(_engine.Model):
    """Points and springs, and how they begin. It never changes.

    ``positions`` is (n, 3), m; ``mass`` one number or (n,), kg, where zero fixes a point in space; ``springs`` (m, 2) pairs of
    points. ``stiffness`` (N/m), ``damping`` (N·s/m) and ``rest_lengths`` (m, by default the distances) are one number or (m,),
    ``velocities`` (n, 3), m/s. ``pinned`` are the points that stay, as indices or as a mask; ``triangles`` (t, 3) are drawn and
    exported. ``bodies`` names so many points in turn: ``{"rope": 20, "sail": 400}``; springs then stand body by body, and those
    between bodies come last.

    >>> import sprung
    >>> cloth = sprung.grid(20, 20, spacing=0.1)
    >>> model = sprung.Model(
    ...     cloth.positions, 0.01, cloth.springs(), stiffness=80, damping=0.05,
    ...     pinned=cloth.side("left"), triangles=cloth.triangles,
    ... )
    >>> model.simulation().run(1).positions.shape[1:]
    (400, 3)
    """

    _arguments: dict[str, Any]

    def __new__(
        cls,
        positions: ArrayLike,
        mass: ArrayLike,
        springs: ArrayLike = (),
        *,
        stiffness: ArrayLike = 0.0,
        damping: ArrayLike = 0.0,
        rest_lengths: ArrayLike | None = None,
        velocities: ArrayLike | None = None,
        pinned: ArrayLike | None = None,
        triangles: ArrayLike | None = None,
        bodies: Mapping[str, int] | None = None,
        title: str = "",
    ) -> Model:
        arguments: dict[str, Any] = {
            "stiffness": stiffness,
            "damping": damping,
            "rest_lengths": rest_lengths,
            "velocities": velocities,
            "pinned": pinned,
            "triangles": triangles,
            "title": title,
        }
        try:
            count = np.shape(positions)[0] if np.ndim(positions) else 0
        except ValueError:  # a list of lists of different lengths, of which more below
            count = 0
        named = list(bodies.items()) if bodies is not None else [("body", count)]
        made = super().__new__(cls, positions, mass, springs, bodies=named, **arguments)
        # What pickle makes it of again: copies, as an array may be written to.
        arguments = {"positions": positions, "mass": mass, "springs": springs, **arguments, "bodies": bodies}
        made._arguments = {
            key: np.array(value) if isinstance(value, np.ndarray) else value for key, value in arguments.items()
        }
        return made

    def simulation(
        self,
        *,
        dt: float | Literal["auto"] = "auto",
        substeps: int = 1,
        gravity: ArrayLike = GRAVITY,
        planes: Sequence[Plane] = (),
        threads: int | None = None,
    ) -> Simulation:
        """A simulation of it: ``dt`` in s, or the largest that is safely stable, ``gravity`` in m/s².

        >>> import sprung
        >>> rope = sprung.chain(11, step=[0.1, 0, 0])
        >>> model = sprung.Model(rope.positions, 0.01, rope.structural, stiffness=100, damping=0.1, pinned=[0])
        >>> swing = model.simulation(dt=1e-3, planes=[sprung.Plane(y=-0.5, stiffness=100, damping=0.1)])
        >>> swing.step(1000)
        >>> swing.time
        1.0
        """
        from .simulation import Simulation

        return Simulation(
            self, dt=dt, substeps=substeps, gravity=gravity, planes=planes_of(planes), threads=threads
        )

    def __reduce__(self) -> tuple[Any, ...]:
        return _unpickled, (type(self), self._arguments)

    def __repr__(self) -> str:
        named = f" {self.title!r}" if self.title else ""
        return f"<sprung.Model{named}: {self.point_count} points, {self.spring_count} springs>"


def planes_of(planes: Sequence[Plane]) -> list[Plane]:
    """The same, if they are planes."""
    if isinstance(planes, Plane):
        raise TypeError("planes are a list of sprung.Plane: put it in brackets")
    for plane in planes:
        if not isinstance(plane, Plane):
            raise TypeError(f"planes are a list of sprung.Plane, and no {type(plane).__name__}")
    return list(planes)


def _unpickled(make: type[Model], arguments: dict[str, Any]) -> Model:
    return make(**arguments)


def _lattice(parts: Any, counts: tuple[int, int, int]) -> Lattice:
    positions, (structural, shear, bend), triangles, sides = parts
    return Lattice(positions, structural, shear, bend, triangles, tuple(sides), counts)
