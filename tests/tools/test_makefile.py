"""What make sets for all that it starts."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def test_imported_modules_stay_compiled_whatever_the_environment_says() -> None:
    """Otherwise each of some hundred processes of the tests compiles 2,500 modules anew."""
    show = '--eval=show:;@echo "[$$PYTHONDONTWRITEBYTECODE]"'
    environment = {**os.environ, "PYTHONDONTWRITEBYTECODE": "1"}
    done = subprocess.run(["make", "-s", show, "show"], cwd=ROOT, env=environment, capture_output=True, text=True)
    assert done.stdout.strip() == "[]", done.stderr
