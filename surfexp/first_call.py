"""A first call: one line that its kernels are compiled, once on a machine, and a second process that compiles with it."""

from __future__ import annotations

import atexit
import contextlib
import subprocess
import sys
from typing import Any

from surfexp.contract.threads import all_cores

LINE = "surfexp: compiling numerical code for this machine, once; the first calls take about half a minute\n"
BESIDE = "surfexp.linalg.first_factorisation"


def announce_compilation() -> None:
    """Show one line on the error stream when numba begins to compile, where a person is looking, and compile beside it.

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


def compile_beside() -> subprocess.Popen[bytes] | None:
    """Let another process compile the factorisation into numba's cache, where there is a second core; it ends with this one.

    It is what takes longest, and a call needs it only after its mesh was judged and its matrix ordered.
    """
    if all_cores() < 2:
        return None
    with contextlib.suppress(OSError):
        beside = subprocess.Popen(  # noqa: S603, this interpreter, this package, no shell
            (sys.executable, "-m", BESIDE),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        atexit.register(_end, beside)
        return beside
    return None


def _end(process: subprocess.Popen[bytes]) -> None:
    process.terminate()
    process.wait()


def _notice(event: Any) -> Any:
    class Notice(event.Listener):
        begun = False
        beside: subprocess.Popen[bytes] | None = None

        def on_start(self, begun: Any) -> None:
            if self.begun:
                return
            self.begun = True
            if is_watched():
                sys.stderr.write(LINE)
                sys.stderr.flush()
            self.beside = compile_beside()

        def on_end(self, ended: Any) -> None:
            if self.beside is not None:
                self.beside.poll()  # a process that has ended is not left waiting for its parent

    return Notice()
