"""The seconds of a stage are those of its computation, not of the compiler that the first call waits for."""

from __future__ import annotations

import time

import numba
import pytest

from surfexp.lab.running.clock import clocked


def busy(seconds: float) -> None:
    end = time.process_time() + seconds
    while time.process_time() < end:
        pass


def test_compilation_is_no_part_of_the_seconds() -> None:
    @numba.njit
    def total(count: int) -> float:
        found = 0.0
        for number in range(count):
            found += number**0.5
        return found

    with clocked() as first:
        busy(0.05)
        total(10)
    with clocked() as second:
        busy(0.05)
        total(10)
    assert first.compiling > 0.02 and second.compiling == 0.0
    assert 0.05 <= second.seconds <= first.seconds < 0.05 + 0.5 * first.compiling


def test_a_block_that_fails_is_clocked_and_nobody_listens_any_more() -> None:
    with pytest.raises(ZeroDivisionError), clocked() as clock:
        busy(0.02)
        _ = 1 / 0
    taken = clock.seconds
    numba.njit(lambda x: x + 1.0)(1)
    assert clock.seconds == taken >= 0.02 and clock.compiling == 0.0
