"""Strong copyleft among the dependencies is refused with its name and with who brings it."""

from __future__ import annotations

import re
from importlib.metadata import distribution
from pathlib import Path

import pytest

pytest.importorskip("numpydoc", reason="development only: all of the lock")
from tests import check_licences
from tests.check_licences import is_strong, main, needed_by


@pytest.mark.parametrize(
    ("stated", "strong"),
    [
        ("MIT", False),
        ("LGPL-2.1-or-later", False),
        ("GNU Lesser General Public License v3 (LGPLv3)", False),
        ("MIT OR GPL-3.0-or-later", False),
        ("GPL-3.0-or-later WITH GCC-exception-3.1", False),
        ("GPLv3", True),
        ("AGPL-3.0-only", True),
        ("GNU General Public License v2 (GPLv2)", True),
        ("GNU Affero General Public License v3", True),
        ("BSD-3-Clause AND GPL-2.0-only", True),
    ],
)
def test_strong_copyleft_is_told_from_weak_and_from_choices(stated: str, strong: bool) -> None:
    assert is_strong(stated) == strong


def test_a_dependency_knows_who_brings_it() -> None:
    users = needed_by()
    assert "core" in users["numpy"] and "core" in users["llvmlite"]  # llvmlite by numba, too
    assert users["pillow"] >= {"figures", "lab", "all"} and "core" not in users["hydra-core"]


def test_the_copyleft_part_of_libigl_is_not_imported() -> None:
    files = [
        file for folder in ("surfexp", "plugins", "studies") for file in (check_licences.ROOT / folder).rglob("*.py")
    ]
    assert len(files) > 500 and not [file for file in files if "igl.copyleft" in file.read_text(encoding="utf-8")]


def copyleft_files(package: str) -> list[str]:
    """Files of a wheel that are named after a copyleft library, or are its licence without an exception for runtimes."""
    found = []
    for path in distribution(package).files or []:
        name, place = str(path).lower(), Path(str(path.locate()))
        if re.search(r"copyleft|cgal|tetgen|cholmod|suitesparse|[^l]gpl", name) and "testing" not in name:
            found.append(str(path))
        elif re.match(r"licen[cs]e|copying", path.name.lower()) and place.suffix in ("", ".txt", ".md", ".rst"):
            text = place.read_text(encoding="utf-8", errors="replace")
            if re.search(r"(?<!LESSER )GENERAL PUBLIC LICENSE", text) and not re.search(
                "exception", text, re.IGNORECASE
            ):
                found.append(str(path))
    return found


def test_no_wheel_of_the_core_holds_a_copyleft_part() -> None:
    core = sorted(name for name, users in needed_by().items() if "core" in users)
    assert {"numpy", "scipy", "numba", "scikit-learn", "nibabel"} <= set(core) and "libigl" not in core
    assert {name: files for name in core if (files := copyleft_files(name))} == {}
    assert any("copyleft" in name for name in copyleft_files("libigl"))


def test_a_copyleft_dependency_is_refused(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    sound = check_licences.licence
    assert main() == 0
    monkeypatch.setattr(check_licences, "licence", lambda it: "GPLv3" if it.name == "networkx" else sound(it))
    assert main() == 1
    assert "'GPLv3', wanted by all, " in (printed := capsys.readouterr().out) and "core" in printed
    monkeypatch.setattr(check_licences, "licence", lambda it: "" if it.name == "networkx" else sound(it))
    assert main() == 1
    monkeypatch.setattr(check_licences, "licence", sound)
    monkeypatch.setitem(check_licences.HELD, "networkx", ("networkx/*.py", b"no such mark", "a part"))
    assert main() == 1
