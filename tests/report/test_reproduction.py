"""The page of verdicts says of which state of the code it is, and is called stale when that is another."""

from __future__ import annotations

import dataclasses
import platform
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from surfexp.commands.command_line import main
from surfexp.lab.experiment.claim import read_claims
from surfexp.lab.experiment.configuration import expand
from surfexp.lab.plan.plan import Plan
from surfexp.lab.plan.resolution import make_plan
from surfexp.lab.registry.loading import load_all
from surfexp.lab.running import stage
from surfexp.lab.store.kinds import KINDS
from surfexp.records.table import rows_of
from surfexp.report.verdict import judge
from surfexp.reproduction import page as reproduction
from surfexp.reproduction import stamp
from surfexp.reproduction.index import pages_of
from surfexp.reproduction.page import reproduction as page_of
from surfexp.reproduction.pages import INDEX, read_pages, write_pages
from surfexp.reproduction.statements import Statement, statements

load_all(Path("/nonexistent"))
STATE = "a" * 20, "b" * 20
CLAIM = {
    "claim": "the sphere has its area | nearly",
    "published": {"table 9.9": "12.57"},
    "quantity": {"all": "area"},
    "between": [12.5, 12.6],
    "because": "a polyhedron inside the sphere",
    "cause": "found",
}


@pytest.fixture
def plan(tmp_path: Path) -> Plan:
    context: dict[str, Any] = {"target": "surface", "experiment": "ball", "title": "A ball", "results": str(tmp_path)}
    context |= {"surface": {"name": "icosphere", "levels": 4}, "claims": [CLAIM, CLAIM | {"between": [1, 2]}]}
    context |= {"chapter": [2, 1]}
    plan = make_plan(expand(context))
    path = plan.write(tmp_path)
    for key, node in plan.nodes.items():
        if KINDS[node.kind].stored:
            assert stage.run_stage(path, key) == 0
    return plan


