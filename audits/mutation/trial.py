"""Tests run in a forked process, with or without a fault in memory: no file changes, nothing is imported anew."""

from __future__ import annotations

import importlib
import importlib.abc
import importlib.util
import json
import os
import resource
import runpy
import signal
import sys
import tempfile
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from importlib.machinery import ModuleSpec
from pathlib import Path
from types import CodeType, ModuleType

import pytest

from audits.mutation import ROOT
from audits.mutation.change import Change
from audits.mutation.import_graph import importers, module_name
from audits.mutation.stale_functions import stale_functions
from audits.mutation.watch import Watch

# pytest would read modules named *_test.py itself, past the fault in them
OPTIONS = (
    "-q",
    "-p",
    "no:cacheprovider",
    "-p",
    "no:xdist",
    "-m",
    "not slow",
    "--no-header",
    "-o",
    "python_files=test_*.py",
)
MEMORY = 8 * 2**30
TESTS_FAILED, INTERRUPTED, INTERNAL_ERROR, USAGE_ERROR, NO_TEST = 1, 2, 3, 4, 5
STOPPED = {signal.SIGINT, signal.SIGTERM, signal.SIGKILL, signal.SIGHUP}


@dataclass(frozen=True)
class Trial:
    """Tests to run, in this order, until one fails.

    Parameters
    ----------
    arguments : tuple of str
        Test files or pytest identifiers.
    change : Change, optional
        The fault.
    seconds : mapping of str to float
        Tests that are kept and the processor seconds that each takes without a fault; all tests where it is empty.
    """

    arguments: tuple[str, ...]
    change: Change | None = None
    seconds: dict[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Outcome:
    """What the tests did.

    Parameters
    ----------
    verdict : str
        "survived", "killed", "timed out", "crashed", or "broken" where the machinery failed.
    failed : tuple of str
        Tests that failed, and how.
    seconds : mapping of str to float
        Processor seconds of each test that passed, compilation taken off.
    cpu : float
        Processor seconds of the process.
    """

    verdict: str
    failed: tuple[str, ...]
    seconds: dict[str, float]
    cpu: float


def prepare() -> None:
    """Set the environment as the tests do, and import once what the forked processes share."""
    os.environ |= {"COLUMNS": "200", "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    runpy.run_path(str(ROOT / "conftest.py"))
    for name in ("numba", "scipy.sparse.linalg", "scipy.spatial", "scipy.optimize", "hypothesis.strategies", "igl",
                 "sklearn.manifold", "networkx", "ot", "nibabel", "matplotlib.figure", "skimage.measure"):  # fmt: skip
        if importlib.util.find_spec(name.split(".")[0]) is not None:
            importlib.import_module(name)


def run_all(trials: Iterable[Trial], workers: int) -> Iterator[tuple[Trial, Outcome]]:
    """Run trials, at most `workers` at a time, and give each with its outcome as it ends."""
    running: dict[int, tuple[Trial, Path]] = {}
    waiting = enumerate(trials)
    with tempfile.TemporaryDirectory() as folder:
        try:
            while True:
                while len(running) < workers and (numbered := next(waiting, None)) is not None:
                    number, trial = numbered
                    path = Path(folder) / f"{number}.jsonl"
                    running[_start(trial, path)] = trial, path
                if not running:
                    return
                process, status, usage = os.wait4(-1, 0)
                trial, path = running.pop(process)
                yield trial, _outcome(path, status, usage.ru_utime + usage.ru_stime)
        finally:
            for process in running:
                os.kill(process, signal.SIGKILL)


def _start(trial: Trial, path: Path) -> int:
    sys.stdout.flush()
    process = os.fork()
    if process:
        return process
    code = INTERNAL_ERROR
    try:
        log = os.open(path.with_suffix(".log"), os.O_WRONLY | os.O_CREAT)
        os.dup2(log, 1)
        os.dup2(log, 2)
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        os.chdir(ROOT)
        stale = stale_functions(trial.change) if trial.change else frozenset()
        if trial.change:
            _plant(trial.change, stale)
        watch = Watch(path, trial.seconds, len(stale))
        options = [*OPTIONS, *(["-x"] if trial.change else [])]
        code = int(pytest.main([*options, *trial.arguments], plugins=[watch]))
    finally:
        os._exit(code)


def _plant(change: Change, stale: frozenset[tuple[str, str]]) -> None:
    """Let the module be read with the fault, and no stale function from the disk."""
    from numba.core.dispatcher import Dispatcher

    path = ROOT / change.path
    for name in importers(path):
        sys.modules.pop(name, None)
    sys.meta_path.insert(0, _Planted(module_name(path), path, change.mutated))
    enable_caching = Dispatcher.enable_caching

    def enable(self: Dispatcher) -> None:
        if (self.py_func.__module__, self.py_func.__qualname__.split(".")[0]) not in stale:
            enable_caching(self)

    Dispatcher.enable_caching = enable  # type: ignore[method-assign]


class _Planted(importlib.abc.MetaPathFinder, importlib.abc.InspectLoader):
    """Finder and loader of the one module with the fault."""

    def __init__(self, name: str, path: Path, source: bytes) -> None:
        self._name, self._path, self._source = name, path, source

    def find_spec(self, fullname: str, path: object, target: ModuleType | None = None) -> ModuleSpec | None:
        if fullname != self._name:
            return None
        return importlib.util.spec_from_file_location(fullname, self._path, loader=self)

    def get_source(self, fullname: str) -> str:
        return self._source.decode()

    def get_code(self, fullname: str) -> CodeType:
        return compile(self._source, str(self._path), "exec", dont_inherit=True)


def _outcome(path: Path, status: int, cpu: float) -> Outcome:
    rows = [json.loads(row) for row in path.read_text().splitlines()] if path.exists() else []
    seconds = {row["test"]: row["seconds"] for row in rows if "seconds" in row}
    started = [row["test"] for row in rows if "started" in row]
    failed = tuple(f"{row['test']}: {row['failed']}" for row in rows if "failed" in row)
    if os.WIFSIGNALED(status):
        number = os.WTERMSIG(status)
        if number in STOPPED:
            return Outcome("broken", (f"ended by signal {number}",), seconds, cpu)
        verdict = "timed out" if number == signal.SIGXCPU else "crashed"
        return Outcome(verdict, (f"{started[-1] if started else 'import'}: signal {number}",), seconds, cpu)
    code = os.WEXITSTATUS(status)
    file = path.with_suffix(".log")
    log = file.read_text(errors="replace").splitlines() if file.exists() else []
    if code in (TESTS_FAILED, INTERRUPTED, USAGE_ERROR):
        return Outcome("killed", failed or (f"{log[-1] if log else 'import'} (pytest ends with {code})",), seconds, cpu)
    if code == INTERNAL_ERROR:
        return Outcome("broken", (" ".join(log[-20:]),), seconds, cpu)
    if code == NO_TEST:
        return Outcome("broken", ("no test ran: those that are slow take no part",), seconds, cpu)
    return Outcome("survived", (), seconds, cpu)
