"""Bad days on purpose: how a case ended is told truly, and the faults are faults."""

from __future__ import annotations

import json
import os
import signal
import time
from collections import Counter
from dataclasses import asdict
from pathlib import Path

import pytest

from audits.torture import groups as torture_page
from audits.torture.bad_files import contents, surfaces
from audits.torture.case import HUNG, REFUSED, RIGHT, WRONG, Ended, clear, in_a_child
from audits.torture.kills import _below
from audits.torture.sound_files import write_sound_files


def refuse(text: str) -> tuple[str, str]:
    raise ValueError(text)


@pytest.mark.parametrize(
    ("work", "outcome", "said"),
    [
        (lambda: (RIGHT, "as it is"), RIGHT, "as it is"),
        (lambda: refuse("no faces"), REFUSED, "no faces"),
        (lambda: refuse("one\ntwo"), WRONG, "several lines"),
        (lambda: refuse(""), WRONG, "says nothing"),
        (lambda: refuse("x" * 301), WRONG, "301 characters"),
        (lambda: {"": ("", "")}["key"], WRONG, "KeyError"),
        (lambda: os._exit(3), WRONG, "status"),
        (lambda: os.kill(os.getpid(), signal.SIGSEGV), WRONG, "status"),
        (lambda: (RIGHT, str(len(b"x" * 2**28))), WRONG, "MemoryError"),
        (lambda: time.sleep(60), HUNG, "not done after"),
    ],
)
def test_every_end_of_a_case_is_told(work: object, outcome: str, said: str) -> None:
    ended = in_a_child("kind", "name", work, seconds=3.0, memory=2**27)  # type: ignore[arg-type]
    assert ended.outcome == outcome and said in ended.said


def test_what_a_clear_line_is() -> None:
    assert not clear("a.ply has 3 flipped faces: surfexp repair a.ply")
    assert (
        clear("unexpected TypeError in a.py:7: x")
        and not clear("a.csv: unexpected end of data")
        and clear("Traceback (most recent call last)")
        and clear(" \n ")
    )


def test_bad_files_are_many_differ_from_the_sound_ones_and_repeat(tmp_path: Path) -> None:
    sound = write_sound_files(tmp_path)
    cases = list(contents(sound, 0))
    counts = Counter(kind.split(" that")[0] for kind, _, _ in cases)
    assert len(cases) >= 600 and counts["cut off"] == 17 * len(sound)
    assert all(content != sound.get(name) for kind, name, content in cases if kind in ("cut off", "UTF-16"))
    assert [content for _, _, content in contents(sound, 0)] == [content for _, _, content in cases]
    assert len({kind for kind, _ in surfaces(0)}) >= 18


def test_processes_below_one_are_found() -> None:
    child = os.fork()
    if child == 0:
        time.sleep(60)
        os._exit(0)
    assert child in _below(os.getpid())
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)


def test_the_page_counts_what_was_run_and_names_what_was_not(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(torture_page, "FOLDER", tmp_path)
    cases = [Ended("cut off", "a.ply", REFUSED, "too short"), Ended("cut off", "b.ply", RIGHT, "")]
    cases.append(Ended("zeros", "c.gii", HUNG, "not done after 10 s"))
    for group, some in (("files", cases), ("names", cases[:1])):
        (tmp_path / f"{group}.json").write_text(json.dumps({"seconds": 1.0, "cases": [asdict(case) for case in some]}))
    page = tmp_path / "page.md"
    page.write_text("# Reliability\n\nold\n\n## Files that other programs write\n\nkept\n")
    torture_page._write_page(page)
    text = page.read_text()
    assert text.endswith("\n## Files that other programs write\n\nkept\n") and "old" not in text
    assert "**Not run here: damages, requests, misdeeds, strangers, kills, drivers.**" in text
    assert (
        "| files: cut off | 2 | 1 | 0 | 1 | 0 | 0 | 0 |" in text and "| **all** | 4 | 2 | 0 | 1 | 0 | 0 | 1 |" in text
    )
    assert "- hung: zeros, c.gii: not done after 10 s" in text
