"""What several tests need."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

import sprung

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def goldens() -> dict[str, dict[str, str]]:
    """The state hashes of the native program: of each built-in scene after some numbers of steps."""
    read: dict[str, dict[str, str]] = json.loads((ROOT / "crates/sprung/goldens.json").read_text())
    return read


@pytest.fixture(scope="session")
def sentences() -> list[dict[str, Any]]:
    """Mistakes, and what the command says of them."""
    read: list[dict[str, Any]] = json.loads((ROOT / "npm/test/sentences.json").read_text())
    return read


@pytest.fixture
def jelly() -> sprung.Simulation:
    """The falling cube at its start."""
    return sprung.scene("jelly").simulation()
