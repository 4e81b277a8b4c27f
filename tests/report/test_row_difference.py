"""Two rows side by side, and the pages that can be opened."""

from __future__ import annotations

import webbrowser
from pathlib import Path

import pytest

from surfexp.commands.command_line import main
from surfexp.lab.plan.plan import Leaf
from surfexp.records.table import Row
from surfexp.report.row_difference import differing_options, numbers_beside


def row(seconds: float | None, parameters: dict[str, object], **metrics: float) -> Row:
    return Row(Leaf("key", "configuration", {"target": "solver"}), parameters, metrics, seconds)


def test_only_what_differs_is_told_of_options_and_all_of_numbers() -> None:
    one = row(2.0, {"solver.name": "newton", "solver.tolerance": 1e-4, "surface.name": "cup"}, gap=1e-4, rmse=0.0)
    other = row(None, {"solver.name": "newton", "solver.step": 3, "surface.name": "cap"}, gap=2e-4, rmse=5.0, psnr=7.0)
    assert differing_options(one, other) == {
        "solver.tolerance": (1e-4, "–"),
        "surface.name": ("cup", "cap"),
        "solver.step": ("–", 3),
    }
    found = numbers_beside(one, other)
    assert found["gap"] == (1e-4, 2e-4, 1e-4, 2.0) and found["rmse"] == (0.0, 5.0, 5.0, None)
    assert found["psnr"] == (None, 7.0, None, None) and found["seconds"] == (2.0, None, None, None)
    assert not differing_options(one, one)


def test_a_row_that_is_not_there_is_named(working_folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["diff", "0123456789", "0123456788"]) == 2
    assert "unknown experiment or run in results '0123456789'" in capsys.readouterr().err


def test_a_page_is_opened_or_named(
    working_folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    opened: list[str] = []
    monkeypatch.setattr(webbrowser, "open", opened.append)
    assert main(["open"]) == 2 and "surfexp run" in capsys.readouterr().err
    (working_folder / "results" / "a b").mkdir(parents=True)
    for page in ("index.html", "a b/report.html"):
        (working_folder / "results" / page).write_text("")
    assert main(["open"]) == 0 and main(["open", "a b"]) == 0
    assert [Path(page).name for page in opened] == ["index.html", "report.html"] and "a%20b" in opened[1]
    assert main(["open", "a c"]) == 2
    assert "did you mean 'a b'?" in capsys.readouterr().err
