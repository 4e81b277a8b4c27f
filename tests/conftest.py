"""Shared fixtures: one thread, and a numba cache of its own for the present state of the code."""

from __future__ import annotations

import hashlib
import os
from pathlib import Path

import pytest

for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[variable] = "1"

ROOT = Path(__file__).resolve().parent.parent
_state = hashlib.sha256(b"".join(path.read_bytes() for path in sorted((ROOT / "surfexp").rglob("*.py")))).hexdigest()[
    :20
]
os.environ["NUMBA_CACHE_DIR"] = str(ROOT / "results" / "cache" / "numba" / f"tests-{_state}")


@pytest.fixture
def working_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder to work in, so that results, `.snakemake` and the database belong to one test."""
    monkeypatch.chdir(tmp_path)
    return tmp_path
