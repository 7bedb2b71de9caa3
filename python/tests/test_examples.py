"""Everything public has an example, and every example does what it says."""

from __future__ import annotations

import doctest
import inspect
from collections.abc import Iterator
from pathlib import Path

import pytest

import sprung

ROOT = Path(__file__).resolve().parents[2]


def documented() -> Iterator[tuple[str, str]]:
    """What users can call, look at or set, and what is written on it."""
    for name in sprung.__all__:
        value = getattr(sprung, name)
        assert not callable(value) or value.__module__.startswith("sprung"), name
        if inspect.isfunction(value):
            yield name, value.__doc__ or ""
        if not inspect.isclass(value):
            continue
        yield name, value.__doc__ or ""
        for attribute, member in inspect.getmembers(value):
            inherited = any(hasattr(base, attribute) for base in (tuple, Exception))
            if attribute.startswith("_") or inherited or attribute in getattr(value, "_fields", ()):
                continue
            if inspect.isroutine(member) or inspect.isdatadescriptor(member):
                yield f"{name}.{attribute}", inspect.getdoc(member) or ""


EXAMPLES = dict(documented())

#: What some need that need not be installed.
OPTIONAL = {"sweep": "distributed", "to_xarray": "xarray", "to_pandas": "pandas"}


@pytest.mark.parametrize("name", EXAMPLES)
def test_the_example(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    for called, package in OPTIONAL.items():
        if called in name:
            pytest.importorskip(package)
    if "plot" in name:
        pytest.importorskip("matplotlib").use("agg")
    monkeypatch.chdir(ROOT)
    test = doctest.DocTestParser().get_doctest(EXAMPLES[name], {}, name, None, None)
    assert test.examples, f"{name} has no example"
    said: list[str] = []
    doctest.DocTestRunner(verbose=False).run(test, out=said.append)
    assert not said, "".join(said)


def test_there_are_many() -> None:
    assert len(EXAMPLES) > 90
