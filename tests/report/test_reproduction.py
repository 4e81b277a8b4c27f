"""The page of verdicts says of which state of the code it is, and is called stale when that is another."""

from __future__ import annotations

import platform
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

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
from surfexp.reproduction.page import reproduction as page_of

load_all(Path("/nonexistent"))
STATE = "a" * 20, "b" * 20
CLAIM = {
    "claim": "the sphere has its area | nearly",
    "published": {"table": "9.9", "value": "12.57"},
    "quantity": "all",
    "metric": "area",
    "between": [12.5, 12.6],
    "because": "a polyhedron inside the sphere",
    "cause": "found",
}


@pytest.fixture
def plan(tmp_path: Path) -> Plan:
    context: dict[str, Any] = {"target": "surface", "experiment": "ball", "title": "A ball", "results": str(tmp_path)}
    context |= {"surface": {"name": "icosphere", "levels": 4}, "claims": [CLAIM, CLAIM | {"between": [1, 2]}]}
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
    assert "2 claims: 1 not reproduced, 1 reproduced." in page and f"experiments {STATE[1]}" in page
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


def test_another_state_makes_the_page_stale(monkeypatch: pytest.MonkeyPatch) -> None:
    page = f"State: commit 1234, numerics {STATE[0]}, experiments {STATE[1]}."
    monkeypatch.setattr(stamp, "state_of_code", lambda: STATE)
    assert stamp.staleness(page) == "" and "does not say" in stamp.staleness("# Published claims")
    monkeypatch.setattr(stamp, "state_of_code", lambda: (STATE[0], "c" * 20))
    monkeypatch.setattr(stamp, "stale_experiments", lambda page: ["one", "two"])
    assert stamp.staleness(page) == "2 experiments have changed (one, two)"
    with pytest.raises(ValueError, match="2 experiments have changed"):
        stamp.renew(page)
    monkeypatch.setattr(stamp, "stale_experiments", lambda page: [])
    assert stamp.staleness(page).endswith("no stage changed")
    renewed = stamp.renew(page)
    assert stamp.staleness(renewed) == "" and renewed.startswith("State: ")


def test_other_sections_are_taken_over_as_they_are(plan: Plan, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(stamp, "state_of_code", lambda: STATE)
    first = page_of({"ball": plan, "other": plan}, tmp_path)
    assert [name for name, _ in stamp.SECTION.findall(first)] == ["ball", "other"] and "4 claims: 2 not" in first
    edited = first.replace("state " + stamp.state_of_plan(plan), "state " + "d" * 20).replace("a polyhedron", "a solid")
    assert edited.count("a solid") == 4
    second = page_of({"ball": plan}, tmp_path, edited)
    assert stamp.SECTION.findall(second) == [("ball", stamp.state_of_plan(plan)), ("other", "d" * 20)]
    assert second.count("a solid") == 2 and "4 claims: 2 not reproduced, 2 reproduced." in second
    assert second.count("\nRun: ") == 1 and "\nThen: ball. " in second
    assert page_of({"ball": plan, "other": plan}, tmp_path, second).count("\nThen: ") == 0


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
    (working_folder / stamp.PAGE).write_text(f"numerics {STATE[0]}, experiments {STATE[1]}")
    assert stamp.main(["check"]) == 0 and capsys.readouterr().out == ""


def test_the_state_follows_the_meaning_of_the_numerics_only(monkeypatch: pytest.MonkeyPatch) -> None:
    first = stamp.state_of_code()
    assert all(len(part) == 20 for part in first) and first == stamp.state_of_code()
    monkeypatch.setattr(stamp, "source_facts", lambda source: SimpleNamespace(meaning=str(source)))
    assert stamp.state_of_code()[0] != first[0] and stamp.state_of_code()[1] == first[1]
