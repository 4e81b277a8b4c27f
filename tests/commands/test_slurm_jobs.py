"""What is asked of Slurm, and what its jobs' ends are in words, from texts as Snakemake writes them."""

from __future__ import annotations

import signal
from pathlib import Path

import pytest

from surfexp.commands import slurm_jobs
from surfexp.lab.errors import UserError
from surfexp.lab.plan.plan import Node
from surfexp.lab.registry.folders import package_folder
from surfexp.lab.running.stage_process import death

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


def node(key: str, kind: str, *inputs: str) -> Node:
    return Node(key, kind, "plugin", "f", "c", "", {}, {str(place): one for place, one in enumerate(inputs)})


def measure(results: Path, kind: str, *taken: tuple[float, float]) -> None:
    folder = results / "logs" / kind
    folder.mkdir(parents=True)
    for number, (seconds, memory) in enumerate(taken):
        row = f"{seconds}\t0:00:00\t{memory}\t1"
        (folder / f"{number}.benchmark.tsv").write_text(f"s\th:m:s\tmax_rss\tcpu_time\n{row}\n")
    (folder / "short.benchmark.tsv").write_text("s\th:m:s\tmax_rss\tcpu_time\n0.1\t0:00:00\tNA\tNA\n")
    (folder / "empty.benchmark.tsv").write_text("")


CHAIN = {
    one.key: one
    for one in (
        node("a", "surface"), node("b", "operator", "a"), node("c", "solver", "a", "b"), node("d", "figure", "c"),
        node("e", "image", "a"),
    )
}  # fmt: skip
PREPARATION = {"groups": {"surface": "preparation", "operator": "preparation"}}


def requests(results: Path, nodes: dict[str, Node], **settings: object) -> dict[str, list[str]]:
    """Return what is asked for, by the name of Snakemake's option."""
    found: dict[str, list[str]] = {}
    for word in slurm_jobs.requests(nodes, list(nodes.values()), results, settings):
        if word.startswith("--"):
            found[word] = []
        else:
            found[list(found)[-1]].append(word)
    return found


def test_requests_follow_what_was_measured_and_leave_room(tmp_path: Path) -> None:
    assert requests(tmp_path, CHAIN, **PREPARATION) == {}
    measure(tmp_path, "solver", (1200.0, 3000.4), (1.0, 200.0))
    measure(tmp_path, "figure", (30.0, 200.0))
    measure(tmp_path, "eigensolver", (30.0, 200.0))
    asked = ["figure:mem_mb=2000", "figure:runtime=10", "solver:mem_mb=6001", "solver:runtime=60"]
    assert requests(tmp_path, CHAIN, **PREPARATION) == {"--set-resources": asked}
    assert requests(tmp_path, CHAIN, **{"set-resources": ["solver:mem_mb=1"]}) == {}


def test_kinds_that_took_seconds_are_put_together(tmp_path: Path) -> None:
    measure(tmp_path, "solver", (5.0, 200.0), (7.0, 200.0))
    asked = requests(tmp_path, CHAIN, **PREPARATION)
    assert asked["--set-resources"] == ["solver:mem_mb=2000", "solver:runtime=1"]
    assert asked["--groups"] == ["surface=preparation", "operator=preparation", "solver=solver"]
    assert asked["--group-components"] == ["solver=20"]
    measure(tmp_path, "surface", (0.01, 200.0))
    measure(tmp_path, "operator", (0.02, 200.0))
    assert requests(tmp_path, CHAIN, **PREPARATION)["--group-components"] == ["preparation=100", "solver=20"]
    kept = requests(tmp_path, CHAIN, **PREPARATION, **{"group-components": ["preparation=3"]})
    assert set(kept) == {"--set-resources"}


def test_kinds_that_wait_for_each_other_are_not_put_together(tmp_path: Path) -> None:
    for kind in ("surface", "operator", "solver", "figure"):
        measure(tmp_path, kind, (1.0, 200.0))
    again = CHAIN | {"f": node("f", "surface", "c"), "g": node("g", "figure", "f")}  # a surface made from a solution
    assert requests(tmp_path, again, **PREPARATION)["--group-components"] == ["figure=100"]


def test_a_signal_is_no_word_of_a_stage() -> None:
    assert slurm_jobs.unexplained({})
    assert slurm_jobs.unexplained({"failure": f"surface/file: {death(-signal.SIGTERM)}"})
    assert not slurm_jobs.unexplained({"failure": "surface/file: no such file"})
    assert not slurm_jobs.unexplained({"seconds": 1.0})


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


def test_a_profile_of_slurm_is_refused_at_once_where_there_is_none(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(UserError, match="profiles/slurm submits jobs to Slurm, but sbatch and squeue cannot be found"):
        slurm_jobs.check_slurm("profiles/slurm")
    for name in slurm_jobs.COMMANDS:
        (tmp_path / name).write_text("#!/bin/sh\n")
        (tmp_path / name).chmod(0o755)
    slurm_jobs.check_slurm("profiles/slurm")
