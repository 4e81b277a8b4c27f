"""Ratios to named rivals, each pair measured in one run at equal accuracy: `python -m benchmarks`."""

import hashlib
import os
from pathlib import Path

# before numpy and numba are imported, which read these once
for _variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"):
    os.environ[_variable] = "1"

ROOT = Path(__file__).resolve().parent.parent
_code = b"".join(path.read_bytes() for path in sorted((ROOT / "surfexp").rglob("*.py")))
os.environ["NUMBA_CACHE_DIR"] = str(
    ROOT / "results" / "cache" / "numba" / f"bench-{hashlib.sha256(_code).hexdigest()[:20]}"
)
