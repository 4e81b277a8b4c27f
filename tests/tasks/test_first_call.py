"""The line that a first call shows while its code is compiled, and that later ones do not."""

from __future__ import annotations

import os
import pty
import subprocess
import sys
from pathlib import Path

import numba.core
import pytest

from surfexp.first_call import LINE, announce_compilation

CALL = "import surfexp as sx; sx.check(sx.shape('icosphere', levels=1))"


def seen_in_terminal(cache: Path) -> str:
    """What a Python program shows on its error stream, which is a terminal."""
    master, slave = pty.openpty()
    environment = os.environ | {"NUMBA_CACHE_DIR": str(cache)}
    subprocess.run([sys.executable, "-c", CALL], stderr=slave, env=environment, check=True, timeout=300)
    os.close(slave)
    seen = b""
    try:
        while part := os.read(master, 4096):
            seen += part
    except OSError:  # the end of a terminal that nobody holds
        pass
    os.close(master)
    return seen.decode().replace("\r\n", "\n")


@pytest.mark.slow
def test_the_first_call_says_that_it_compiles_and_the_second_does_not(tmp_path: Path) -> None:
    assert seen_in_terminal(tmp_path) == LINE
    assert seen_in_terminal(tmp_path) == ""


def test_a_numba_without_events_is_no_failure(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr(numba.core, "event")
    monkeypatch.setitem(sys.modules, "numba.core.event", None)
    announce_compilation()
