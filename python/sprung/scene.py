"""Scenes: small TOML files that say where points are, what joins them, what the ground is and how long a step is."""

from __future__ import annotations

import html
import json
import os
import warnings
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from . import _engine
from .errors import Error, refusal

if TYPE_CHECKING:
    from .simulation import Simulation

__all__ = ["BuiltinScene", "Scene", "View", "from_mesh", "scene", "scenes"]

#: Where ``cargo xtask web --serve`` serves the window.
PAGE = "http://127.0.0.1:8080/"

#: What a key of a scene may be set to.
Value = float | str | bool | Sequence[float]
Changes = Mapping[str, Value]


class BuiltinScene(NamedTuple):
    """A scene that comes with the engine.

    >>> import sprung
    >>> sprung.scenes()[0].title
    'A mass on a spring'
    """

    #: As :func:`scene` takes it.
    name: str
    #: What it shows.
    title: str
    #: ``"report"``, ``"gallery"`` or ``"benchmark"``.
    kind: str


class Scene(_engine.Scene):
    """A scene. It never changes: :meth:`changed` gives another.

    Make one with :func:`scene`, :meth:`from_file`, :meth:`from_toml`, :meth:`from_dict` or :func:`from_mesh`.

    >>> import sprung
    >>> jelly = sprung.scene("jelly")
    >>> jelly.title
    'A cube of jelly falling on a plane'
    >>> softer = jelly.changed({"body.jelly.springs.stiffness": 100})
    """

    @classmethod
    def from_file(cls, path: str | os.PathLike[str], changes: Changes | None = None) -> Scene:
        """Reads a scene file. Meshes that it names lie in its folder or below.

        Raises :class:`Error` with the line and the key of what is wrong.

        >>> import sprung
        >>> sprung.Scene.from_file("examples/towel.toml").simulation().surfaces[0].kind
        'cloth'
        """
        return cls._warning(cls(Path(path).stem, file=Path(path), changes=_pairs(changes)))

    @classmethod
    def from_toml(
        cls,
        text: str,
        changes: Changes | None = None,
        *,
        name: str = "scene",
        folder: str | os.PathLike[str] = ".",
    ) -> Scene:
        """Takes the text of a scene file. Meshes that it names are looked for in ``folder``.

        >>> import sprung
        >>> falling = sprung.Scene.from_toml('''
        ... dt = 0.01
        ... [[body]]
        ... name = "stone"
        ... points = [[0, 10, 0]]
        ... ''').simulation()
        >>> falling.step(100)
        >>> round(float(falling.positions[0, 1]), 2)
        5.05
        """
        return cls._warning(cls(name, text=text, folder=Path(folder), changes=_pairs(changes)))

    @classmethod
    def from_dict(
        cls,
        content: Mapping[str, Any],
        changes: Changes | None = None,
        *,
        name: str = "scene",
        folder: str | os.PathLike[str] = ".",
    ) -> Scene:
        """Takes what a scene file says as dictionaries, lists and numbers; NumPy's arrays will do, too.

        >>> import sprung
        >>> chain = {"points": 10, "step": [1, 0, 0]}
        >>> springs = {"radius": 1, "stiffness": 500, "damping": 1}
        >>> rope = sprung.Scene.from_dict({"body": [{"name": "rope", "chain": chain, "pins": [0], "springs": [springs]}]})
        >>> rope.simulation().spring_count
        9
        """
        try:
            text = json.dumps(content, default=_plain, allow_nan=False)
        except ValueError:
            raise refusal("content", "holds nan, inf or itself, and must hold finite numbers") from None
        try:
            return cls.from_toml(_engine.toml_of(text), changes, name=name, folder=folder)
        except Error as error:
            # Nobody has seen the text that its lines are of.
            if error.field is None or error.line is None:
                raise
            raise refusal(error.field, error.sentence, code=error.code, fix=error.fix) from None

    def changed(self, changes: Changes) -> Scene:
        """The same scene with other values, by the keys that ``sprung run --set KEY=VALUE`` takes.

        >>> import sprung
        >>> sprung.scene("jelly").changed({"dt": 0.005, "plane.y": -12}).simulation().dt
        0.005
        """
        return type(self)(self.name, origin=self, changes=_pairs(changes))

    def simulation(self, *, threads: int | None = None) -> Simulation:
        """A simulation of it, at its start, on so many threads: by default one for each processor.

        However many there are, the bits are the same. Small scenes use one.

        >>> import sprung
        >>> sprung.scene("jelly").simulation(threads=1)
        <sprung.Simulation 'A cube of jelly falling on a plane': 1000 points, 7560 springs, t = 0 s, step 0>
        """
        from .simulation import Simulation

        return Simulation(self, threads=threads)

    def link(self, page: str = PAGE) -> str:
        """The address at which the window in a browser shows this scene: ``page`` is where that is served, as
        by ``cargo xtask web --serve``. See docs/web.md. Raises :class:`Error` for scenes with a mesh, and for
        those whose text is too long for an address.

        >>> import sprung
        >>> sprung.scene("jelly").link()[:44]
        'http://127.0.0.1:8080/#v=0.1.0&name=jelly&to'
        """
        return f"{page}#{self._link()}"

    def view(self, page: str = PAGE, *, size: tuple[int, int] = (960, 600)) -> View:
        """The window in a notebook, to play and to pull at, where :meth:`link` leads: ``page`` must be served.

        >>> import sprung
        >>> sprung.scene("jelly").view()
        <sprung.View of 'jelly' at http://127.0.0.1:8080/>
        """
        return View(self.name, page, self.link(page), size)

    def __reduce__(self) -> tuple[Any, ...]:
        return _unpickled, (type(self), self.name, self._pack())

    def __repr__(self) -> str:
        return f"<sprung.Scene {self.name!r}: {self.title}>" if self.title else f"<sprung.Scene {self.name!r}>"

    @staticmethod
    def _warning(made: Scene) -> Scene:
        for sentence in made.warnings:
            warnings.warn(f"{made.name}: {sentence}", stacklevel=3)
        return made


