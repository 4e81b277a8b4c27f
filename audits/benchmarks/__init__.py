"""Ratios to named rivals, each pair measured in one run at equal accuracy: `python -m audits.benchmarks`."""

import os
from pathlib import Path

from surfexp.lab.plan.code_digests import compiled_state
from surfexp.lab.running import compiled_code

# before numpy and numba are imported, which read these once; a line about two threads sets it for its own processes
THREADS = "BENCHMARK_THREADS"
for _variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"):
    os.environ[_variable] = os.environ.get(THREADS, "1")

ROOT = Path(__file__).resolve().parents[2]
compiled_code.use(compiled_state())
