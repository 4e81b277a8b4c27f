"""Stages forked from a warm process: a dead one is named and takes nothing else with it, what they took is measured."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
from numba.core.dispatcher import Dispatcher

from surfexp.lab.plan.outcome import read_event
from surfexp.lab.plan.plan import Plan
from surfexp.lab.plan.resolution import make_plan
from surfexp.lab.registry import registry
from surfexp.lab.running import stage
from surfexp.lab.running.recall import Recall
from surfexp.lab.running.stage_process import death
from surfexp.lab.store import store

ENDS = """
import os, signal, sys
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.lab.registry.registry import register
import numba
import numpy as np

@numba.njit(cache=True)
def twice(size):
    return 2.0 * size

@register("surface", "ending")
def ending(how: str = "well", size: float = 1.0) -> Surface:
    print("hello from", how, flush=True)
    if how == "signal":
        os.kill(os.getpid(), int(size))
    if how == "exit":
        os._exit(int(size))
    if how == "sys.exit":
        sys.exit(0)
    if how == "loop":
        while True:
            pass
    if how == "memory":
        np.ones(int(size * 2**17))
    if how == "threads":
        threads = open("/proc/self/status").read().split("Threads:")[1].split()[0]
        raise ValueError(f"threads {threads}, loaded {'numba' in sys.modules}, parent {os.getppid()}")
    if how == "compiled":
        before = len(twice.overloads)
        twice(size)
        compiled, read = (sum(count.values()) for count in (twice.stats.cache_misses, twice.stats.cache_hits))
        raise ValueError(f"{before} before, {compiled} compiled, {read} read, by {twice(size):g}")
    return Surface(TriangleMesh(size * np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]])))
