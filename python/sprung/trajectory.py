"""What was recorded of a run: arrays over time, plots, tables, pictures, and files of every format."""

from __future__ import annotations

import base64
import os
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _engine
from .errors import needs, refusal

if TYPE_CHECKING:
    import pandas
    import xarray
    from matplotlib.axes import Axes

    from .model import Model
    from .scene import Scene
    from .simulation import Body, Energy, Progress

__all__ = ["Animation", "Trajectory"]

#: The axes by their names.
AXES = {"x": 0, "y": 1, "z": 2}

#: Where energy is, and where it went, in colours that nobody confuses (Okabe and Ito, 2008).
STORED = {"kinetic": "#0072b2", "gravitational": "#e69f00", "elastic": "#009e73", "contact": "#d55e00"}
BOOKED = {"lost_in_dampers": "#56b4e9", "lost_in_contact": "#cc79a7", "integrator_error": "#999999"}


class Trajectory:
    """The frames of a run, from :meth:`Simulation.run`. It never changes.

    >>> import sprung
    >>> fall = sprung.scene("jelly").simulation().run(1, fps=25)
    >>> fall.positions.shape
    (26, 1000, 3)
    """

    def __init__(self, frames: _engine.Frames, source: Scene | Model) -> None:
        self._frames = frames
        self._source = source

    def __len__(self) -> int:
        """How many frames there are."""
        return len(self._frames)

    def __repr__(self) -> str:
        frames, points, _ = self.positions.shape
        named = f" {self.title!r}" if self.title else ""
        return f"<sprung.Trajectory{named}: {frames} frames of {points} points, to t = {self.times[-1]:.6g} s>"

    def __reduce__(self) -> tuple[Any, ...]:
        return _unpickled, (self._source, self._frames.pack())

    @property
    def title(self) -> str:
        """What was simulated.

        >>> import sprung
        >>> fall = sprung.scene("jelly").simulation().run(1, fps=25)
        >>> fall.title
        'A cube of jelly falling on a plane'
        """
        return self._frames.title

    @property
    def times(self) -> NDArray[np.float64]:
        """Simulated time of each frame, (f,), s.

        >>> import sprung
        >>> fall = sprung.scene("jelly").simulation().run(1, fps=25)
        >>> fall.times[:3].round(2).tolist()
        [0.0, 0.04, 0.08]
        """
        return self._frames.times

    @property
    def steps(self) -> NDArray[np.uint64]:
        """The step of each frame, (f,).

        >>> import sprung
        >>> fall = sprung.scene("jelly").simulation().run(1, fps=25)
        >>> fall.steps.shape
        (26,)
        """
        return self._frames.steps

    @property
    def frame_time(self) -> float:
        """From one frame to the next, s.

        >>> import sprung
        >>> fall = sprung.scene("jelly").simulation().run(1, fps=25)
        >>> round(fall.frame_time, 2)
        0.04
        """
        return self._frames.frame_time

    @property
    def positions(self) -> NDArray[np.float32]:
        """Positions, (f, n, 3), m; read-only, and without a copy.

        >>> import sprung
        >>> fall = sprung.scene("jelly").simulation().run(1, fps=25)
        >>> fall.positions[:, 0, 1].shape  # the height of the first point over time
        (26,)
        """
        return self._frames.positions

    @property
    def velocities(self) -> NDArray[np.float32]:
        """Velocities, (f, n, 3), m/s; read-only, and without a copy.

        >>> import sprung
        >>> fall = sprung.scene("jelly").simulation().run(1, fps=25)
        >>> speeds = abs(fall.velocities[:, :, 1])
        >>> bool(speeds[5].max() < speeds[10].max())  # ever faster
        True
        """
        velocities = self._frames.velocities
        if velocities is None:
            raise AttributeError("velocities were not recorded; run(…, velocities=True) records them")
        return velocities

    @property
    def energy(self) -> Energy[NDArray[np.float64]]:
        """Where the energy is, and where it went, in each frame, (f,), J.

        >>> import sprung
        >>> fall = sprung.scene("jelly").simulation().run(1, fps=25)
        >>> fall.energy.total.shape
        (26,)
        """
        from .simulation import Energy

        return Energy(*self._frames.energies.T)

    @property
    def bodies(self) -> list[Body]:
        """The bodies, whose points are slices of the second axis.

        >>> import sprung
        >>> fall = sprung.scene("jelly").simulation().run(1, fps=25)
        >>> fall.positions[:, fall.bodies[0].points].shape
        (26, 1000, 3)
        """
        from .simulation import Body

        return [Body(*body) for body in self._frames.tell_bodies()]

    def surface(self, index: int = 0) -> NDArray[np.float32]:
        """The vertices of a surface in every frame, (f, v, 3), m: of :attr:`Simulation.surfaces`, which has the triangles.

        >>> import sprung
        >>> fall = sprung.scene("jelly").simulation().run(1, fps=25)
        >>> fall.surface().shape[0]
        26
        """
        return self._frames.surface(index)

    def save(
        self,
        path: str | os.PathLike[str],
        *,
        size: tuple[int, int] | None = None,
        at: float | None = None,
        up: str = "y",
        scale: float = 1.0,
        springs: str | None = None,
        bodies: Sequence[str] | None = None,
        points: bool = False,
        progress: Progress = None,
    ) -> Path:
        """Writes it in the format that the ending asks for; ``sprung.EXPORTERS`` lists them.

        ``size`` is of pictures, in pixels; ``at`` the time, s, of a still one; ``up`` (``"y"`` or ``"z"``), ``scale`` (units for
        each metre), ``springs`` (``"none"``, ``"lines"``, ``"tubes"``), ``bodies`` (by name) and ``points`` (and no surfaces) are
        of geometry. See docs/export.md. A file gets its name when it is whole.

        >>> import sprung, tempfile, pathlib
        >>> fall = sprung.scene("jelly").simulation().run(0.1)
        >>> fall.save(pathlib.Path(tempfile.mkdtemp()) / "fall.usdc").suffix
        '.usdc'
        """
        from .simulation import bar

        path = Path(path)
        with bar(1000, "part", progress, bar_format="{percentage:3.0f}%|{bar}| {remaining} left") as advance:
            done = 0

            def told(share: float) -> None:
                nonlocal done
                advance(int(1000 * share) - done)
                done = int(1000 * share)

            self._frames.write(
                path,
                size=size,
                at=at,
                up=up,
                scale=scale,
                springs=springs,
                bodies=None if bodies is None else list(bodies),
                points=points,
                told=told,
            )
        return path

    def animate(self, *, size: tuple[int, int] = (640, 360), format: str = "gif") -> Animation:
        """An animation that a notebook shows: ``"gif"``, or ``"mp4"`` where there is ffmpeg.

        >>> import sprung
        >>> sprung.scene("jelly").simulation().run(0.2, fps=25).animate(size=(160, 90)).format
        'gif'
        """
        if format not in ("gif", "mp4"):
            raise refusal("format", f'is "{format}", and must be "gif" or "mp4"')
        with tempfile.TemporaryDirectory() as folder:
            return Animation(self.save(Path(folder) / f"animation.{format}", size=size).read_bytes(), format)

    def picture(self, *, at: float | None = None, size: tuple[int, int] = (640, 360)) -> bytes:
        """A picture of the frame nearest to ``at`` (s), or of the last, as the bytes of a PNG.

        >>> import sprung
        >>> sprung.scene("jelly").simulation().run(0.2, fps=25).picture(at=0.1)[:4]
        b'\\x89PNG'
        """
        with tempfile.TemporaryDirectory() as folder:
            return self.save(Path(folder) / "picture.png", at=at, size=size, progress=False).read_bytes()

    def _repr_png_(self) -> bytes:
        return self.picture()

    def plot_energy(self, axes: Axes | None = None) -> Axes:
        """Plots where the energy is over time, and where it went as far as the ledger was kept, with matplotlib.

        >>> import sprung
        >>> fall = sprung.scene("jelly").simulation().run(1, fps=25)
        >>> fall.plot_energy().get_ylabel()
        'energy (J)'
        """
        # Beside the curves, which use all of the room, where the figure is ours.
        place: dict[str, Any] = {} if axes else {"loc": "center left", "bbox_to_anchor": (1, 0.5), "frameon": False}
        axes = _axes(axes)
        energy = self.energy
        for name, colour in STORED.items():
            values = getattr(energy, name)
            if values.any():
                axes.plot(self.times, values, color=colour, label=name)
        axes.plot(self.times, energy.total, color="black", label="total")
        for name, colour in BOOKED.items():
            values = getattr(energy, name)
            if values.any():
                axes.plot(self.times, values, color=colour, linestyle="--", label=name.replace("_", " "))
        axes.set(xlabel="time (s)", ylabel="energy (J)", title=self.title)
        axes.legend(**place)
        return axes

    def plot(
        self,
        points: int | Sequence[int],
        axis: str = "y",
        axes: Axes | None = None,
        *,
        label: str | None = None,
    ) -> Axes:
        """Plots a coordinate of one point or several over time: ``"x"``, ``"y"``, ``"z"``; ``"vx"``, ``"vy"``,
        ``"vz"``; or ``"speed"``. ``label`` is what the legend calls it, by default the point.

        >>> import sprung
        >>> fall = sprung.scene("jelly").simulation().run(1, fps=25)
        >>> fall.plot([0, 999], "y").get_ylabel()
        'y (m)'
        """
        values, quantity = self._coordinate(axis)
        axes = _axes(axes)
        for point in np.atleast_1d(points):
            axes.plot(self.times, values[:, point], label=label or f"point {point}")
        axes.set(xlabel="time (s)", ylabel=quantity, title=self.title)
        axes.legend()
        return axes

    def to_xarray(self) -> xarray.Dataset:
        """As an xarray dataset: ``position`` and ``velocity`` over time, point and axis, and the energies over time.

        >>> import sprung
        >>> fall = sprung.scene("jelly").simulation().run(1, fps=25)
        >>> dict(fall.to_xarray().position.sizes)
        {'time': 26, 'point': 1000, 'axis': 3}
        """
        needs("a dataset", "tables", "xarray")
        import xarray

        dims = ("time", "point", "axis")
        metres, speed = {"units": "m"}, {"units": "m/s"}
        data: dict[str, Any] = {"position": (dims, self.positions, metres)}
        if self._frames.velocities is not None:
            data["velocity"] = (dims, self.velocities, speed)
        for name, values in vars(self.energy).items():
            data[name] = ("time", values, {"units": "J"})
        coords: dict[str, Any] = {"time": ("time", self.times, {"units": "s"}), "axis": list(AXES)}
        return xarray.Dataset(data, coords=coords, attrs={"title": self.title})

    def to_pandas(self) -> pandas.DataFrame:
        """As a tidy table: a row for each frame and point, with time (s), position (m) and velocity (m/s).

        >>> import sprung
        >>> fall = sprung.scene("jelly").simulation().run(1, fps=25)
        >>> fall.to_pandas().columns.tolist()
        ['time', 'point', 'x', 'y', 'z', 'vx', 'vy', 'vz']
        """
        needs("a table", "tables", "pandas")
        import pandas

        frames, points, _ = self.positions.shape
        columns: dict[str, Any] = {
            "time": np.repeat(self.times, points),
            "point": np.tile(np.arange(points), frames),
        }
        columns.update((axis, self.positions[:, :, index].ravel()) for axis, index in AXES.items())
        if self._frames.velocities is not None:
            columns.update((f"v{axis}", self.velocities[:, :, index].ravel()) for axis, index in AXES.items())
        table: pandas.DataFrame = pandas.DataFrame(columns)
        return table

    def _coordinate(self, axis: str) -> tuple[NDArray[np.float32], str]:
        if axis in AXES:
            return self.positions[:, :, AXES[axis]], f"{axis} (m)"
        if axis[:1] == "v" and axis[1:] in AXES:
            return self.velocities[:, :, AXES[axis[1:]]], f"{axis} (m/s)"
        if axis == "speed":
            return np.linalg.norm(self.velocities, axis=2), "speed (m/s)"
        raise refusal("axis", f'is "{axis}", and must be x, y, z, vx, vy, vz or speed')


