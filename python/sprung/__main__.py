"""``python -m sprung``: the command, without its window, and with sweeps."""

from __future__ import annotations

import signal
import sys

from . import _engine


def main() -> int:
    """Runs the command with the arguments of this process; gives its exit status."""
    if sys.argv[1:2] == ["sweep"]:
        from .sweep.command import main as sweep

        return sweep(sys.argv[2:])
    # The command ends by itself when Ctrl-C comes, with what it has.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return _engine.main(["sprung", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
