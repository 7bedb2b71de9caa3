"""The folder of a sweep: what the sweep is, a journal of its runs, and the table.

A run is done when its line is in the journal: lines are only ever added, and are on the disk before the next
runs count. So a sweep can be killed at any moment. The line that was being written then is noticed and its
run done again."""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..errors import refusal
from ..scene import _text
from .plan import AFTER, Row

if TYPE_CHECKING:
    import pandas

#: Whole numbers that most rows do not have.
WHOLE = ("blow_up_step", "blow_up_spring")


class Folder:
    """A folder for one sweep, which nobody else writes into as long as it is open."""

    def __init__(self, path: Path, sweep: dict[str, Any]) -> None:
        self.path = path
        try:
            path.mkdir(parents=True, exist_ok=True)
            self._journal = open(path / "journal.jsonl", "a+b")
        except OSError as error:
            raise refusal("out", f"{path} cannot be written to: {error.strerror}", code="io") from None
        try:
            _lock(self._journal.fileno(), path)
            self._claim(sweep)
            self.done = {row["run"] for row in self._rows()}
            self._mend()
        except BaseException:
            self._journal.close()
            raise
        self._sweep_up()

    def close(self) -> None:
        """Lets others have it. So does the end of the process, however it comes."""
        self._sweep_up()
        self._journal.close()

    def _sweep_up(self) -> None:
        """Takes away trajectories that were never whole."""
        shutil.rmtree(self.path / "partial", ignore_errors=True)

    def add(self, lines: str) -> None:
        """Takes down that runs are done."""
        self._journal.write(lines.encode())
        self._journal.flush()
        os.fsync(self._journal.fileno())

    def table(self, keys: list[str]) -> pandas.DataFrame:
        """All runs as a table, which is also written as Parquet."""
        import numpy
        import pandas

        rows = sorted(self._rows(), key=lambda row: int(row["run"]))
        columns: dict[str, Any] = {"run": numpy.array([row["run"] for row in rows])}
        for key in keys:
            columns[key] = _column([row["parameters"].get(key) for row in rows])
        columns["seed"] = numpy.array([row["seed"] for row in rows])
        for name in dict.fromkeys(name for row in rows for name in row.get("measured", ())):
            columns[name] = numpy.array([row.get("measured", {}).get(name, numpy.nan) for row in rows])
        for name in AFTER:
            values = [row.get(name) for row in rows]
            if name in WHOLE:
                columns[name] = pandas.array(values, dtype="Int64")
            elif name in ("status", "message", "state_hash", "version"):
                columns[name] = pandas.array(values, dtype="string")
            else:
                columns[name] = numpy.array(values, dtype=float)
        table: pandas.DataFrame = pandas.DataFrame(columns)
        partial = self.path / "table.parquet.partial"
        table.to_parquet(partial)
        _name(partial, self.path / "table.parquet")
        return table

    def _claim(self, sweep: dict[str, Any]) -> None:
        """Says what sweep this is, or finds that it is said already."""
        said = self.path / "sweep.json"
        if said.exists():
            there = json.loads(said.read_text())
            other = [key for key in {**there, **sweep} if there.get(key) != sweep.get(key)]
            if other:
                sentence = f"{self.path} holds another sweep, with another {' and '.join(other)}"
                raise refusal("out", sentence, code="conflict", fix="choose another folder")
            return
        if next(self._rows(), None) is not None:
            raise refusal(
                "out",
                f"{self.path} has a journal but no sweep.json",
                code="conflict",
                fix="choose another folder",
            )
        partial = self.path / "sweep.json.partial"
        partial.write_text(json.dumps(sweep, indent=1) + "\n")
        _name(partial, said)

    def _rows(self) -> Iterator[Row]:
        """The runs in the journal, each once. A line that is torn or spoilt does not count."""
        seen = set()
        with open(self.path / "journal.jsonl", "rb") as journal:
            for line in journal:
                try:
                    row = json.loads(line)
                    run = row["run"]
                except (ValueError, KeyError, TypeError):
                    continue
                if line.endswith(b"\n") and run not in seen:
                    seen.add(run)
                    yield row

    def _mend(self) -> None:
        """Takes away the end of a journal that was torn, so that the next line is a line of its own."""
        content = self._journal
        end = content.seek(0, os.SEEK_END)
        whole = end
        # Lines are short: the end of the last whole one is found in a block or two.
        while whole > 0:
            begin = max(0, whole - 4096)
            content.seek(begin)
            found = content.read(whole - begin).rfind(b"\n")
            whole = begin + found + 1 if found >= 0 else begin
            if found >= 0:
                break
        if whole < end:
            content.truncate(whole)


def _column(values: list[Any]) -> Any:
    """A parameter's column: numbers, or texts as ``--set`` takes them."""
    import numpy
    import pandas

    if all(isinstance(value, (int, float)) and not isinstance(value, bool) for value in values):
        return numpy.array(values)
    if all(
        value is None or (isinstance(value, (int, float)) and not isinstance(value, bool)) for value in values
    ):
        return numpy.array(values, dtype=float)
    return pandas.array([None if value is None else _text(value) for value in values], dtype="string")


def _name(partial: Path, path: Path) -> None:
    """Gives a file its name, now that it is whole and on the disk."""
    with open(partial, "rb+") as file:
        os.fsync(file.fileno())
    os.replace(partial, path)


def _lock(file: int, path: Path) -> None:
    """Keeps others out. The system lets go of the lock when the process ends, even if it is killed."""
    try:
        if os.name == "nt":
            import msvcrt

            os.lseek(file, 0, os.SEEK_SET)
            msvcrt.locking(file, msvcrt.LK_NBLCK, 1)  # type: ignore[attr-defined,unused-ignore]
        else:
            import fcntl

            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        raise refusal("out", f"a sweep is running in {path} already", code="conflict") from None
