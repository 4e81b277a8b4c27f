"""Files of packages: each outcome is found where it is due, and no reader can stop the others."""

from __future__ import annotations

import io
import os
import subprocess
import tarfile
import time
from pathlib import Path

import numpy as np
import pytest

from audits.reliability import corpus, packages
from audits.reliability.agreement import disagreement
from audits.reliability.corpus import ALONE, REFUSED, RIGHT, WRONG, Outcome, in_process, judged, tables
from audits.reliability.packages import Package, fetch, unpack
from audits.reliability.truth import Found

OFF = "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n"
VERTICES = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
FACES = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]


@pytest.mark.parametrize(
    ("text", "outcome", "said"),
    [
        (OFF, RIGHT, ""),
        ("OFF\n2 0 0\n0 0 0\n1 0 0\n", REFUSED, "points without faces"),
        (OFF.replace("3 1 2 3", "3 1 2 9"), REFUSED, "a face names a vertex that is not there"),
        (OFF.replace("OFF", "FOO"), REFUSED, "another format"),
        ("OFF\n", WRONG, "a.off cannot be read as a mesh: the counts of vertices and faces are missing"),
    ],
)
def test_outcomes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, text: str, outcome: str, said: str) -> None:
    monkeypatch.setattr(corpus, "SECONDS", 10)  # VTK waits for the counts for ever
    path = tmp_path / "a.off"
    path.write_text(text)
    found = judged("ours", path)
    assert (found.outcome, found.said) == (outcome, said)


@pytest.mark.parametrize(("other", "outcome"), [(FACES, RIGHT), (FACES[:3], WRONG), ([], ALONE)])
def test_another_reader_decides(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, other: list, outcome: str) -> None:
    path = tmp_path / "a.off"
    path.write_text(OFF)
    monkeypatch.setattr(corpus, "theirs", lambda path, kind: [("other", lambda path: Found(VERTICES, other))])
    assert judged("ours", path).outcome == outcome


def test_a_crash_and_an_endless_reader_are_answers(monkeypatch: pytest.MonkeyPatch) -> None:
    assert "signal" in str(in_process(lambda: os.abort()))
    monkeypatch.setattr(corpus, "SECONDS", 0.2)
    begin = time.monotonic()
    assert "0.2 s" in str(in_process(lambda: time.sleep(60)))
    assert time.monotonic() - begin < 10


L = np.array([[0.0, 0, 0], [2, 0, 0], [2, 2, 0], [0.8, 0.4, 0], [0, 2, 0]])
EARS, FAN = [[0, 1, 3], [1, 2, 3], [0, 3, 4]], [[1, 2, 3], [1, 3, 4], [1, 4, 0]]


def test_a_fan_agrees_with_ears_and_not_the_other_way() -> None:
    assert not disagreement(Found(L, EARS), Found(L, FAN))
    assert disagreement(Found(L, FAN), Found(L, EARS))


@pytest.mark.parametrize(
    "other",
    [Found(VERTICES, FACES[:3]), Found(VERTICES * 2, FACES), Found(VERTICES, [face[::-1] for face in FACES])],
)
def test_other_surfaces_differ(other: Found) -> None:
    assert disagreement(Found(VERTICES, FACES), other)
    assert not disagreement(Found(VERTICES, FACES), Found(VERTICES, FACES))


def test_a_package_that_cannot_be_had_is_one_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    failed = subprocess.CompletedProcess([], 1, "", "looking\nERROR: no connection\n")
    monkeypatch.setattr(packages.subprocess, "run", lambda *given, **options: failed)
    folder, said = fetch(Package("some", "1.0", "wheel", ""), tmp_path)
    assert folder is None and said == "some==1.0 is left out: ERROR: no connection" and not list(tmp_path.iterdir())


def test_files_stay_in_their_folder_and_others_are_left(tmp_path: Path) -> None:
    archive = tmp_path / "a.tar.gz"
    with tarfile.open(archive, "w:gz") as tarred:
        for name in ("../up.off", "a/b.off", "a/setup.py", "a/conte69_x.csv", "a/y.csv"):
            member = tarfile.TarInfo(name)
            member.size = 3
            tarred.addfile(member, io.BytesIO(b"OFF"))
    unpack(archive, tmp_path / "out", Package("some", "1", "sdist", "", "conte69"))
    found = sorted(str(path.relative_to(tmp_path)) for path in tmp_path.rglob("*") if path.is_file())
    assert found == ["a.tar.gz", "out/a/b.off", "out/a/conte69_x.csv", "out/up.off"]


def test_tables_count_each_file_once() -> None:
    found = [
        Outcome("p", "a.off", ".off", RIGHT, "", {"one": "", "two": "cannot read it: x"}),
        Outcome("p", "b.off", ".off", REFUSED, "cut off", {"one": "finds 3 vertices, 1 faces"}),
        Outcome("q", "c.ply", ".ply", WRONG, "differs", {"one": "3 faces"}),
    ]
    text = tables(found)
    assert "| .off | 2 | 1 | 1 | 0 | 0 |" in text and text.count("| **all** | 3 | 1 | 1 | 0 | 1 |") == 2
    assert "| cut off | 1 | 1 |" in text and "| one | 2 | 1 | 1 | 0 |" in text and "| two | 1 | 0 | 0 | 1 |" in text
