"""Strong copyleft among the dependencies is refused with its name and with who brings it."""

from __future__ import annotations

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
