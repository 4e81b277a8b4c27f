"""What is asked of Slurm, and what its jobs' ends are in words, from texts as Snakemake writes them."""

from __future__ import annotations

from pathlib import Path

import pytest

from surfexp.commands import slurm_jobs
from surfexp.workflow.registry import package_folder

LOG = """\
Job 16 has been submitted with SLURM jobid 110 (log: /w/.snakemake/slurm_logs/rule_solver/a4/110.log).
[Tue Nov 24 11:37:39 2026]
Error in rule solver:
    message: SLURM-job '110' failed, SLURM status is: 'CANCELLED'.
    output: /w/results/store/solver/a4ceb1e9f94fb148d6b9/record.json
    log: /w/results/logs/solver/a4.log, /w/.snakemake/slurm_logs/rule_solver/a4/110.log (check log file(s))
[Tue Nov 24 11:37:39 2026]
    message: Error in group preparation
    log: /w/.snakemake/slurm_logs/group_preparation/93.log (check log file(s) for error details)
    jobs:
        rule operator:
            output: /w/results/store/operator/d91ec00f2d2d0f4d1add/record.json
        rule surface:
            output: /w/results/store/surface/001f6747618374dfc18d/record.json
[Tue Nov 24 11:37:39 2026]
rule solver:
    output: /w/results/store/solver/ffffffffffffffffffff/record.json
"""


def test_jobs_that_ended_without_a_word_are_found_alone_and_in_groups(monkeypatch: pytest.MonkeyPatch) -> None:
    said = {"--jobs=110": ["CANCELLED"]}
    monkeypatch.setattr(slurm_jobs, "_lines", lambda *command: said.get(command[3], []))
    found = slurm_jobs.ended_jobs(LOG)
    assert found["a4ceb1e9f94fb148d6b9"].startswith("its job 110 in Slurm ended as CANCELLED; see /w/.snakemake/slurm")
    group = "its job 93 in Slurm ended without a result; see /w/.snakemake/slurm_logs/group_preparation/93.log"
    assert found["d91ec00f2d2d0f4d1add"] == found["001f6747618374dfc18d"] == group
    assert len(found) == 3


def test_requests_follow_what_was_measured_and_leave_room(tmp_path: Path) -> None:
    header = "s\th:m:s\tmax_rss\tcpu_time"
    for kind, seconds, memory in (("solver", 1200.0, 3000.4), ("surface", 1.0, 200.0)):
        folder = tmp_path / "logs" / kind
        folder.mkdir(parents=True)
        (folder / "a.benchmark.tsv").write_text(f"{header}\n{seconds}\t0:20:00\t{memory}\t1\n")
        (folder / "b.benchmark.tsv").write_text(f"{header}\n0.1\t0:00:00\tNA\tNA\n")
        (folder / "c.benchmark.tsv").write_text("")
    asked = slurm_jobs.requests(tmp_path, ["solver", "surface", "solver", "image"])
    assert asked == ["--set-resources", "solver:mem_mb=6001", "solver:runtime=60", "surface:mem_mb=2000",
                     "surface:runtime=10"]  # fmt: skip
    assert slurm_jobs.requests(tmp_path, ["image"]) == []


def test_a_reason_to_wait_is_said_once_and_names_the_node(monkeypatch: pytest.MonkeyPatch) -> None:
    away = "ReqNodeNotAvail, UnavailableNodes:n7"
    said = {"squeue": ["Priority", "Resources", away, away], "sinfo": ["n7: disk", "n7: disk"]}
    monkeypatch.setattr(slurm_jobs, "_lines", lambda *command: said[command[0]])
    queue = slurm_jobs.Queue()
    assert queue() == []
    queue.asked -= slurm_jobs.PAUSE
    (line,) = queue()
    assert "2 of your jobs: ReqNodeNotAvail, UnavailableNodes:n7 (n7: disk)" in line
    queue.asked -= slurm_jobs.PAUSE
    assert queue() == []


def test_slurm_that_is_not_there_says_nothing() -> None:
    assert slurm_jobs._lines("a-command-that-nobody-has") == []


def test_the_profile_that_comes_with_the_package_is_one_of_slurm() -> None:
    assert slurm_jobs.settings_of(package_folder("surfexp.profiles") / "slurm")["executor"] == "slurm"
    assert "executor" not in slurm_jobs.settings_of(package_folder("surfexp.profiles") / "default")
