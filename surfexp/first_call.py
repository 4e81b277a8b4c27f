"""The line that a first call shows: its kernels are compiled, once on a machine, before anything else is seen."""

from __future__ import annotations

import sys
from typing import Any

LINE = "surfexp: compiling numerical code for this machine, once; the first calls take about half a minute\n"


def announce_compilation() -> None:
    """Show one line on the error stream when numba begins to compile, where a person is looking.

    Code that is loaded from numba's cache is not compiled and says nothing. A version of numba without its events says
    nothing either.
    """
    try:
        from numba.core import event

        event.register("numba:compile", _notice(event))
    except (ImportError, AttributeError):
        return


def is_watched() -> bool:
    """Whether a person looks at the error stream: a terminal, or a notebook."""
    return "ipykernel" in sys.modules or bool(getattr(sys.stderr, "isatty", bool)())


def _notice(event: Any) -> Any:
    class Notice(event.Listener):
        said = False

        def on_start(self, begun: Any) -> None:
            if not self.said and is_watched():
                sys.stderr.write(LINE)
                sys.stderr.flush()
            self.said = True

        def on_end(self, ended: Any) -> None:
            pass

    return Notice()
