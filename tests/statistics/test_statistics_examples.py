"""The examples of collections print what they promise."""

from __future__ import annotations

import runpy
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).resolve().parents[2] / "docs" / "inside"


def printed(name: str, capsys: pytest.CaptureFixture[str]) -> list[str]:
    runpy.run_path(str(EXAMPLES / f"{name}.py"), run_name="__main__")
    return capsys.readouterr().out.splitlines()


@pytest.mark.slow
def test_classify_bodies(capsys: pytest.CaptureFixture[str]) -> None:
    spectra, counts = printed("classify_bodies", capsys)
    assert spectra.startswith("shape_dna: 1.00 right") and counts.startswith("nodal_counts: ")


def test_brain_structure(capsys: pytest.CaptureFixture[str]) -> None:
    first, second = printed("brain_structure", capsys)
    assert first.startswith("genus 0") and second.endswith("complete: True")
