"""An interrupted run leaves no process behind, whatever its processes do with signals and wherever the exception goes.

Every process of a run holds the writing end of a pipe: when its reading end says that it is closed, all have died.
No step is clocked, so that a busy machine changes nothing.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from surfexp.commands import processes

pytestmark = pytest.mark.timeout(3600)
DEAF = 'trap "" INT TERM HUP; echo -n C >&{0}; (trap "" INT TERM HUP; sleep 100000) & while :; do sleep 100000; done'
PROGRAM = """
import os, signal, sys, time
from pathlib import Path
from surfexp.commands import processes
ready, alive, folder, mode = int(sys.argv[1]), int(sys.argv[2]), Path(sys.argv[3]), sys.argv[4]
signal.signal(signal.SIGINT, signal.default_int_handler)
signal.signal(signal.SIGHUP, signal.SIG_DFL)  # under nohup it would be ignored
processes.end_on_signals()
def follow(process):
    try:
        os.write(ready, b"D")
        while process.poll() is None:
            time.sleep(0.01)
    except KeyboardInterrupt:
        if mode == "stuck":
            os.write(ready, b"again")
            while True:
                try:
                    time.sleep(100000)
                except KeyboardInterrupt:
                    pass
        if mode != "swallowed":
            raise
try:
    processes.drive(["bash", "-c", sys.argv[5]], folder / "log", follow, pass_fds=[ready, alive])
except KeyboardInterrupt:
    sys.exit(130)
"""


@pytest.mark.parametrize("mode", ["raised", "swallowed", "stuck"])
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_no_process_is_left(tmp_path: Path, mode: str, number: signal.Signals) -> None:
    (ready, tell), (alive, hold) = os.pipe(), os.pipe()
    arguments = [str(tell), str(hold), str(tmp_path), mode, DEAF.format(tell)]
    process = subprocess.Popen([sys.executable, "-c", PROGRAM, *arguments], pass_fds=[tell, hold])
    os.close(tell)
    os.close(hold)
    assert {os.read(ready, 1), os.read(ready, 1)} == {b"C", b"D"}  # child and driver are both at work
    process.send_signal(number)
    if mode == "stuck":  # the first is lost in some library; the second ends everything
        assert os.read(ready, 5) == b"again"
        process.send_signal(number)
    assert process.wait() == 130
    assert os.read(alive, 1) == b""
    os.close(ready)
    os.close(alive)


def test_what_outlives_snakemake_is_ended_with_it(tmp_path: Path) -> None:
    alive, hold = os.pipe()
    code = processes.drive(
        ["bash", "-c", 'trap "" TERM; sleep 100000 & kill -9 $$'],
        tmp_path / "log",
        lambda process: process.wait() and None,
        pass_fds=[hold],
    )
    os.close(hold)
    assert code == -signal.SIGKILL and os.read(alive, 1) == b""
    os.close(alive)


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux tells a process of its parent's death")
def test_a_stage_dies_with_the_process_that_started_it() -> None:
    alive, hold = os.pipe()
    ready, tell = os.pipe()
    stage = "from surfexp.lab.running.lifetime import die_with_parent; import os, time; die_with_parent(os.getppid())"
    stage += f"; os.write({tell}, b'1')"
    parent = f"import subprocess, sys; subprocess.run([sys.executable, '-c', {stage + '; time.sleep(1e5)'!r}], close_fds=False)"
    for end in (hold, tell):
        os.set_inheritable(end, True)
    process = subprocess.Popen([sys.executable, "-c", parent], close_fds=False)
    os.close(hold)
    assert os.read(ready, 1) == b"1"
    process.kill()
    process.wait()
    assert os.read(alive, 1) == b""
    for end in (alive, ready, tell):
        os.close(end)


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux tells a process of its parent's death")
@pytest.mark.parametrize("module", ["surfexp.lab.running.snakemake", "surfexp.lab.running.stage_server"])
def test_a_process_whose_parent_died_while_it_was_starting_ends(module: str) -> None:
    """Its imports take seconds, in which whoever started it may be killed: an orphan is another one's child by then."""
    begin = f"import subprocess, sys, os; subprocess.Popen([sys.executable, '-m', {module!r}, *sys.argv[1:], str(os.getpid())"
    arguments = "'--version'" if module.endswith("snakemake") else ""
    starting = f"{begin}, {arguments}], stdout={{}}, stdin=subprocess.PIPE); os._exit(0)"
    alive, hold = os.pipe()
    os.set_inheritable(hold, True)
    given = [] if module.endswith("snakemake") else ["no plan", "no state"]
    subprocess.run([sys.executable, "-c", starting.format(hold), *given], close_fds=False, check=True)
    os.close(hold)
    assert os.read(alive, 1000) == b""
    os.close(alive)