"""


@pytest.fixture
def results(working_folder: Path) -> Path:
    (working_folder / "plugins" / "surface").mkdir(parents=True)
    (working_folder / "plugins" / "surface" / "ending.py").write_text(ENDS)
    return working_folder / "results"


def plan_of(results: Path, *stages: tuple[str, float]) -> tuple[Plan, Path]:
    registry._loaded.clear()
    registry.PLUGINS.pop(("surface", "ending"), None)
    registry.load_file(results.parent / "plugins" / "surface" / "ending.py")
    surfaces = [{"name": "ending", "how": how, "size": size} for how, size in stages]
    plan = make_plan([{"target": "surface", "results": str(results), "surface": surface} for surface in surfaces])
    return plan, plan.write(results)


class Server:
    """The warm process as the executor starts it."""

    def __init__(self, plan: Plan, path: Path) -> None:
        self.logs = path.parent.parent / "logs"
        state = next(iter(plan.nodes.values())).cache
        command = [sys.executable, "-m", "surfexp.lab.running.stage_server", str(path), state, str(os.getpid())]
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE)

    def ask(self, keys: list[str]) -> dict[str, dict[str, Any]]:
        assert self.process.stdin is not None and self.process.stdout is not None
        for key in keys:
            self.process.stdin.write(json.dumps({"key": key, "log": str(self.logs / key)}).encode() + b"\n")
        self.process.stdin.flush()
        replies = [json.loads(self.process.stdout.readline()) for _ in keys]
        return {reply["key"]: reply for reply in replies}

    def end(self) -> None:
        assert self.process.stdin is not None
        self.process.stdin.close()
        assert self.process.wait() == 0


DEATHS = {
    ("signal", 11.0): "surface/ending: its process was killed by signal 11 (SIGSEGV)",
    ("signal", 9.0): "killed by signal 9 (SIGKILL), as the kernel does when memory is short",
    ("exit", 0.0): "its process ended with exit code 0 before there was a result",
    ("exit", 3.0): "its process ended with exit code 3",
    ("sys.exit", 0.0): "its process ended with exit code 1",
}


def test_a_stage_that_dies_is_named_and_the_others_go_on(results: Path) -> None:
    plan, path = plan_of(results, *DEATHS, ("well", 1.0), ("well", 2.0))
    keys = [leaf.key for leaf in plan.leaves]
    server = Server(plan, path)
    replies = server.ask(keys)
    for key, (how, message) in zip(keys, DEATHS.items(), strict=False):
        assert replies[key]["code"] == 1 and message in read_event(results, "surface", key)["failure"]
        assert (results / "logs" / key).read_text().startswith(f"hello from {how[0]}")
    for key in keys[len(DEATHS) :]:
        assert replies[key]["code"] == 0 and store.is_done(results, "surface", key)
    assert not list(results.rglob("*.progress"))
    server.end()


def test_a_stage_alone_is_named_as_well(results: Path) -> None:
    plan, path = plan_of(results, ("signal", 11.0))
    (leaf,) = plan.leaves
    command = [sys.executable, "-m", "surfexp.lab.running.stage_process", str(path), leaf.key]
    assert subprocess.run(command, capture_output=True).returncode == 1
    assert "signal 11 (SIGSEGV)" in read_event(results, "surface", leaf.key)["failure"]


def test_what_a_stage_has_compiled_later_ones_have_from_birth(
    results: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    plan, path = plan_of(results, ("compiled", 1.0), ("compiled", 2.0), ("compiled", 3.0))
    server = Server(plan, path)
    for leaf in plan.leaves:
        server.ask([leaf.key])
    said = [read_event(results, "surface", leaf.key)["failure"].partition(": ")[2] for leaf in plan.leaves]
    assert said[0] == "0 before, 1 compiled, 0 read, by 2"
    assert said[1:] == ["1 before, 0 compiled, 0 read, by 4", "1 before, 0 compiled, 0 read, by 6"]
    server.end()


def test_a_message_that_no_stage_sends_is_passed_over(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delitem(sys.modules, "surfexp.spectrum.heat_kernel", raising=False)
    recall = Recall()
    for message in (b"\xff", b"{}", b"[1, 2]", b'[["os", "system", "ls"]]', b'[[[], "f", "()"]]', b""):
        recall.there.send(message)
    unheard, ours = "antigravity", "surfexp.spectrum.heat_kernel"
    assert not {unheard, ours} & sys.modules.keys()
    recall.there.send(
        json.dumps([["surfexp.no_such_module", "f", "()"], [unheard], ["surfexp.no_such"], [ours]]).encode()
    )
    recall.learn()
    assert ours in sys.modules and ours in recall.modules and unheard not in sys.modules
    with pytest.raises(BlockingIOError):
        recall.here.recv(1)


def test_an_object_that_has_no_class_to_tell_is_passed_over(monkeypatch: pytest.MonkeyPatch) -> None:
    class Variables:  # as the global variables of a library that SWIG wraps: any name but theirs raises
        def __getattribute__(self, name: str) -> Any:
            raise AttributeError(f"Unknown C global variable {name!r}")

    library = ModuleType("wrapped_library")
    vars(library)["cvar"] = Variables()
    monkeypatch.setitem(sys.modules, "wrapped_library", library)
    if sys.version_info < (3, 13):  # from then on such an object is an instance of nothing
        with pytest.raises(AttributeError, match="__class__"):
            isinstance(vars(library)["cvar"], Dispatcher)
    assert "wrapped_library" in Recall().modules


@pytest.mark.skipif(sys.platform != "linux", reason="threads are counted in /proc")
def test_a_fork_finds_the_libraries_loaded_and_one_thread(results: Path) -> None:
    plan, path = plan_of(results, ("threads", 1.0))
    server = Server(plan, path)
    server.ask([plan.leaves[0].key])
    said = read_event(results, "surface", plan.leaves[0].key)["failure"]
    assert f"threads 1, loaded True, parent {server.process.pid}" in said
    server.end()


def test_memory_is_that_of_the_stage(results: Path) -> None:
    plan, path = plan_of(results, ("memory", 300.0), ("well", 1.0))
    server = Server(plan, path)
    large, small = (server.ask([leaf.key])[leaf.key]["memory"] for leaf in plan.leaves)
    assert 290 < large - small < 310
    events = [read_event(results, "surface", leaf.key)["peak_memory_mb"] for leaf in plan.leaves]
    assert events == pytest.approx([large, small], rel=0.02)
    server.end()


def run(experiment: str, *arguments: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "surfexp.commands.command_line", "run", f"experiment={experiment}", *arguments]
    return subprocess.run(command, capture_output=True, text=True)


@pytest.mark.slow
def test_a_run_names_what_died_and_keeps_the_rest(results: Path) -> None:
    (results.parent / "conf" / "experiment").mkdir(parents=True)
    stages = [{"name": "ending", "how": how, "size": size} for how, size in (*DEATHS, ("well", 1.0))]
    experiment = {"experiment": "ends", "target": "surface", "grid": {"surface": stages}}
    text = "# @package _global_\n" + json.dumps(experiment)
    (results.parent / "conf" / "experiment" / "ends.yaml").write_text(text)
    done = run("ends")
    assert done.returncode == 1 and "Traceback" not in done.stderr, done.stderr
    for message in DEATHS.values():
        assert message in done.stderr
    (record,) = results.glob("store/*/*/record.json")
    (benchmark,) = results.glob(f"logs/surface/{record.parent.name}.benchmark.tsv")
    header, values = (line.split("\t") for line in benchmark.read_text().splitlines())
    event = read_event(results, "surface", record.parent.name)
    assert float(values[header.index("max_rss")]) == pytest.approx(event["peak_memory_mb"], rel=0.02)


@pytest.mark.slow
def test_stages_have_limits_of_time_and_memory_where_asked_for(results: Path) -> None:
    (results.parent / "conf" / "experiment").mkdir(parents=True)
    stages = [
        {"name": "ending", "how": how, "size": size} for how, size in (("loop", 0.0), ("memory", 900.0), ("well", 1.0))
    ]
    experiment = {"experiment": "limits", "target": "surface", "grid": {"surface": stages}}
    text = "# @package _global_\n" + json.dumps(experiment)
    (results.parent / "conf" / "experiment" / "limits.yaml").write_text(text)
    done = run("limits", "resources.time=3", "resources.memory=700")
    assert done.returncode == 1 and "Traceback" not in done.stderr, done.stderr
    assert "surface/ending: it was ended after 3 s, the limit resources.time" in done.stderr
    assert "surface/ending: Unable to allocate 900. MiB" in done.stderr
    assert len(list(results.glob("store/*/*/record.json"))) == 1
    assert (results / "limits" / "report.html").exists()
    for wrong, said in (("resources.time=-1", "greater than 0"), ("resources.tme=1", "'time' or 'memory'"),
                        ("resources.time=soon", "valid number")):  # fmt: skip
        done = run("limits", wrong)
        assert done.returncode == 2 and said in done.stderr and len(done.stderr.splitlines()) == 1, done.stderr


def edit(results: Path, text: str, hours_ago: int = 1) -> None:
    """Write the plugin's file anew, as of an hour when there was no plan yet."""
    file = results.parent / "plugins" / "surface" / "ending.py"
    file.write_text(text)
    long_ago = time.time() - 3600 * hours_ago
    os.utime(file, (long_ago, long_ago))


