"""The packaged human cortex."""

from __future__ import annotations

import subprocess
import sys

import igl
import numpy as np
import pytest

from surfexp.anatomy.fsaverage5 import fsaverage5
from surfexp.mesh.validate import validate


@pytest.mark.parametrize("hemisphere", ["left", "right"])
@pytest.mark.parametrize("surface", ["pial", "white", "inflated", "sphere"])
def test_every_surface_is_closed_of_genus_zero_and_outward(hemisphere: str, surface: str) -> None:
    cortex = fsaverage5(hemisphere, surface)  # type: ignore[arg-type]
    assert len(cortex.mesh.vertices) == 10242 and cortex.mesh.genus == 0 and cortex.mesh.is_closed
    assert validate(cortex.mesh.vertices, cortex.mesh.faces).ok
    assert cortex.unit == "mm" and set(cortex.scalars) == {"sulc", "curv", "thickness", "area"}
    middle = cortex.mesh.vertices[:, 0].mean()
    assert abs(middle) < 2 or (middle < 0) == (hemisphere == "left")


def test_curvature_is_positive_in_sulci() -> None:
    cortex = fsaverage5("left", "white")
    mesh = cortex.mesh
    normal_curvature = (
        -(igl.cotmatrix(mesh.vertices, np.array(mesh.faces)) @ mesh.vertices) / mesh.vertex_areas[:, None]
    )
    outward = 0.5 * (normal_curvature * mesh.vertex_normals).sum(axis=1)
    assert np.corrcoef(outward, cortex.scalars["curv"])[0, 1] < -0.7
    assert np.corrcoef(cortex.scalars["sulc"], cortex.scalars["curv"])[0, 1] > 0.7


def test_sphere_has_its_radius_and_the_hemispheres_differ() -> None:
    assert np.linalg.norm(fsaverage5("left", "sphere").mesh.vertices, axis=1) == pytest.approx(100.0, abs=0.01)
    assert not np.allclose(fsaverage5("left").mesh.vertices, fsaverage5("right").mesh.vertices)


def test_unknown_names_are_refused() -> None:
    with pytest.raises(ValueError, match="hemisphere 'middle' is unknown, choose left, right or both"):
        fsaverage5("middle")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="choose one of pial, white, inflated, sphere"):
        fsaverage5("left", "skull")


def test_nilearn_is_not_imported() -> None:
    code = "import sys; from surfexp.anatomy.fsaverage5 import fsaverage5; fsaverage5(); assert 'nilearn' not in sys.modules"
    subprocess.run([sys.executable, "-c", code], check=True)
