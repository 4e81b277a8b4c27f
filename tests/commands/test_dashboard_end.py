"""The dashboard ends with the command that started it, and so does all that it has started."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

SERVER = """
import subprocess, sys, pathlib
child = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(600)"])
pathlib.Path("child").write_text(str(child.pid))
child.wait()
"""
# tests may have been started to outlive their terminal, or behind other work of a script, and then hand down that SIGHUP
# or SIGINT is ignored
UI = """
import signal, sys
signal.signal(signal.SIGHUP, signal.SIG_DFL)
signal.signal(signal.SIGINT, signal.default_int_handler)
from surfexp.commands import processes
processes.end_on_signals()
from surfexp.commands.ui import served
served([sys.executable, "server.py"], {})
"""


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT, signal.SIGHUP])
def test_a_signal_ends_the_server_and_its_workers(tmp_path: Path, number: signal.Signals) -> None:
    (tmp_path / "server.py").write_text(SERVER)
    command = subprocess.Popen([sys.executable, "-c", UI], cwd=tmp_path, stderr=subprocess.DEVNULL)
    until = time.monotonic() + 60
    while not (tmp_path / "child").exists() or not (tmp_path / "child").read_text():
        assert time.monotonic() < until
        time.sleep(0.05)
    worker = Path("/proc") / (tmp_path / "child").read_text()
    command.send_signal(number)
    command.wait(30)
    until = time.monotonic() + 10
    while worker.exists() and "Z" not in (worker / "stat").read_text().split()[2]:
        assert time.monotonic() < until, "a worker of the server is left"
        time.sleep(0.05)
