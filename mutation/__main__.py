"""`python -m mutation [WORD ...]`: plant the faults one by one in a copy, run their tests, fail if one survives."""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from mutation.fault import Fault
from mutation.geometry_faults import GEOMETRY_FAULTS
from mutation.variational_faults import VARIATIONAL_FAULTS

ROOT = Path(__file__).resolve().parent.parent
PASSED, FAILED = 0, 1
FAULTS = VARIATIONAL_FAULTS + GEOMETRY_FAULTS
SEEDED = "import surfexp; assert surfexp.__path__[0].startswith({root!r}), surfexp.__path__"


def main() -> None:
    """Run the faults whose names contain one of the words, all by default."""
    parser = argparse.ArgumentParser(prog="mutation", description=__doc__)
    parser.add_argument("words", nargs="*", metavar="WORD", help="part of the name of a fault")
    options = parser.parse_args()
    faults = [fault for fault in FAULTS if not options.words or any(word in fault.name for word in options.words)]
    if not faults:
        parser.error(
            f"no fault has {' or '.join(map(repr, options.words))} in its name, the first is {FAULTS[0].name!r}"
        )
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder).resolve()
        _copy_to(copy)
        problems = _untouched(copy, faults) or [problem for fault in faults if (problem := _try(copy, fault))]
    print("\n".join(problems) if problems else f"all {len(faults)} faults caught")
    sys.exit(1 if problems else 0)


def _copy_to(copy: Path) -> None:
    for name in ("surfexp", "tests", "examples"):
        shutil.copytree(ROOT / name, copy / name, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(ROOT / "pyproject.toml", copy)
    subprocess.run([sys.executable, "-c", SEEDED.format(root=str(copy))], cwd=copy, check=True)


def _untouched(copy: Path, faults: list[Fault]) -> list[str]:
    """The tests have to pass before a fault is planted, else their failing proves nothing."""
    code, reason = _pytest(copy, sorted({test for fault in faults for test in fault.tests}))
    return [] if code == PASSED else [f"the tests do not pass on the untouched copy: {reason}"]


def _try(copy: Path, fault: Fault) -> str:
    """Return why the fault was not caught, or nothing."""
    path, begin = copy / "surfexp" / fault.path, time.perf_counter()
    source = path.read_text(encoding="utf-8")
    try:
        path.write_text(fault.planted(source), encoding="utf-8")
        code, reason = _pytest(copy, fault.tests)
    except ValueError as error:
        return str(error)
    finally:
        path.write_text(source, encoding="utf-8")
    words = {PASSED: "SURVIVED", FAILED: "caught"}.get(code, f"pytest ended with code {code}")
    print(f"{words:8} {time.perf_counter() - begin:5.1f} s  {fault.name} ({fault.path})\n    {reason}", flush=True)
    return "" if code == FAILED else f"{words}: {fault.name} ({fault.path}) {reason}"


def _pytest(copy: Path, tests: list[str] | tuple[str, ...]) -> tuple[int, str]:
    """Run tests of the copy until one fails; return pytest's code and which test failed how.

    Nothing compiled is kept: numba looks for changes only in the file of a function, not in those that it calls.
    """
    command = [sys.executable, "-m", "pytest", "-q", "-x", "--no-header", "-p", "no:cacheprovider"]
    with tempfile.TemporaryDirectory() as cache:
        environment = os.environ | {"PYTHONDONTWRITEBYTECODE": "1", "PYTHONPATH": str(copy), "COLUMNS": "200"}
        run = subprocess.run(
            [*command, *(f"tests/{test}" for test in tests)],
            cwd=copy,
            env=environment | {"NUMBA_CACHE_DIR": cache},
            capture_output=True,
            text=True,
        )
    rows = [row for row in run.stdout.splitlines() if row.startswith(("FAILED", "ERROR"))]
    return run.returncode, rows[0] if rows else run.stderr[-500:]


if __name__ == "__main__":
    main()