def test_no_result_of_edited_code_is_stored_under_the_key_of_what_was_planned(results: Path) -> None:
    """Whenever it is edited, whatever its time says, and also where the process has imported the edited code only."""
    plan, path = plan_of(results, ("well", 1.0), ("well", 2.0), ("well", 3.0))
    first, second, third = (leaf.key for leaf in plan.leaves)
    server = Server(plan, path)
    edit(results, "# a word\n" + ENDS, 3)
    assert server.ask([first])[first]["code"] == 0
    edit(results, ENDS.replace("Surface(TriangleMesh(size", "Surface(TriangleMesh(7 * size"))
    assert server.ask([second])[second]["code"] == 1
    server.end()
    late = Server(plan, path)
    assert late.ask([second])[second]["code"] == 1
    edit(results, ENDS, 2)
    assert late.ask([third])[third]["code"] == 1
    late.end()
    for key in (second, third):
        assert "the code was edited after this run was planned" in read_event(results, "surface", key)["failure"]
        assert not store.is_done(results, "surface", key)


def test_code_that_is_edited_while_its_stage_runs_gives_no_result(
    results: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    plan, path = plan_of(results, ("well", 1.0))
    (leaf,) = plan.leaves
    edited = ENDS.replace("2.0 * size", "3.0 * size")
    method = registry.plugin("surface", "ending")

    def running(**options: Any) -> Any:
        edit(results, edited)
        return method.function(**options)

    monkeypatch.setitem(registry.PLUGINS, ("surface", "ending"), replace(method, function=running))
    assert stage.run_stage(path, leaf.key) == 1 and not store.is_done(results, "surface", leaf.key)
    assert "the code was edited" in read_event(results, "surface", leaf.key)["failure"]


def test_a_death_by_a_signal_without_a_name() -> None:
    assert "signal 40 (unnamed)" in death(-40) and "signal 15 (SIGTERM)" in death(-signal.SIGTERM)
    assert os.waitstatus_to_exitcode(9) == -9
