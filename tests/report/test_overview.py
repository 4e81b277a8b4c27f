"""The overview of a results folder lists what is there, the newest first, and takes nothing from a summary but text."""

from __future__ import annotations

import fcntl
import html
import json
import shlex
from pathlib import Path

import pytest

from audits.benchmarks.synthetic_results import fill, plan_of, sweep
from surfexp.commands import results_lock
from surfexp.commands.command_line import main
from surfexp.records.origin import note_origin, read_origin
from surfexp.report.overview import FILE, is_ours, write_overview
from surfexp.report.page import write_report

SUMMARY = {
    "title": "T",
    "question": "Q?",
    "date": "2026-01-02 03:04",
    "rows": 2,
    "failed": 0,
    "limited": 1,
    "seconds": 3,
}
SUMMARY |= {"verdicts": {"holds": 2, "does not hold": 1}, "picture": "error-1a2b3c4d.png"}


def summarise(results: Path, name: str, **changes: object) -> None:
    (results / name).mkdir(parents=True)
    (results / name / "report.html").write_text("")
    (results / name / FILE).write_text(json.dumps(SUMMARY | changes))


def overview(results: Path) -> str:
    write_overview(results)
    return (results / "index.html").read_text()


def test_experiments_are_listed_the_newest_first(tmp_path: Path) -> None:
    summarise(tmp_path, "old", date="2025-12-31 23:59")
    summarise(tmp_path, "new")
    page = overview(tmp_path)
    assert page.index('href="./new/report.html"') < page.index('href="./old/report.html"')
    assert "2 rows" in page and "1 row did not converge" in page and "2 holds" in page and "1 does not hold" in page
    assert (
        'src="./new/figures/error-1a2b3c4d.png"' in page and "3 s of processor time without the stages before" in page
    )


def test_what_a_summary_says_is_text(tmp_path: Path) -> None:
    summarise(tmp_path, "evil", title="<script>1</script>", picture="../../../etc/passwd", question="<b>")
    summarise(tmp_path, "odd", rows="many")
    summarise(tmp_path, "list", verdicts=[1])
    summarise(tmp_path, "huge", rows=10**400, seconds=1e300)
    summarise(tmp_path, "https:evil.example", title="elsewhere")
    for name, text in {"infinite": json.dumps(SUMMARY).replace(": 2", ": 1e999"), "deep": "[" * 200000}.items():
        summarise(tmp_path, name)
        (tmp_path / name / FILE).write_text(text)
    summarise(tmp_path, "surrogate", title="\ud800")
    (tmp_path / "half").mkdir()
    (tmp_path / "half" / FILE).write_text('{"title": ')
    (tmp_path / "gone").mkdir()
    (tmp_path / "gone" / FILE).write_text(json.dumps(SUMMARY))
    page = overview(tmp_path)
    assert "<script>1" not in page and "&lt;script&gt;1" in page and "passwd" not in page and "&lt;b&gt;" in page
    assert page.count("<article>") == 4 and 'href="https:' not in page and 'href="./https%3Aevil' in page


def test_an_index_of_somebody_else_is_left_alone(tmp_path: Path) -> None:
    summarise(tmp_path, "new")
    (tmp_path / "index.html").write_text("<h1>mine</h1>")
    assert overview(tmp_path) == "<h1>mine</h1>" and not is_ours(tmp_path / "index.html")
    (tmp_path / "index.html").unlink()
    overview(tmp_path)
    assert is_ours(tmp_path / "index.html") and "<article>" in overview(tmp_path)


def test_a_report_adds_its_experiment_and_says_how_it_was_made(tmp_path: Path) -> None:
    plan = plan_of(sweep(3), tmp_path)
    fill(plan, tmp_path)
    first = (write_report(plan, tmp_path) / "report.html").read_text()
    assert "Last computed" not in first and 'href="./synthetic/report.html"' in (tmp_path / "index.html").read_text()
    note_origin(tmp_path, plan, ["experiment=synthetic", "grid.x=[1, 2]"], computed=True)
    (file,) = (tmp_path / plan.settings.experiment / "origin").iterdir()
    second = (write_report(plan, tmp_path) / "report.html").read_text()
    assert "surfexp run experiment=synthetic &#39;grid.x=[1, 2]&#39;" in second
    assert read_origin(tmp_path, plan)["commit"] in second
    for commit, said in (
        ("0123abcd", "surfexp 1.2.3 at commit 0123abcd, Python"),
        ("release 1.2.3", "surfexp release 1.2.3, Python"),
    ):
        origin = read_origin(tmp_path, plan) | {"version": "1.2.3", "commit": commit}
        file.write_text(json.dumps(origin))
        third = (write_report(plan, tmp_path) / "report.html").read_text()
        assert said in third and "working folder" not in third
    file.write_text("[]")
    assert "Last computed" not in (write_report(plan, tmp_path) / "report.html").read_text()


def test_a_command_belongs_to_the_plan_that_it_asks_for(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    plan, other = plan_of(sweep(2), tmp_path), plan_of({**sweep(2), "solver": "newton"}, tmp_path)
    part = plan_of(sweep(1), tmp_path)
    for one, asked, computed, shown, dated in [
        (plan, "", True, "", True),
        (other, " solver=newton", True, " solver=newton", True),
        (plan, " cores=1", False, "", True),
        (part, " 'solver.tolerance=[0.1]'", False, " 'solver.tolerance=[0.1]'", False),
    ]:
        fill(one, tmp_path)
        one.write(tmp_path)
        note_origin(tmp_path, one, ["experiment=synthetic", *shlex.split(asked)], computed)
        assert main(["table", "synthetic", "--format", "latex", "--results", str(tmp_path)]) == 0
        assert capsys.readouterr().out.startswith(f"% surfexp run experiment=synthetic{shown}\n")
        page = html.unescape((write_report(one, tmp_path) / "report.html").read_text())
        assert f"<code>surfexp run experiment=synthetic{shown}</code>" in page
        assert ("Last computed" in page) == dated


@pytest.mark.parametrize("words", [["report", "synthetic"], ["clean", "--yes"]])
def test_what_writes_into_a_folder_waits_for_no_run_and_writes_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], words: list[str]
) -> None:
    plan = plan_of(sweep(1), tmp_path)
    fill(plan, tmp_path)
    plan.write(tmp_path)
    monkeypatch.setattr(results_lock, "locks", [])
    with (tmp_path / ".lock").open("w") as run:
        fcntl.flock(run, fcntl.LOCK_EX)
        assert main([*words, "--results", str(tmp_path)]) == 2
    assert "in use by another run" in capsys.readouterr().err and not (tmp_path / "synthetic").exists()
    assert main([*words, "--results", str(tmp_path)]) == 0
