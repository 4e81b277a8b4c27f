"""Numbers in tables of pages that no result has are found, and those of results are not."""

from __future__ import annotations

from pathlib import Path

import pytest

from audits import page_numbers


def test_a_number_that_no_result_has_is_named_with_its_row(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    results, docs = tmp_path / "results", tmp_path / "docs"
    for folder in (results / "race", docs):
        folder.mkdir(parents=True)
    (results / "race" / "metrics.csv").write_text("name,share,gap\nrof,0.8146,9.13e-05\ntgv,,nan\n")
    page = "`surfexp run experiment=race` makes it.\n\n| method | share | gap |\n|---|--:|--:|\n| rof | .81 | {gap} |\n"
    (docs / "a.md").write_text(page.format(gap="9.1e-5"))
    (docs / "b.md").write_text("| of another experiment | .123 |\n")
    assert page_numbers.main(results, docs) == 0
    (docs / "a.md").write_text(page.format(gap="9.2e-5"))
    assert page_numbers.main(results, docs) == 1
    assert capsys.readouterr().out == "a.md: 9.2e-5 in | rof | .81 | 9.2e-5 |\n"


@pytest.mark.parametrize("shown", ["81.5 %", ".81", ".815", "0.8146"])
def test_a_share_is_found_in_percent_too(shown: str) -> None:
    assert not list(page_numbers.unknown_numbers(f"| a | {shown} |", [0.8146]))
    assert list(page_numbers.unknown_numbers(f"| a | {shown} |", [0.8246]))
