"""Processes that do not outlive the one that started them, whenever that dies."""

from __future__ import annotations

import ctypes
import os
import signal
import sys


def die_with_parent(parent: int) -> None:
    """Ask the kernel to kill this process when its parent dies (Linux), and end it if that has happened already.

    Parameters
    ----------
    parent : int
        Process id, from the parent itself: asked for here, it would be that of whoever took over an orphan.
    """
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(1, signal.SIGKILL)  # PR_SET_PDEATHSIG
    if os.getppid() != parent:
        os._exit(1)
