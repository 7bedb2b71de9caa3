"""A simulation: step, frame, run, change a parameter, look."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Generic, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _engine
from .errors import BlowUp, refusal
from .model import Model, Plane, planes_of
from .scene import Scene
from .trajectory import Trajectory

with warnings.catch_warnings():
    # In a notebook without ipywidgets it says that they are missing; the bar is then one of text.
    warnings.simplefilter("ignore")
    from tqdm.auto import tqdm

__all__ = ["Body", "Energy", "Joint", "Limit", "Simulation", "Stability", "Surface", "load"]

Number = TypeVar("Number", float, NDArray[np.float64])

#: Whether to show a bar: always, never, or (``None``) in a terminal or a notebook for what takes longer than a second.
Progress = bool | None


@dataclass(frozen=True)
class Energy(Generic[Number]):
    """Where the energy is, J, and where it went since the start; for a trajectory an array of each, over time.

    >>> import sprung
    >>> spring = sprung.scene("spring").simulation()
    >>> spring.keeps_ledger = True
    >>> spring.step(1000)
    >>> energy = spring.energy
    >>> books = energy.start + energy.work_in - energy.lost_in_dampers + energy.integrator_error
    >>> abs(energy.total - books) < 1e-4  # J, of rounding
    True
    """

    #: Of the points that forces can move.
    kinetic: Number
    gravitational: Number
    #: In the springs.
    elastic: Number
    #: In the planes that points sink into.
    contact: Number
    #: Kinetic and potential energy at the start.
    start: Number
    #: Put in by external forces, hands and changes of the parameters.
    work_in: Number
    #: The three below are counted only while :attr:`Simulation.keeps_ledger`.
    lost_in_dampers: Number
    lost_in_contact: Number
    #: What the integrator made (positive) or lost of its own.
    integrator_error: Number

    @property
    def potential(self) -> Number:
        """Gravitational, elastic and contact energy, J.

        >>> import sprung
        >>> energy = sprung.scene("jelly").simulation().energy
        >>> energy.potential == energy.gravitational + energy.elastic + energy.contact
        True
        """
        return self.gravitational + self.elastic + self.contact

    @property
    def total(self) -> Number:
        """Kinetic and potential energy, J.

        >>> import sprung
        >>> energy = sprung.scene("jelly").simulation().energy
        >>> energy.total == energy.start
        True
        """
        return self.kinetic + self.potential


@dataclass(frozen=True)
class Limit:
    """How large ``dt`` may be, and what keeps it from being larger.

    >>> import sprung
    >>> limit = sprung.scene("spring").simulation().certified_limit
    >>> limit.set_by, limit.spring, limit.points
    ('spring 0 of pendulum (points 0 and 1)', 0, [0, 1])
    """

    #: The limit, s; infinite where there is none.
    dt: float
    #: What sets it, in words.
    set_by: str
    #: The spring that sets it, if one does.
    spring: int | None
    #: Its points, or the one point whose contact or grab sets it.
    points: list[int]


@dataclass(frozen=True)
class Stability:
    """How large ``dt`` may be: three answers, from exact to safe for ever. See docs/method.md.

    >>> import sprung
    >>> now = sprung.scene("jelly").simulation().stability
    >>> now.every_configuration.dt <= now.certified.dt <= now.sharp
    True
    """

    #: The step length in use, s.
    dt: float
    #: The true limit in this configuration, s, to 0.1 % or better.
    sharp: float
    #: The largest ω², 1/s², and the largest damping for each mass, 1/s, of this configuration.
    omega2_max: float
    c_max: float
    #: A limit that is safe in this configuration.
    certified: Limit
    #: One that holds in whatever shape the springs take.
    every_configuration: Limit

    @property
    def is_stable(self) -> bool:
        """Whether ``dt`` is below the true limit.

        >>> import sprung
        >>> sprung.scene("jelly", {"dt": 0.1}).simulation().stability.is_stable
        False
        """
        return self.dt < self.sharp


@dataclass(frozen=True)
class Body:
    """A body: its points and springs are slices, to take its rows of any array.

    >>> import sprung
    >>> jelly = sprung.scene("jelly").simulation()
    >>> body = jelly.bodies[0]
    >>> body.name, jelly.positions[body.points].shape, jelly.springs[body.springs].shape
    ('jelly', (1000, 3), (7560, 2))
    """

    name: str
    points: slice
    springs: slice


@dataclass(frozen=True)
class Joint:
    """Springs between bodies.

    >>> import sprung
    >>> bridge = sprung.scene("bridge").simulation()
    >>> [joint.name for joint in bridge.joints][:2]
    ['west post - deck', 'east post - deck']
    """

    name: str
    springs: slice


@dataclass(frozen=True)
class Surface:
    """A surface that is drawn and exported, as it is now.

    >>> import sprung
    >>> skin = sprung.scene("jelly").simulation().surfaces[0]
    >>> skin.body, skin.kind, skin.triangles.shape[1]
    ('jelly', 'skin', 3)
    """

    #: The body it belongs to.
    body: str
    #: ``"cloth"`` or ``"skin"``.
    kind: str
    #: (v, 3), m: the simulation's points, or the vertices of an artist's mesh that they carry along.
    vertices: NDArray[np.float32]
    #: (t, 3), indices into ``vertices``.
    triangles: NDArray[np.uint32]


class Simulation(_engine.Simulation):
    """A simulation. Make one with :meth:`Scene.simulation`, :meth:`Model.simulation` or :func:`load`.

    Points and springs are called by their index, from 0. Units are SI; +y is up.

    Arrays that it gives (``positions``, ``stiffness``, …) are read-only and stay as they are: after the next step ask again.
    Parameters are set as a whole, to one number or to one for each:

    >>> import sprung
    >>> cloth = sprung.scene("cloth").simulation()
    >>> cloth.frame()
    >>> cloth.positions.shape
    (400, 3)
    >>> stiffness = cloth.stiffness.copy()
    >>> stiffness[:100] = 500
    >>> cloth.stiffness = stiffness
    >>> cloth.damping = 2.0

    Any thread may use it, one after another; Python's other threads go on while it steps. ``copy.deepcopy`` and ``pickle`` give
    one that goes on with the same bits.
    """

    _source: Scene | Model

    def __new__(cls, source: Scene | Model, **options: Any) -> Simulation:
        if not isinstance(source, (_engine.Scene, _engine.Model)):
            found = type(source).__name__
            raise TypeError(f'a simulation is of a Scene or a Model, not of {found}; try sprung.scene("jelly").simulation()')
        made = super().__new__(cls, source, **options)
        made._source = source
        return made

    def step(self, count: int = 1) -> None:
        """Takes so many steps of ``dt``. Many at once are faster than one after another, with the same bits.

        Raises :class:`BlowUp` if the run blows up: the last good state is then the current one. Ctrl-C ends it after a whole step.

        >>> import sprung
        >>> jelly = sprung.scene("jelly").simulation()
        >>> jelly.step(100)
        >>> jelly.steps_taken
        100
        """
        super().step(count)

    def frame(self) -> None:
        """Takes ``substeps`` steps, as from one displayed frame to the next.

        >>> import sprung
        >>> cloth = sprung.scene("cloth").simulation()
        >>> cloth.frame()
        >>> cloth.steps_taken == cloth.substeps
        True
        """
        super().frame()

    def run(
        self,
        seconds: float,
        *,
        fps: float | None = None,
        every: int | None = None,
        velocities: bool = True,
        before_frame: Callable[[Simulation], object] | None = None,
        progress: Progress = None,
    ) -> Trajectory:
        """Runs for so much time and records: how it is now, and then so many frames a second (``fps``, to the nearest whole number
        of steps), or one after every ``every`` steps, by default ``substeps``.

        ``before_frame`` is called with the simulation before each frame: wind, control, anything that changes. Without
        ``velocities`` it takes half the memory: 12 bytes for each point and frame.

        Raises :class:`BlowUp`; its ``trajectory`` has the frames until then. So has that of a ``KeyboardInterrupt``.

        >>> import sprung
        >>> jelly = sprung.scene("jelly").simulation()
        >>> fall = jelly.run(2, fps=25)
        >>> fall.positions.shape
        (51, 1000, 3)

        Wind for as long as it lasts:

        >>> import numpy as np
        >>> flag = sprung.scene("flag").simulation()
        >>> def gust(flag):
        ...     flag.external_forces = np.full((flag.point_count, 3), [0, 0, 0.01 * np.sin(flag.time)])
        >>> waving = flag.run(0.2, before_frame=gust)
        """
        if fps is not None and every is not None:
            raise refusal("fps", "says what every says already", code="conflict", fix="leave one of them out")
        if fps is not None:
            if not 0 < fps < float("inf"):
                raise refusal("fps", f"is {fps}, and must be a finite number above 0")
            every = max(1, round(1 / (fps * self.dt)))
        every = self.substeps if every is None else every
        if every < 1:
            raise refusal("every", f"is {every}, and must be at least 1 step")
        if not 0 <= seconds < float("inf"):
            raise refusal("seconds", f"is {seconds}, and must be a finite number of at least 0 s")
        frame_time = every * self.dt
        # What is meant to be a whole number of frames may be a rounding error less.
        count = int(seconds / frame_time * (1 + 1e-12) + 1e-9)
        recorder = _engine.Recorder(self, frame_time, count + 1, velocities)
        recorder.take(self)

        def recorded(blew_up: bool = False) -> Trajectory:
            return Trajectory(recorder.finish(blew_up), self._source)

        with bar(count, "frame", progress) as advance:
            try:
                for _ in range(count):
                    if before_frame is not None:
                        before_frame(self)
                    self.step(every)
                    recorder.take(self)
                    advance(1)
            except BlowUp as blow_up:
                blow_up.trajectory = recorded(blew_up=True)
                raise
            except KeyboardInterrupt as interrupt:
                interrupt.trajectory = recorded()  # type: ignore[attr-defined]
                raise
        return recorded()

    def reset(self) -> None:
        """Goes back to how it began, parameters and all, bit for bit.

        >>> import sprung
        >>> jelly = sprung.scene("jelly").simulation()
        >>> jelly.stiffness = 100
        >>> jelly.step(10)
        >>> jelly.reset()
        >>> jelly.steps_taken, float(jelly.stiffness[0])
        (0, 750.0)
        """
        super().reset()

    def settle(self, *, residual_force: float | None = None, max_steps: int | None = None) -> float:
        """Brings it to rest, and gives the largest force that is left on a point, N.

        Raises :class:`Error` with the code ``"not_settled"`` after ``max_steps``.

        >>> import sprung
        >>> cloth = sprung.scene("cloth").simulation()
        >>> cloth.settle() < 0.01
        True
        """
        return self._bring_to_rest(residual_force, max_steps)[1]

    @property
    def energy(self) -> Energy[float]:
        """Where the energy is, and where it went. It costs about as much as a step.

        >>> import sprung
        >>> jelly = sprung.scene("jelly").simulation()
        >>> jelly.energy.kinetic
        0.0
        """
        return Energy(*self._energies())

    @property
    def stability(self) -> Stability:
        """How large ``dt`` may be, and which spring sets that. The exact answer takes as long as some hundred steps.

        >>> import sprung
        >>> jelly = sprung.scene("jelly").simulation()
        >>> jelly.stability.certified.set_by
        'spring 3945 of jelly (points 487 and 587)'
        """
        told = self._limits()
        certified, every_configuration = (Limit(*told.pop(key)) for key in ("certified", "every_configuration"))
        return Stability(**told, certified=certified, every_configuration=every_configuration)

    @property
    def certified_limit(self) -> Limit:
        """The limit on ``dt`` in this configuration, as quickly as three steps.

        >>> import sprung
        >>> jelly = sprung.scene("jelly").simulation()
        >>> jelly.dt < jelly.certified_limit.dt
        True
        """
        return Limit(*self._quick_limit())

    @property
    def planes(self) -> tuple[Plane, ...]:
        """The ground planes; set them as a whole.

        >>> import sprung
        >>> jelly = sprung.scene("jelly").simulation()
        >>> jelly.planes = [*jelly.planes, sprung.Plane(point=(8, 0, 0), normal=(-1, 0, 0), stiffness=50, damping=10)]
        >>> len(jelly.planes)
        2
        """
        return tuple(
            Plane(point=point, normal=normal, stiffness=stiffness, damping=damping, law=law)
            for point, normal, stiffness, damping, law in self._tell_planes()
        )

    @planes.setter
    def planes(self, planes: Sequence[Plane]) -> None:
        self._set_planes(planes_of(planes))

    @property
    def bodies(self) -> list[Body]:
        """The bodies, in the order of their points.

        >>> import sprung
        >>> bridge = sprung.scene("jelly").simulation()
        >>> bridge.bodies[0].points
        slice(0, 1000, 1)
        """
        return [Body(*body) for body in self._tell_bodies()]

    @property
    def joints(self) -> list[Joint]:
        """The springs between bodies.

        >>> import sprung
        >>> bridge = sprung.scene("bridge").simulation()
        >>> between = bridge.springs[bridge.joints[0].springs]
        """
        return [Joint(*joint) for joint in self._tell_joints()]

    @property
    def surfaces(self) -> list[Surface]:
        """The surfaces, as they are now.

        >>> import sprung
        >>> cloth = sprung.scene("cloth").simulation()
        >>> cloth.step(100)
        >>> cloth.surfaces[0].vertices.shape
        (400, 3)
        """
        return [Surface(body, kind, *self._surface(index)) for index, (body, kind) in enumerate(self._tell_surfaces())]

    def save(self, path: str | os.PathLike[str], **options: Any) -> Path:
        """Writes how it is now: a checkpoint (``.sprung``), a picture (``.png``), or any format of :meth:`Trajectory.save`.

        >>> import sprung, tempfile, pathlib
        >>> jelly = sprung.scene("jelly").simulation()
        >>> jelly.step(50)
        >>> folder = pathlib.Path(tempfile.mkdtemp())
        >>> saved = jelly.save(folder / "jelly.sprung")
        >>> sprung.load(saved).state_hash == jelly.state_hash
        True
        """
        if Path(path).suffix.lower() != ".sprung":
            return self.run(0).save(path, **options)
        if options:
            raise TypeError(f"a checkpoint takes no option {', '.join(options)}")
        self._save_checkpoint(Path(path))
        return Path(path)

    def _repr_png_(self) -> bytes:
        return self.picture(640, 360)

    def __repr__(self) -> str:
        named = f" {self.title!r}" if self.title else ""
        size = f"{self.point_count} points, {self.spring_count} springs"
        return f"<sprung.Simulation{named}: {size}, t = {self.time:.6g} s, step {self.steps_taken}>"

    def __reduce__(self) -> tuple[Any, ...]:
        return _unpickled, (type(self), self._source, self._pack(), self.threads)


def load(path: str | os.PathLike[str], *, threads: int | None = None) -> Simulation:
    """Goes on from a checkpoint that :meth:`Simulation.save`, the window or ``sprung run --checkpoint`` wrote.

    >>> import sprung
    >>> import tempfile, pathlib
    >>> jelly = sprung.scene("jelly").simulation()
    >>> jelly.step(50)
    >>> saved = jelly.save(pathlib.Path(tempfile.mkdtemp()) / "jelly.sprung")
    >>> sprung.load(saved).steps_taken
    50
    """
    name, scene, simulation = _engine.read_checkpoint(Path(path))
    return Simulation(Scene(name, packed=scene), packed=simulation, threads=threads)


def _unpickled(make: type[Simulation], source: Scene | Model, packed: bytes, threads: int) -> Simulation:
    # Where there are fewer processors, as many threads as those.
    return make(source, packed=packed, threads=min(threads, os.cpu_count() or 1))


@contextmanager
def bar(total: int, unit: str, progress: Progress, **options: Any) -> Iterator[Callable[[int], object]]:
    """A bar for what takes longer than a second; gives what to call with how much was done."""
    wanted: dict[str, Any] = {"disable": None, "delay": 1} if progress is None else {"disable": not progress}
    with tqdm(total=total, unit=f" {unit}s", leave=progress is True, **wanted, **options) as shown:
        yield shown.update
