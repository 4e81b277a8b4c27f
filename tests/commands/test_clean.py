"""What `clean` removes lies below the results folder itself: no link is followed or taken away."""

from __future__ import annotations

import copy
import os
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from audits.benchmarks.synthetic_results import fill, plan_of, sweep
from surfexp.commands.command_line import main
from surfexp.lab.plan.plan import Plan
from surfexp.lab.store.store import is_done


def test_clean_follows_no_link(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    results, elsewhere = tmp_path / "results", tmp_path / "elsewhere"
    (elsewhere / "spectrum/key").mkdir(parents=True)
    (elsewhere / "spectrum/key/result.npz").write_bytes(b"mine")
    (elsewhere / "empty").mkdir()
    results.mkdir()
    (results / "store").symlink_to(elsewhere)
    main(["clean", "--all", "--yes", "--results", str(results)])
    assert (elsewhere / "empty").is_dir()
    assert (elsewhere / "spectrum/key/result.npz").read_bytes() == b"mine"
    assert "left alone: 1" in capsys.readouterr().err


def test_clean_leaves_a_link_among_results(tmp_path: Path) -> None:
    results, elsewhere = tmp_path / "results", tmp_path / "elsewhere"
    elsewhere.mkdir()
    (elsewhere / "mine").write_bytes(b"mine")
    (results / "store/spectrum/old").mkdir(parents=True)
    (results / "store/spectrum/old/broken").symlink_to("nowhere")
    (results / "store/spectrum/linked").symlink_to(elsewhere)
    assert main(["clean", "--all", "--yes", "--results", str(results)]) == 0
    assert (elsewhere / "mine").exists()
    assert not (results / "store/spectrum/old").exists()
    assert (results / "store/spectrum/linked").is_symlink()


def finished(results: Path, time: int, **options: Any) -> Plan:
    plan = plan_of({**sweep(2), **options}, results)
    fill(plan, results)
    os.utime(plan.write(results), (time, time))
    return plan


def of_other_code(plan: Plan, results: Path, time: int) -> Plan:
    """The same rows with other keys at their ends."""
    edited = copy.deepcopy(plan)
    for leaf in edited.leaves:
        node = edited.nodes.pop(leaf.key)
        leaf.key = leaf.key[::-1]
        edited.nodes[leaf.key] = replace(node, key=leaf.key)
    fill(edited, results)
    os.utime(edited.write(results), (time, time))
    return edited


def left(plan: Plan, results: Path) -> list[bool]:
    return [is_done(results, node.kind, node.key) for node in plan.stored]


def test_what_any_plan_names_is_kept(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    earlier = finished(tmp_path, 1)
    later = finished(tmp_path, 2, solver="newton")
    (tmp_path / "store/solver/abc").mkdir()
    assert main(["clean", "--yes", "--results", str(tmp_path)]) == 0
    assert "1 entries, 0.0 MB" in capsys.readouterr().out and not (tmp_path / "store/solver/abc").exists()
    for arguments in ([], ["--older"]):
        assert main(["clean", *arguments, "--yes", "--results", str(tmp_path)]) == 0
        assert "nothing to remove: plans name every stored result" in capsys.readouterr().out
        assert all(left(earlier, tmp_path) + left(later, tmp_path))


def test_plans_of_older_code_are_given_up_where_that_is_asked_for(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    old, other = finished(tmp_path, 1), finished(tmp_path, 2, solver="newton")
    new = of_other_code(old, tmp_path, 3)
    assert main(["clean", "--yes", "--results", str(tmp_path)]) == 0
    assert all(left(old, tmp_path)) and "--older" in capsys.readouterr().out
    assert main(["clean", "--older", "--yes", "--results", str(tmp_path)]) == 0
    assert "3 entries" in (said := capsys.readouterr().out) and "with plans of synthetic" in said
    assert all(left(new, tmp_path) + left(other, tmp_path)) and len(list((tmp_path / "plans").glob("*.json"))) == 2
    assert left(old, tmp_path).count(False) == len(old.leaves) == 2


def test_a_plan_that_cannot_be_read_removes_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    plan = finished(tmp_path, 1)
    (tmp_path / "plans/other-1.json").write_text("{")
    assert main(["clean", "--yes", "--results", str(tmp_path)]) == 2
    assert "other-1.json cannot be read" in capsys.readouterr().err and all(left(plan, tmp_path))
