"""What needs an optional package is marked, or no run with these packages would ask it."""

from __future__ import annotations

import ast
import re
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent


def locked(name: str) -> set[str]:
    """Packages by the name that they are imported under, where it is nearly that of the wheel."""
    return set(re.findall(r"^([a-z0-9-]+?)(?:-cpu)?==", (ROOT / name).read_text(encoding="utf-8"), re.M))


def unmarked(source: str, packages: set[str]) -> list[str]:
    """Tests that are skipped for want of one of the packages, without the mark."""
    found = []
    for test in ast.walk(ast.parse(source)):
        if isinstance(test, ast.FunctionDef) and test.name.startswith("test_"):
            marked = any(ast.unparse(mark) == "pytest.mark.optional" for mark in test.decorator_list)
            needs = [
                call.args[0].value
                for call in ast.walk(test)
                if isinstance(call, ast.Call)
                and ast.unparse(call.func) == "pytest.importorskip"
                and isinstance(call.args[0], ast.Constant)
            ]
            named = {str(name).partition(".")[0].replace("_", "-").lower() for name in needs}
            if named & packages and not marked:
                found.append(test.name)
    return found


def test_what_needs_an_optional_package_is_marked() -> None:
    packages = locked("requirements-optional.lock") - locked("requirements.lock")
    assert {"vtk", "open3d", "cvxpy", "lapy", "resvg-py"} <= packages
    source = "def test_a():\n    pytest.importorskip('vtk.util')\n"
    assert unmarked(source, packages) == ["test_a"]
    assert not unmarked(f"@pytest.mark.optional\n{source}", packages)
    for file in (ROOT / "tests").rglob("test_*.py"):
        assert unmarked(file.read_text(encoding="utf-8"), packages) == [], file.name
