"""A pytest plugin: order of the tests, a limit of processor seconds for each, and what they took."""

from __future__ import annotations

import json
import resource
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import Phase, settings
from numba.core.event import Event, Listener, register

# a test may take five times what it took, and compilation its share
FACTOR, SPARE, FOR_EACH_STALE, MOST_FOR_STALE = 5.0, 15.0, 3.0, 60.0
UNKNOWN = 150.0


class Watch(Listener):  # type: ignore[misc]
    """Write a line of JSON when a test starts, passes or fails.

    Parameters
    ----------
    path : Path
    seconds : dict
        Tests that are kept, in the order in which they run, and what each takes; all tests where it is empty.
    stale : int
        How many functions have to be compiled afresh.
    """

    def __init__(self, path: Path, seconds: dict[str, float], stale: int) -> None:
        self._path, self._seconds = path, seconds
        self._spare = SPARE + min(FOR_EACH_STALE * stale, MOST_FOR_STALE)
        self._depth = 0
        self._begin = self._compiling = 0.0
        register("numba:compile", self)

    def on_start(self, event: Event) -> None:
        """Note when compilation begins."""
        if not self._depth:
            self._begin = time.process_time()
        self._depth += 1

    def on_end(self, event: Event) -> None:
        """Add up the time of compilation."""
        self._depth -= 1
        if not self._depth:
            self._compiling += time.process_time() - self._begin

    def pytest_sessionstart(self) -> None:
        """Do not shrink examples that fail."""
        settings.register_profile("unshrunk", settings(), phases=(Phase.explicit, Phase.generate))
        settings.load_profile("unshrunk")

    @pytest.hookimpl(trylast=True)
    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
        """Keep the tests that were asked for, in their order."""
        if self._seconds:
            order = {name: k for k, name in enumerate(self._seconds)}
            items[:] = sorted((item for item in items if item.nodeid in order), key=lambda item: order[item.nodeid])

    @pytest.hookimpl(hookwrapper=True)
    def pytest_runtest_protocol(self, item: pytest.Item) -> Iterator[None]:
        """Limit a test and note what it takes."""
        expected = self._seconds.get(item.nodeid)
        limit = UNKNOWN if expected is None else FACTOR * expected + self._spare
        begin, self._compiling = time.process_time(), 0.0
        hard = resource.getrlimit(resource.RLIMIT_CPU)[1]
        resource.setrlimit(resource.RLIMIT_CPU, (int(begin + limit) + 1, hard))
        self._write(test=item.nodeid, started=True)
        yield
        self._write(test=item.nodeid, seconds=max(time.process_time() - begin - self._compiling, 0.0))

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Note a failure."""
        if report.failed:
            self._write(test=report.nodeid, failed=_cause(report))

    def pytest_collectreport(self, report: pytest.CollectReport) -> None:
        """Note a file that cannot be imported."""
        if report.failed:
            self._write(test=report.nodeid, failed=_cause(report))

    def _write(self, **row: object) -> None:
        with self._path.open("a") as file:
            file.write(json.dumps(row) + "\n")


def _cause(report: pytest.TestReport | pytest.CollectReport) -> str:
    crash = getattr(report.longrepr, "reprcrash", None)
    message = str(crash.message if crash else report.longrepr)
    return " ".join(message.split())[:160]
