"""Shared fixtures: one thread, and a numba cache of its own for the present state of the code."""

from __future__ import annotations

import gc
import os
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

from surfexp.lab.plan.code_digests import compiled_state
from surfexp.lab.running import compiled_code

settings.register_profile("unhurried", deadline=None, suppress_health_check=[HealthCheck.too_slow], derandomize=True)
settings.load_profile("unhurried")

for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[variable] = "1"

compiled_code.use(compiled_state())


@pytest.fixture
def working_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder to work in, so that results, `.snakemake` and the database belong to one test."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


# seconds to minutes each: the others run beside them
LONGEST = (
    "test_command_line.py",
    "test_plugins.py",
    "test_collections.py",
    "test_distribution.py",
    "test_new_command.py",
)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Begin with the longest files. Each stays in one process (`--dist loadfile`), which compiles and prepares once."""
    items.sort(key=lambda item: LONGEST.index(item.path.name) if item.path.name in LONGEST else len(LONGEST))


def pytest_collection_finish() -> None:
    """Leave what is imported out of collections of garbage: statsmodels asks for one at each correction of Holm's."""
    gc.collect()
    gc.freeze()
