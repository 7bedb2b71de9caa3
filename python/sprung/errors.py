"""What is raised when something is wrong: the sentence that the command prints, and its parts."""

from __future__ import annotations

import importlib.util
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .trajectory import Trajectory

__all__ = ["BlowUp", "Error"]


class Error(ValueError):
    """One clear sentence: what was found, what is allowed, and often what would mend it.

    >>> import sprung
    >>> try:
    ...     sprung.scene("jely")
    ... except sprung.Error as error:
    ...     print(error.code, "|", error.fix)
    not_found | did you mean "jelly"?
    """

    #: What kind of thing went wrong, such as ``"out_of_range"``.
    code: str
    #: What was found and what is allowed, without the place and the fix.
    sentence: str
    #: The file or argument it is about.
    file: str | None
    #: The line in that file, from 1.
    line: int | None
    #: The column in that line, from 1.
    column: int | None
    #: The field, such as ``body[0].springs[1].stiffness``.
    field: str | None
    #: What would mend it.
    fix: str | None

    def __init__(self, message: str, **parts: Any) -> None:
        super().__init__(message)
        self.code = "unsupported"
        self.sentence = message
        self.file = self.line = self.column = self.field = self.fix = None
        self.__dict__.update(parts)


class BlowUp(Error):
    """The simulation blew up. It has gone back to its last good state, and says why and what to change.

    >>> import sprung
    >>> jelly = sprung.scene("jelly", {"dt": 0.02}).simulation()
    >>> try:
    ...     jelly.run(2)
    ... except sprung.BlowUp as blow_up:
    ...     jelly.dt = blow_up.suggested_dt
    >>> len(jelly.run(2)) > 1
    True
    """

    #: ``"not_finite"`` or ``"energy_from_nowhere"``.
    cause: str
    #: How much energy came from nowhere, J.
    excess: float | None
    #: The step at which it was noticed, and its time, s.
    step: int
    time: float
    #: The last good state's step, and its time, s. The simulation is there now.
    good_step: int
    good_time: float
    #: The spring that sets the limit on dt, and its points; or the one point whose contact sets it.
    spring: int | None
    points: list[int]
    #: The same in words.
    place: str
    #: The step length in use, s.
    dt: float
    #: The certified limit on dt in the last good state, and the limit that holds in every configuration, s.
    certified_limit: float | None
    every_configuration_limit: float | None
    #: A step length that mends it, s.
    suggested_dt: float | None
    #: By how much to multiply all damping so that ``dt`` may stay, where damping is to blame.
    suggested_damping_scale: float | None
    #: The frames until then, where :meth:`Simulation.run` was under way; those in which energy came from
    #: nowhere already are left out.
    trajectory: Trajectory | None = None


def refusal(field: str, sentence: str, *, code: str = "out_of_range", fix: str | None = None) -> Error:
    """The error that an argument of this name is not allowed."""
    message = f"{field}: {sentence}" if fix is None else f"{field}: {sentence}; {fix}"
    return Error(message, code=code, sentence=sentence, field=field, fix=fix)


def needs(what: str, extra: str, *packages: str) -> None:
    """Refuses what needs packages that are not installed, and says how they come."""
    missing = [package for package in packages if importlib.util.find_spec(package) is None]
    if missing:
        *most, last = missing
        names = f"{', '.join(most)} and {last}" if most else last
        sentence = f"{what} needs {names}, which {'are' if most else 'is'} not installed"
        fix = f'pip install ".[{extra}]" in the folder of sprung brings what is needed'
        raise Error(f"{sentence}; {fix}", code="unsupported", sentence=sentence, fix=fix)
