"""The harness of fuzzing: what it calls wrong, and the inputs that were wrong once or reach the corners of a reader."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import pytest

from audits.torture.fuzzing import CORPUS, EXPERIMENT, judged, targets
from audits.torture.laboratory import EXPERIMENT as SMALL
from audits.torture.sound_files import write_sound_files
from surfexp.lab.errors import UserError

INPUTS = sorted(file for file in CORPUS.glob("*/*") if file.is_file())


def test_sound_files_are_read_and_are_all_targets(tmp_path: Path) -> None:
    sound = write_sound_files(tmp_path)
    (tmp_path / EXPERIMENT).write_text(SMALL)
    known = targets()
    assert {name for name in sound if not name.endswith((".gz", ".vert"))} | {EXPERIMENT} == set(known)
    for name, read in known.items():
        read(tmp_path / name)


@pytest.mark.parametrize(
    ("error", "wrong"),
    [
        (ValueError("a.off has no face"), ""),
        (UserError("e.yaml, line 2: not YAML"), ""),
        (ValueError("x" * 400), "characters"),
        (ValueError("a\nb"), "several lines"),
        (ValueError(""), "says nothing"),
    ],
)
def test_refusals_are_judged_by_their_line(tmp_path: Path, error: Exception, wrong: str) -> None:
    def read(file: Path) -> None:
        raise error

    found = judged(read, tmp_path / "a.off")
    assert wrong in found and bool(found) == bool(wrong)


def test_the_folder_is_no_part_of_the_line_and_other_errors_end_the_run(tmp_path: Path) -> None:
    deep = tmp_path / ("d" * 200) / "a.off"

    def refuse(file: Path) -> None:
        raise ValueError(f"{file} {'x' * 200}")

    def fail(file: Path) -> None:
        raise IndexError(f"{file}")

    assert not judged(refuse, deep)
    with pytest.raises(IndexError):
        judged(fail, deep)


@pytest.mark.parametrize("file", INPUTS, ids=lambda file: f"{file.parent.name}/{file.name[:12]}")
def test_inputs_that_were_found_once(file: Path, tmp_path: Path) -> None:
    name = file.parent.name
    (tmp_path / "a.vert").write_bytes(b"".join(b"%g 0 1\n" % x for x in np.arange(42.0)))
    (tmp_path / name).write_bytes(file.read_bytes())
    begin = time.monotonic()
    assert judged(targets()[name], tmp_path / name) == ""
    assert time.monotonic() - begin < 10.0
