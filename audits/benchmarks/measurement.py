"""Processor and wall seconds of a piece of work, and of the iterations inside it."""

from __future__ import annotations

import resource
import sys
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path
from statistics import median
from typing import Any, TypeVar

Result = TypeVar("Result")
Other = TypeVar("Other")
LONG = 40.0


@dataclass(frozen=True)
class Cost:
    """Median seconds of one piece of work.

    Parameters
    ----------
    cpu, wall : float
    runs : int
        How many the median is of.
    """

    cpu: float
    wall: float
    runs: int = 1


def measure(work: Callable[[], Result], runs: int = 3) -> tuple[Result, Cost]:
    """Return what the last run gave and the median cost; work of more than 40 s of processor is run once."""
    costs: list[tuple[float, float]] = []
    while len(costs) < runs:
        result, cost = _timed(work)
        costs.append(cost)
        if costs[0][0] > LONG:
            break
    return result, median_cost(costs)


def measure_both(
    ours: Callable[[], Result], theirs: Callable[[], Other], runs: int = 3
) -> tuple[tuple[Result, Cost], tuple[Other, Cost]]:
    """Return what the last runs of both sides gave and their median costs, run in turn and equally often.

    Where the rival takes more than 40 s of processor, each side is run once.
    """
    our_costs: list[tuple[float, float]] = []
    their_costs: list[tuple[float, float]] = []
    while len(their_costs) < runs:
        theirs_found, their_cost = _timed(theirs)
        ours_found, our_cost = _timed(ours)
        their_costs.append(their_cost)
        our_costs.append(our_cost)
        if their_costs[0][0] > LONG:
            break
    return (ours_found, median_cost(our_costs)), (theirs_found, median_cost(their_costs))


def least_count(enough: Callable[[int], bool], low: int, high: int) -> int:
    """Return the least count in (low, high] that is enough, by bisection; `low` is not and `high` is."""
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if enough(middle) else (middle, high)
    return high


def _timed(work: Callable[[], Result]) -> tuple[Result, tuple[float, float]]:
    wall, cpu = time.perf_counter(), time.process_time()
    result = work()
    return result, (time.process_time() - cpu, time.perf_counter() - wall)


def apart(work: Callable[..., Result], *arguments: Any) -> Result:
    """Return what a module's function gives in a new process, whose memory is its own."""
    with ProcessPoolExecutor(1, get_context("spawn")) as pool:
        return pool.submit(work, *arguments).result()


def measure_with_memory(work: Callable[[], Result], runs: int = 3) -> tuple[Result, Cost, float]:
    """Return also the bytes by which the peak resident memory of this process grew; see `apart`."""
    before = peak_memory()
    result, cost = measure(work, runs)
    return result, cost, peak_memory() - before


def median_cost(costs: list[tuple[float, float]]) -> Cost:
    """Return the medians of (cpu, wall) pairs."""
    return Cost(median(cpu for cpu, _ in costs), median(wall for _, wall in costs), len(costs))


def cost_of_children(work: Callable[[], object]) -> Cost:
    """Return what the processes that one piece of work starts, and waits for, take together."""
    before, wall = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    work()
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return Cost(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, time.perf_counter() - wall)


class IterationClock:
    """Seconds from the start of each solve to its last iteration, so that an audit of the result is not counted.

    Give `tick` to a solver as its progress callback and call `start` before each solve.
    """

    def __init__(self) -> None:
        self.cpu = self.wall = 0.0
        self._last = (0.0, 0.0)

    def start(self) -> None:
        """Begin a solve."""
        self._last = (time.process_time(), time.perf_counter())

    def tick(self, iteration: int, measure: float) -> None:
        """Note the end of an iteration."""
        cpu, wall = time.process_time(), time.perf_counter()
        self.cpu += cpu - self._last[0]
        self.wall += wall - self._last[1]
        self._last = (cpu, wall)


def peak_memory() -> float:
    """Bytes; on Linux of this program alone, since there `getrusage` begins with those of the process that started it."""
    status = Path("/proc/self/status")
    if status.exists():
        line = next(row for row in status.read_text().splitlines() if row.startswith("VmHWM"))
        return 1024.0 * int(line.split()[1])
    unit = 1 if sys.platform == "darwin" else 1024
    return float(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit)
