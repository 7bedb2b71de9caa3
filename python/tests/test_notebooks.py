"""The lessons in docs/notebooks run, show pictures, and are stored without what they printed.

How long each takes: ``python -m pytest python/tests/test_notebooks.py --durations=0 -vv``, or ``python
python/tests/test_notebooks.py``.
"""

from __future__ import annotations

import json
import re
import sys
import time
from pathlib import Path
from typing import Any

import pytest

FOLDER = Path(__file__).resolve().parents[2] / "docs/notebooks"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))
#: What a bar in text leaves on stderr: each state of it begins where the line begins.
BAR = re.compile(r"\r[^\r\n]*")


def run(path: Path, folder: Path) -> Any:
    """Executes a notebook in a folder and gives it with its outputs. An exception in a cell is raised."""
    nbclient = pytest.importorskip("nbclient")
    nbformat = pytest.importorskip("nbformat")
    notebook = nbformat.read(path, as_version=4)
    resources = {"metadata": {"path": str(folder)}}
    return nbclient.NotebookClient(notebook, timeout=600, kernel_name="python3", resources=resources).execute()


def outputs(notebook: Any) -> list[dict[str, Any]]:
    return [output for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs]


def pictures(notebook: Any) -> int:
    return sum("image/png" in output.get("data", {}) for output in outputs(notebook))


def complaints(notebook: Any) -> str:
    """All that came on stderr and is no bar."""
    texts = [output["text"] for output in outputs(notebook) if output.get("name") == "stderr"]
    return "".join(BAR.sub("", text) for text in texts).strip()


def test_there_are_lessons() -> None:
    assert len(NOTEBOOKS) >= 6


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_runs_and_shows_pictures(path: Path, tmp_path: Path) -> None:
    notebook = run(path, tmp_path)
    assert complaints(notebook) == ""
    assert pictures(notebook) >= 2


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_is_stored_without_outputs(path: Path) -> None:
    # Read as it is: nbformat would mend much in silence.
    text = path.read_text(encoding="utf-8")
    stored = json.loads(text)
    assert text == json.dumps(stored, indent=1, ensure_ascii=False, sort_keys=True) + "\n"
    assert stored["metadata"]["kernelspec"]["name"] == "python3"
    ids = [cell["id"] for cell in stored["cells"]]
    assert len(set(ids)) == len(ids)
    for cell in stored["cells"]:
        if cell["cell_type"] == "code":
            assert cell["outputs"] == [], cell["id"]
            assert cell["execution_count"] is None, cell["id"]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_is_in_the_list(path: Path) -> None:
    assert f"({path.name})" in (FOLDER / "README.md").read_text(encoding="utf-8")


def main() -> None:
    """Runs those that are named, or all, and prints how long each takes."""
    import tempfile

    for path in [Path(name) for name in sys.argv[1:]] or NOTEBOOKS:
        start = time.perf_counter()
        with tempfile.TemporaryDirectory() as folder:
            notebook = run(path, Path(folder))
        seconds, shown = time.perf_counter() - start, pictures(notebook)
        print(f"{path.stem:24} {seconds:5.1f} s, {shown} pictures {complaints(notebook)}".rstrip())


if __name__ == "__main__":
    main()