class View:
    """The window in a browser, inside a notebook.

    >>> import sprung
    >>> sprung.scene("jelly").view(size=(640, 480)).size
    (640, 480)
    """

    def __init__(self, name: str, page: str, link: str, size: tuple[int, int]) -> None:
        self.name, self.page, self.link, self.size = name, page, link, size

    def _repr_html_(self) -> str:
        width, height = self.size
        return (
            f'<iframe src="{html.escape(self.link)}" title="{html.escape(self.name)}" '
            f'width="{width:d}" height="{height:d}" style="border: none"></iframe>'
        )

    def __repr__(self) -> str:
        return f"<sprung.View of {self.name!r} at {self.page}>"


def scene(name: str | os.PathLike[str], changes: Changes | None = None) -> Scene:
    """A scene by the name of one that is built in, or by the path of a scene file; with other values, if you like.

    :func:`scenes` lists those that are built in.

    >>> import sprung
    >>> sprung.scene("cloth", {"substeps": 4}).simulation().substeps
    4
    """
    text = os.fspath(name)
    if isinstance(name, str) and not text.endswith(".toml") and "/" not in text and os.sep not in text:
        return Scene(name, changes=_pairs(changes))
    return Scene.from_file(name, changes)


def scenes() -> list[BuiltinScene]:
    """The scenes that are built in.

    >>> import sprung
    >>> [scene.name for scene in sprung.scenes() if scene.kind == "report"]
    ['spring', 'chain', 'jelly', 'cloth']
    """
    return [BuiltinScene(*entry) for entry in _engine.BUILTIN]


def from_mesh(
    path: str | os.PathLike[str],
    *,
    cloth: Mapping[str, float] | None = None,
    soft: Mapping[str, float] | None = None,
    net: Mapping[str, float] | None = None,
    plane: Sequence[Mapping[str, Any]] = (),
    **body: Any,
) -> Scene:
    """A scene of one body made from a mesh file: ``cloth``, ``soft`` or ``net`` is its material.

    ``plane`` and everything else (``scale``, ``position``, ``pins``, ``velocity``, …) are as in a scene file; see
    docs/scene-format.md.

    >>> import sprung
    >>> towel = sprung.from_mesh(
    ...     "examples/towel.obj", cloth={"density": 0.4, "stiffness": 150, "damping": 0.02}, pins=[{"group": "rail"}]
    ... )
    >>> towel.simulation().bodies[0].name
    'towel'
    """
    file = Path(path)
    made = {key: dict(value) for key, value in (("cloth", cloth), ("soft", soft), ("net", net)) if value is not None}
    content = {"plane": list(plane), "body": [{"name": file.stem, "mesh": file.name, **made, **body}]}
    return Scene.from_dict(content, name=file.stem, folder=file.parent)


def _unpickled(make: Callable[..., Scene], name: str, packed: bytes) -> Scene:
    return make(name, packed=packed)


def _pairs(changes: Changes | None) -> list[tuple[str, str]]:
    if not isinstance(changes, Mapping | None):
        raise TypeError(f"changes are a dictionary of keys and values, and no {type(changes).__name__}")
    return [(str(key), _text(value)) for key, value in (changes or {}).items()]


def _text(value: Any) -> str:
    """A value as ``--set`` takes it."""
    value = _plain(value) if isinstance(value, (np.ndarray, np.generic)) else value
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(map(_text, value)) + "]"
    return str(value)


def _plain(value: Any) -> Any:
    """What JSON has no word for."""
    if isinstance(value, (np.ndarray, np.generic)):
        return value.tolist()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    raise TypeError(f"a scene holds numbers, texts, lists and dictionaries, and no {type(value).__name__}")
