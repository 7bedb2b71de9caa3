"""The package itself: its documentation, its command, its types."""

from __future__ import annotations

import base64
import subprocess
import sys
import zlib
from pathlib import Path

import pytest

import sprung

ROOT = Path(__file__).resolve().parents[2]


def test_help_teaches() -> None:
    said = subprocess.run(
        [sys.executable, "-c", "import sprung; help(sprung)"], capture_output=True, text=True, check=True
    ).stdout
    for word in ("jelly.run(3, fps=25)", "Units are SI", "BlowUp"):
        assert word in said


def test_the_command_is_there() -> None:
    def sprung_says(*arguments: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run([sys.executable, "-m", "sprung", *arguments], capture_output=True, text=True)

    assert sprung_says("--version").stdout.strip() == f"sprung {sprung.__version__}"
    refused = sprung_says("run", "jely")
    assert refused.returncode == 2 and 'did you mean "jelly"?' in refused.stderr
    blew_up = sprung_says("run", "jelly", "--set", "dt=0.02")
    assert blew_up.returncode == 3 and "blew up" in blew_up.stderr


def test_the_example_of_the_first_page(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert sprung.__doc__ is not None
    lines = [line.removeprefix("    ") for line in sprung.__doc__.splitlines() if line.startswith("    ")]
    monkeypatch.chdir(tmp_path)
    exec(compile("\n".join(lines), "the first page", "exec"), {})
    assert (tmp_path / "jelly.gif").stat().st_size > 10_000


def test_a_link_holds_the_scene() -> None:
    scene = sprung.scene("cloth", {"dt": 0.004})
    fragment = scene.link("https://example.org/").partition("#")[2]
    parts = dict(part.split("=", 1) for part in fragment.split("&"))
    assert (parts["v"], parts["name"]) == (sprung.__version__, "cloth")
    packed = base64.urlsafe_b64decode(parts["toml"] + "=" * (-len(parts["toml"]) % 4))
    assert zlib.decompress(packed, wbits=-zlib.MAX_WBITS).decode() == scene.to_toml()
    assert 'src="https://example.org/#v=' in scene.view("https://example.org/")._repr_html_()
    with pytest.raises(sprung.Error, match="mesh"):
        sprung.scene(ROOT / "examples/towel.toml").link()
