"""What the terminal says of a run: what tells stages apart, what they took, how long the rest may take."""

from __future__ import annotations

import io
import json
import os
import time
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rich.console import Console

from surfexp.commands.progress import Progress, _view, clock
from surfexp.commands.stage_words import LONGEST, stage_words
from surfexp.lab.plan.outcome import event_path
from surfexp.lab.plan.plan import Node


def node(key: str, plugin: str, kind: str = "solver", inputs: dict[str, str] | None = None, **options: object) -> Node:
    return Node(key, kind, plugin, "f", "c", "", dict(options), dict(inputs or {}))


def plan(*nodes: Node) -> dict[str, Node]:
    return {one.key: one for one in nodes}


def test_options_upstream_that_differ_tell_stages_apart() -> None:
    nodes = plan(
        node("n1", "noisy", "image", noise=10.0),
        node("n2", "noisy", "image", noise=20.0),
        node("s1", "pd", inputs={"image": "n1"}, tolerance=1e-4),
        node("s2", "pd", inputs={"image": "n2"}, tolerance=1e-4),
        node("s3", "newton", inputs={"image": "n2"}),
    )
    assert stage_words(nodes, list(nodes.values())) == {
        "n1": "noise 10", "n2": "noise 20", "s1": "noise 10", "s2": "noise 20", "s3": "",
    }  # fmt: skip


def test_an_option_that_another_plugin_lacks_says_nothing_new() -> None:
    nodes = plan(
        node("a", "cup", "surface", vertices=4000),
        node("b", "file", "surface", path="x.ply", unit="mm"),
        node("s1", "pd", inputs={"surface": "a"}),
        node("s2", "pd", inputs={"surface": "b"}),
    )
    words = stage_words(nodes, [nodes["s1"], nodes["s2"]])
    assert words == {"s1": "cup", "s2": "file"}


def test_words_are_short_and_a_large_run_goes_without() -> None:
    nodes = plan(*(node(f"s{k}", "pd", text="x" * 100 + str(k)) for k in range(3)))
    assert all(len(word) <= LONGEST for word in stage_words(nodes, list(nodes.values())).values())
    many = [node(f"s{k}", "pd", tolerance=k) for k in range(3001)]
    assert stage_words(plan(*many), many) == {}


def end(results: Path, one: Node, **event: object) -> None:
    place = event_path(results, one.kind, one.key)
    place.parent.mkdir(parents=True, exist_ok=True)
    place.write_text(json.dumps(event))


def test_lines_count_and_name_and_measure_each_stage_once(tmp_path: Path) -> None:
    shown = [node(f"s{k}", "pd", seed=k) for k in range(3)]
    progress = Progress(plan(*shown), shown, tmp_path)
    assert progress.ended() == [] and progress.state().startswith("0 of 3 done, 0:00")
    end(tmp_path, shown[1], seconds=1.25)
    assert progress.ended() == ["[1/3] solver/pd  seed 1  1.2 s"]
    end(tmp_path, shown[0], failure="no memory", seconds=0.1)
    end(tmp_path, shown[2])
    assert progress.ended() == ["[2/3] solver/pd  seed 0  failed", "[3/3] solver/pd  seed 2"]
    assert progress.ended() == [] and progress.state().startswith("2 of 3 done, 1 failed")


def test_running_stages_say_what_they_write(tmp_path: Path) -> None:
    shown = [node("a", "pd"), node("b", "pd")]
    progress = Progress(plan(*shown), shown, tmp_path)
    place = event_path(tmp_path, "solver", "b").with_suffix(".progress")
    place.parent.mkdir(parents=True)
    place.write_text("iteration 300, gap 1.0e-03")
    assert progress.running() == ["solver/pd  0:00  iteration 300, gap 1.0e-03"]


def test_the_view_of_a_terminal_has_a_line_for_the_bar_the_state_and_each_stage(tmp_path: Path) -> None:
    shown = [node(f"s{k}", "pd", seed=k) for k in range(20)]
    progress = Progress(plan(*shown), shown, tmp_path)
    for one in shown[:15]:
        place = event_path(tmp_path, "solver", one.key).with_suffix(".progress")
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_text("started")
    console = Console(width=80, file=io.StringIO(), record=True, force_terminal=True)
    console.print(_view(progress))
    bar, state, first, *_, last = console.export_text().rstrip().splitlines()
    assert set(bar) <= set("━╺╸ ") and state.startswith("0 of 20 done, 0:00")
    assert first.split() == ["solver/pd", "seed", "0", "0:00"] and last == "  and 3 more"


def test_the_rest_is_what_like_stages_took_at_the_pace_so_far(tmp_path: Path) -> None:
    quick = [node(f"q{k}", "quick") for k in range(4)]
    slow = [node(f"s{k}", "slow") for k in range(4)]
    progress = Progress(plan(*quick, *slow), quick + slow, tmp_path)
    for one in quick[:3]:
        end(tmp_path, one, seconds=1.0)
    end(tmp_path, slow[0], seconds=7.0)
    progress.ended()
    assert progress.remaining() is None  # too early
    progress.began -= 5.0  # ten processor seconds in five
    assert progress.remaining() == pytest.approx((1.0 + 3 * 7.0) / 2.0, rel=0.01)
    assert "about 0:11 more" in progress.state()


def test_a_stage_that_says_nothing_for_ten_minutes_is_named_once(tmp_path: Path) -> None:
    shown = [node("a", "pd"), node("b", "pd", seed=1)]
    progress = Progress(plan(*shown), shown, tmp_path)
    place = event_path(tmp_path, "solver", "b").with_suffix(".progress")
    place.parent.mkdir(parents=True)
    place.write_text("started")
    assert progress.silent() == []
    os.utime(place, (time.time() - 700.0,) * 2)
    assert [line[:55] for line in progress.silent()] == ["surfexp: warning: solver/pd  seed 1: no progress for 10"]
    assert progress.silent() == []


@given(st.floats(0, 1e6))
def test_clocks_never_say_sixty(seconds: float) -> None:
    said = clock(seconds)
    assert ":60" not in said and " 60" not in said
    assert clock(59.6) == "1:00" and clock(3599) == "59:59" and clock(3600) == "1 h 00 min"
