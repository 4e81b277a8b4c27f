"""Data that a package brings: found, checked, and refused in one line."""

from __future__ import annotations

import hashlib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from surfexp.anatomy.conte69 import conte69
from surfexp.anatomy.data_packages import BRAINSPACE, PACKAGES, DataPackage
from surfexp.anatomy.resting_run import connectivity_maps, frames_of_parts, resting_fsaverage5, run_on
from surfexp.commands.command_line import main
from surfexp.extras import MissingExtra
from surfexp.mesh.shapes.icosphere import icosphere


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> DataPackage:
    folder = tmp_path / "carried_maps"
    folder.mkdir()
    (folder / "__init__.py").write_text("raise RuntimeError('data packages are not imported')")
    (folder / "map.csv").write_text("1\n2\n")
    monkeypatch.syspath_prepend(tmp_path)
    digest = hashlib.sha256(b"1\n2\n").hexdigest()
    return DataPackage("carried_maps", "carried_maps==1", "free", ("quickstart",), {"map.csv": digest})


def test_a_file_is_found_without_importing_its_package(package: DataPackage) -> None:
    assert np.loadtxt(package.file("map.csv")).tolist() == [1.0, 2.0]
    assert package.faults() == []


def test_another_file_than_was_seen_is_refused(package: DataPackage) -> None:
    other = replace(package, files={"map.csv": "0" * 64, "lost.csv": "0" * 64})
    with pytest.raises(ValueError, match=r"map\.csv of carried_maps has the SHA-256 .*force-reinstall"):
        other.file("map.csv")
    with pytest.raises(ValueError, match=r"lost\.csv of carried_maps is missing"):
        other.file("lost.csv")
    assert len(other.faults()) == 2


def test_what_is_not_installed_is_named_with_what_to_install() -> None:
    absent = replace(BRAINSPACE, module="nowhere_to_be_found")
    assert absent.folder() is None and absent.faults() == []
    with pytest.raises(MissingExtra, match=r"pip install 'brainspace==0\.3\.0'"):
        absent.file(next(iter(absent.files)))


def test_fetch_checks_a_package(
    package: DataPackage, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(PACKAGES, "brainspace", package)
    assert main(["fetch", "brainspace"]) == 0
    assert "experiment=quickstart" in capsys.readouterr().out
    monkeypatch.setitem(PACKAGES, "brainspace", replace(package, files={"map.csv": "0" * 64}))
    assert main(["fetch", "brainspace"]) == 2
    assert "1 of 1 files" in capsys.readouterr().err
    monkeypatch.setitem(PACKAGES, "brainspace", replace(package, module="nowhere_to_be_found"))
    assert main(["fetch", "brainspace"]) == 2
    error = capsys.readouterr().err
    assert "pip install 'carried_maps==1'" in error and len(error.splitlines()) == 1


def test_parts_of_a_run_share_no_frame_and_keep_their_distance() -> None:
    parts = frames_of_parts(652)
    assert [len(part) for part in parts] == [200, 160, 160]
    frames = np.sort(np.concatenate(parts))
    assert len(np.unique(frames)) == len(frames)
    owner = {int(frame): number for number, part in enumerate(parts) for frame in part}
    near = [abs(a - b) for a in owner for b in range(a - 10, a + 11) if b in owner and owner[a] != owner[b]]
    assert not near
    with pytest.raises(ValueError, match="2 blocks of 40, at least 3"):
        frames_of_parts(90)


def test_connectivity_is_the_partial_correlation_with_the_patch() -> None:
    random = np.random.default_rng(0)
    frames = 652
    confounds = random.standard_normal((frames, 3))
    source, other = random.standard_normal((2, frames))
    share = np.array([1.0, 0.8, -0.6, 0.0])
    series = share[:, None] * source + np.sqrt(1 - share**2)[:, None] * other
    series += confounds @ np.array([3.0, -2.0, 5.0]) + 7.0
    maps = connectivity_maps(series, confounds, np.array([True, False, False, False]))
    for column, part in zip(maps.T, frames_of_parts(frames), strict=True):
        # the residual maker, an independent route to the partial correlation
        design = np.column_stack([np.ones(len(part)), confounds[part]])
        maker = np.eye(len(part)) - design @ np.linalg.pinv(design)
        clean = (maker @ np.stack([source, other])[:, part].T).T
        mixed = share[:, None] * clean[0] + np.sqrt(1 - share**2)[:, None] * clean[1]
        expected = np.corrcoef(mixed)[0, 1:]
        assert np.tanh(column[1:]) == pytest.approx(expected, abs=1e-9)
        assert column[0] == pytest.approx(np.arctanh(0.999))
    with pytest.raises(ValueError, match="1 of 4 vertices do not vary"):
        connectivity_maps(np.vstack([series[:3], np.ones(frames)]), confounds, np.array([True, False, False, False]))
    with pytest.raises(ValueError, match="no vertex"):
        connectivity_maps(series, confounds, np.zeros(4, dtype=bool))


def test_the_run_belongs_to_fsaverage5() -> None:
    with pytest.raises(ValueError, match="take surface=resting_fsaverage5"):
        run_on(icosphere(1))


@pytest.mark.skipif(BRAINSPACE.folder() is None, reason="brainspace is not installed")
def test_measured_surfaces_have_their_maps_where_the_mask_is() -> None:
    for hemisphere, count in (("left", 29271), ("right", 29287)):
        surface = conte69(hemisphere)
        assert len(surface.mesh.vertices) == count and surface.hemisphere == hemisphere
        assert all(np.isfinite(values).all() for values in surface.scalars.values())
    assert len(resting_fsaverage5("left").mesh.vertices) == 9354


def test_an_unknown_side_is_refused() -> None:
    with pytest.raises(ValueError, match="choose left or right"):
        conte69("both")
