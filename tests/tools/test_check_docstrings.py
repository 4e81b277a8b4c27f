"""The check of docstrings covers what users get into their hands, and names what is missing."""

from __future__ import annotations

import inspect

import pytest

import surfexp as sx
from surfexp.embedding.distance import Distance
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.tasks.fingerprints import Fingerprints
from surfexp.tasks.spectrum_of_surface import Spectrum

pytest.importorskip("numpydoc", reason="development only")
from tests.check_docstrings import handed_out, main, members

# without the indentation, which Python 3.13 takes away by itself
DENOISE = inspect.getdoc(sx.denoise) or ""


def test_what_functions_return_and_fields_hold_is_covered() -> None:
    assert {Distance, Fingerprints} <= set(handed_out([sx.distance, sx.fingerprint]))
    assert TriangleMesh in handed_out([sx.shape])  # a field of what it returns
    assert {"first", "between", "count_below", "values"} == set(members(Spectrum))
    assert {"edge_length", "genus"} <= set(members(TriangleMesh))  # cached properties


@pytest.mark.parametrize(
    ("faulty", "code"),
    [
        (
            DENOISE.replace("weight : float, optional\n", "wait : float, optional\n"),
            "PR01 Parameters {'weight'} not documented",
        ),
        (
            DENOISE.replace("weight : float, optional\n", "wait : float, optional\n"),
            "PR02 Unknown parameters {'wait'}",
        ),
        (DENOISE.replace("weight : float, optional\n", "weight\n"), 'PR04 Parameter "weight" has no type'),
        (DENOISE.replace("Returns\n-------\n", "Notes\n-----\n"), "RT01 No Returns section found"),
        (DENOISE.replace("Examples\n--------\n", "Notes\n-----\n"), "EX01 No examples section found"),
        ("", "GL08 The object does not have a docstring"),
    ],
)
def test_what_is_missing_is_named(
    faulty: str, code: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sx, "__all__", ["denoise"])
    assert main() == 0
    monkeypatch.setattr(sx.denoise, "__doc__", faulty)
    assert main() == 1
    printed = capsys.readouterr().out
    assert f"surfexp.tasks.denoising.denoise: {code}" in printed and "surfexp/tasks/denoising.py:" in printed