def test_the_page_has_counts_stamp_and_all_of_a_verdict(
    plan: Plan, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(stamp, "state_of_code", lambda: STATE)
    page = page_of({"ball": plan}, tmp_path)
    assert "- The dissertation: 2 claims, 1 not reproduced, 1 reproduced" in page and f"experiments {STATE[1]}" in page
    assert "1 stages, 0 without result" in page and "processor hours" in page and "peak memory" in page
    assert platform.node() not in page.split("##")[0]
    row = next(line for line in page.splitlines() if "**reproduced**" in line)
    cells = reproduction.cells_of_line(row)
    assert cells[0] == CLAIM["claim"] and cells[1:6] == [
        "table 9.9: 12.57",
        "all area",
        "12.5 to 12.6",
        CLAIM["because"],
        "1",
    ]
    assert len(cells) == len(reproduction.HEADER) and cells[-1] == "found"


def test_verdicts_are_read_back_as_they_were_written(plan: Plan, tmp_path: Path) -> None:
    claims = [CLAIM, CLAIM | {"claim": "it does not", "between": [1, 2], "cause": ""}]
    judged = judge(read_claims(claims), rows_of(plan, tmp_path))
    read = reproduction.verdicts_of_section(reproduction.section("ball", "A ball", judged, "a" * 20))
    assert read == {item.claim.claim: [item.verdict, item.number, item.why or "–"] for item in judged}
    assert [found[0] for found in read.values()] == ["reproduced", "not reproduced"]


def test_another_state_makes_the_page_stale(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    page = f"State: commit 1234, numerics {STATE[0]}, experiments {STATE[1]}."
    monkeypatch.setattr(stamp, "state_of_code", lambda: STATE)
    assert stamp.staleness(page) == "" and "does not say" in stamp.staleness("# The dissertation")
    monkeypatch.setattr(stamp, "state_of_code", lambda: (STATE[0], "c" * 20))
    monkeypatch.setattr(stamp, "stale_experiments", lambda page: ["one", "two"])
    assert stamp.staleness(page) == "2 experiments have changed (one, two)"
    index = tmp_path / INDEX
    index.write_text(page)
    with pytest.raises(ValueError, match="2 experiments have changed"):
        stamp.renew(tmp_path)
    monkeypatch.setattr(stamp, "stale_experiments", lambda page: [])
    assert stamp.staleness(page).endswith("no stage changed")
    stamp.renew(tmp_path)
    assert stamp.staleness(index.read_text()) == "" and index.read_text().startswith("State: ")


def test_other_sections_are_taken_over_as_they_are(plan: Plan, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(stamp, "state_of_code", lambda: STATE)
    first = page_of({"ball": plan, "other": plan}, tmp_path)
    assert [name for name, _ in stamp.SECTION.findall(first)] == ["ball", "other"] and "4 claims, 2 not" in first
    edited = first.replace("state " + stamp.state_of_plan(plan), "state " + "d" * 20).replace("a polyhedron", "a solid")
    assert edited.count("a solid") == 4
    second = page_of({"ball": plan}, tmp_path, edited)
    assert stamp.SECTION.findall(second) == [("ball", stamp.state_of_plan(plan)), ("other", "d" * 20)]
    assert second.count("a solid") == 2 and "4 claims, 2 not reproduced, 2 reproduced" in second
    assert second.count("\nRun: ") == 1 and "\nThen: ball. " in second
    assert page_of({"ball": plan, "other": plan}, tmp_path, second).count("\nThen: ") == 0


STATED = (
    Statement("table 9.9", "2.1", "The sphere has the area 4 pi.", verdicts=("ball",)),
    Statement("figure 2.1", "2.1", "A sketch.", none="a drawing"),
    Statement("figure 3.1", "3.1", "Nobody ran it.", verdicts=("absent",)),
)


@pytest.fixture
def document(plan: Plan, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """Of one experiment of chapter 2, with a third claim that cannot be compared, and of one without a chapter."""
    monkeypatch.setattr(stamp, "state_of_code", lambda: STATE)
    other = {"between": "not comparable", "because": "Another ball.", "claim": "as large as his"}
    plan.settings.claims[:] = [CLAIM, CLAIM | {"claim": "ours", "between": [1, 2], "published": {}}, CLAIM | other]
    ours = plan.settings.model_copy(update={"chapter": None})
    apart = dataclasses.replace(plan, settings=ours) if dataclasses.is_dataclass(plan) else plan
    return page_of({"ball": plan, "other": apart}, tmp_path)


def test_the_index_has_a_line_for_each_place_with_both_numbers_and_a_link(document: str) -> None:
    pages = pages_of(document, STATED)
    assert set(pages) == {"reproduction.md", "reproduction/chapter_2.md", "reproduction/beyond.md"}
    index = pages[INDEX]
    assert "- The dissertation: 4 claims, 2 not comparable, 2 reproduced\n- Ours: 2 claims, 2 does not hold\n" in index
    line = next(line for line in index.splitlines() if line.startswith("| table 9.9 |"))
    cells = reproduction.cells_of_line(line)
    assert cells[1] == "The sphere has the area 4 pi."
    assert cells[2] == "2 reproduced, 2 not comparable"  # of two experiments
    assert cells[3].startswith("12.57: area 12.5") and cells[4] == "[ball](reproduction/chapter_2.md#ball)"
    assert "| figure 2.1 | A sketch. | none: a drawing | – | – |" in index
    assert "| figure 3.1 | Nobody ran it. | not computed | – | absent |" in index
    assert "Ours: [ball](reproduction/chapter_2.md#ball) does not hold." in index
    assert "\n## ball\n" in pages["reproduction/chapter_2.md"] and "\n## other\n" in pages["reproduction/beyond.md"]


def test_pages_are_read_back_as_the_document_they_were_made_of(document: str, tmp_path: Path) -> None:
    (tmp_path / "reproduction").mkdir()
    left = tmp_path / "reproduction" / "chapter_6.md"
    left.write_text("# Chapter 6\n\n## gone\n")
    write_pages(pages_of(document, STATED), tmp_path)
    again = read_pages(tmp_path)
    assert not left.exists() and reproduction.sections_of(again) == reproduction.sections_of(document)
    assert again.split("\n## ")[0].strip() == document.split("\n## ")[0].strip()
    assert pages_of(again, STATED) == pages_of(document, STATED)
    assert read_pages(tmp_path / "absent.md") == "" and read_pages(tmp_path / INDEX).startswith("# The dissertation")


def test_every_place_of_the_dissertation_is_in_the_index_once(document: str) -> None:
    lines = pages_of(document)[INDEX].splitlines()
    for item in statements():
        assert sum(line.startswith(f"| {item.id} |") for line in lines) == 1


def test_the_command_writes_the_pages_and_takes_others_over(
    plan: Plan, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(stamp, "state_of_code", lambda: STATE)
    docs = tmp_path / "docs"
    write_pages(pages_of(page_of({"ball": plan, "other": plan}, tmp_path), STATED), docs)
    asked = ["report", "ball", "--claims", "--results", str(tmp_path), "--beside", str(docs), "--pages", str(docs)]
    assert main(asked) == 0 and capsys.readouterr().out == ""
    written = read_pages(docs)
    assert list(reproduction.sections_of(written)) == ["ball", "other"] and "\nThen: ball. " in written
    monkeypatch.setattr(stamp, "state_of_code", lambda: ("f" * 20, "e" * 20))
    assert main(asked) == 0, "the other section is of the state before"
    assert stamp.STATE.search(read_pages(docs)) is not None and "f" * 20 not in stamp.STATE.findall(read_pages(docs))[0]
    assert main(asked[:-2]) == 0
    assert capsys.readouterr().out.startswith("# The dissertation, checked")


def test_an_experiment_is_stale_by_its_keys_or_its_claims(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of all experiments one is planned: the others are the same code."""
    own = [file for file in stamp._experiment_files() if file.stem in ("isospectral_drums", "config")]
    monkeypatch.setattr(stamp, "_experiment_files", lambda: own)
    assert stamp.stale_experiments("") == ["isospectral_drums"]
    page = f"`surfexp run experiment=isospectral_drums`; state {'e' * 20}"
    assert stamp.stale_experiments(page) == ["isospectral_drums"]
    monkeypatch.setattr(stamp, "state_of_plan", lambda plan: "e" * 20)
    assert stamp.stale_experiments(page) == []


def test_the_state_of_a_plan_follows_stages_and_claims(plan: Plan) -> None:
    before = stamp.state_of_plan(plan)
    plan.settings.claims[0]["between"] = [12.0, 12.6]
    moved = stamp.state_of_plan(plan)
    plan.nodes["other"] = next(iter(plan.nodes.values()))
    assert len({before, moved, stamp.state_of_plan(plan)}) == 3


def test_lint_warns_of_a_stale_page_and_does_not_fail(
    working_folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(stamp, "state_of_code", lambda: STATE)
    assert stamp.main(["check"]) == 0
    assert capsys.readouterr().out.startswith("warning: docs/reproduction.md is stale")
    (working_folder / "docs").mkdir()
    (working_folder / stamp.PAGES / INDEX).write_text(f"numerics {STATE[0]}, experiments {STATE[1]}")
    assert stamp.main(["check"]) == 0 and capsys.readouterr().out == ""


def test_the_state_follows_the_meaning_of_the_numerics_only(monkeypatch: pytest.MonkeyPatch) -> None:
    first = stamp.state_of_code()
    assert all(len(part) == 20 for part in first) and first == stamp.state_of_code()
    monkeypatch.setattr(stamp, "source_facts", lambda source: SimpleNamespace(meaning=str(source)))
    assert stamp.state_of_code()[0] != first[0] and stamp.state_of_code()[1] == first[1]
