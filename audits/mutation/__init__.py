"""Faults planted in memory, by hand and at random, each of which a test has to catch: `python -m audits.mutation`.

Why no ready-made tool: mutmut leaves decorated functions alone, which are all compiled kernels here, and cosmic-ray runs
one and the same test command in a fresh process for each fault, without a sample. Neither knows that numba's cache on
disk watches only a function's own file, so that a caller compiled earlier would hide a fault in what it calls.
"""

from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