class Animation:
    """A moving picture: a notebook shows it, :meth:`save` writes it.

    >>> import sprung
    >>> swing = sprung.scene("spring").simulation().run(0.2, fps=25).animate(size=(160, 90))
    >>> swing.format, swing.content[:3]
    ('gif', b'GIF')
    """

    def __init__(self, content: bytes, format: str) -> None:
        self.content = content
        self.format = format

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Writes it to a file.

        >>> import sprung
        >>> swing = sprung.scene("spring").simulation().run(0.2, fps=25).animate(size=(160, 90))
        >>> import tempfile, pathlib
        >>> swing.save(pathlib.Path(tempfile.mkdtemp()) / "swing.gif").suffix
        '.gif'
        """
        Path(path).write_bytes(self.content)
        return Path(path)

    def _repr_html_(self) -> str:
        text = base64.b64encode(self.content).decode()
        if self.format == "gif":
            return f'<img src="data:image/gif;base64,{text}" alt="animation">'
        return f'<video src="data:video/mp4;base64,{text}" controls loop></video>'

    def __repr__(self) -> str:
        return f"<sprung.Animation: {self.format}, {len(self.content) / 1000:.0f} kB>"


def _unpickled(source: Scene | Model, packed: bytes) -> Trajectory:
    return Trajectory(_engine.Frames(source, packed), source)


def _axes(axes: Axes | None) -> Axes:
    if axes is not None:
        return axes
    needs("a plot", "plot", "matplotlib")
    import matplotlib.pyplot as plt

    return plt.subplots(layout="constrained")[1]
