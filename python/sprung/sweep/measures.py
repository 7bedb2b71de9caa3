"""What a sweep can measure of a run: measures that are built in, and how one is called."""

from __future__ import annotations

import difflib
import importlib
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..errors import refusal

if TYPE_CHECKING:
    from ..simulation import Simulation

#: Takes the simulation at its start and at each frame, and gives numbers by name.
Measure = Callable[[Iterator["Simulation"]], Mapping[str, float]]


class BuiltinMeasure(NamedTuple):
    """A measure that comes with the package, by its name.

    >>> import sprung
    >>> [measure.name for measure in sprung.MEASURES if measure.unit == "m/s"]
    ['top_speed']
    """

    name: str
    unit: str
    meaning: str
    #: Its value as the simulation is now.
    now: Callable[[Simulation], float]
    #: Which of two values counts over a run: ``min`` or ``max``; without one, that at the end.
    of_two: Callable[[float, float], float] | None = None


# Sums and roots as below have the same bits on every processor; NumPy's own sums and norms need not.


def _mean_height(simulation: Simulation) -> float:
    return math.fsum(simulation.positions[:, 1].tolist()) / simulation.point_count


def _top_speed(simulation: Simulation) -> float:
    x, y, z = simulation.velocities.T.astype(float)
    return float(np.sqrt((x * x + y * y + z * z).max()))


def _largest_extension(simulation: Simulation) -> float:
    whole = ~simulation.cut
    a, b = simulation.springs[whole].T
    x, y, z = (simulation.positions[b] - simulation.positions[a]).T.astype(float)
    return float((np.sqrt(x * x + y * y + z * z) - simulation.rest_lengths[whole]).max(initial=-math.inf))


#: Every measure that is built in. Documentation and help are made from this list.
MEASURES = [
    BuiltinMeasure("kinetic_energy", "J", "kinetic energy at the end", lambda now: now.energy.kinetic),
    BuiltinMeasure(
        "total_energy", "J", "kinetic and potential energy at the end", lambda now: now.energy.total
    ),
    BuiltinMeasure("mean_height", "m", "average height of the points at the end", _mean_height),
    BuiltinMeasure(
        "lowest", "m", "height of the lowest point of any frame", lambda now: now.positions[:, 1].min(), min
    ),
    BuiltinMeasure(
        "highest", "m", "height of the highest point of any frame", lambda now: now.positions[:, 1].max(), max
    ),
    BuiltinMeasure("top_speed", "m/s", "highest speed of any point in any frame", _top_speed, max),
    BuiltinMeasure(
        "largest_extension",
        "m",
        "length beyond its rest length of any spring in any frame",
        _largest_extension,
        max,
    ),
]


class Builtin:
    """Takes the built-in measures of these names, in one go through the frames."""

    def __init__(self, names: Sequence[str]) -> None:
        known = {measure.name: measure for measure in MEASURES}
        for name in names:
            if name not in known:
                there_are = f'there are {", ".join(known)}, and "module:function" for your own'
                raise refusal(
                    "measure",
                    f'"{name}" is no built-in measure; {there_are}',
                    code="not_found",
                    fix=likely(name, list(known)),
                )
        self.names = list(names)
        self._measures = [known[name] for name in names]

    def __call__(self, frames: Iterator[Simulation]) -> dict[str, float]:
        extremes: dict[str, float] = {}
        for simulation in frames:
            for name, _, _, now, of_two in self._measures:
                if of_two is not None:
                    value = float(now(simulation))
                    extremes[name] = of_two(extremes.get(name, value), value)
        return {
            name: extremes[name] if name in extremes else now(simulation)
            for name, _, _, now, _ in self._measures
        }

    def __reduce__(self) -> tuple[type[Builtin], tuple[list[str]]]:
        return Builtin, (self.names,)


def measure_of(asked: Measure | str | Sequence[str]) -> Measure:
    """The measure that is meant: a function, the name of one (``"module:function"``), or built-in measures by
    name."""
    if isinstance(asked, str):
        return function_named("measure", asked) if ":" in asked else Builtin([asked])
    if callable(asked):
        return asked
    if isinstance(asked, Sequence) and all(isinstance(name, str) for name in asked):
        return Builtin(asked)
    raise refusal(
        "measure", f"is {asked!r}, and must be a function, a name, or a list of names of built-in measures"
    )


def function_named(field: str, name: str) -> Callable[..., Any]:
    """The function that ``"module:function"`` names."""
    module, _, function = name.partition(":")
    try:
        found = getattr(importlib.import_module(module), function)
    except (ImportError, AttributeError, ValueError) as error:
        raise refusal(field, f'there is no "{name}": {error}', code="not_found") from None
    if not callable(found):
        raise refusal(field, f'"{name}" is no function')
    as_function: Callable[..., Any] = found
    return as_function


def likely(name: str, known: list[str]) -> str | None:
    """A question about the name that was probably meant."""
    close = difflib.get_close_matches(name, known, 1)
    return f'did you mean "{close[0]}"?' if close else None
