"""Segmentation by the defaults on real cortices, decimated and in other units; the whole table is in docs/segmentation.md."""

from __future__ import annotations

from importlib.util import find_spec

import numpy as np
import pytest

from surfexp.anatomy.fsaverage5 import Hemisphere, fsaverage5
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.mesh.validate import validate
from surfexp.operators.fem import fem
from surfexp.operators.mean_curvature import mean_curvature
from surfexp.tasks.segmentation import CLIPPED_AT, segment
from surfexp.variational.image import Image
from surfexp.variational.models.convex_chan_vese import ConvexChanVese
from surfexp.variational.solvers.primal_dual import primal_dual
from surfexp.variational.truth_metrics import dice

pytestmark = pytest.mark.skipif(find_spec("nilearn") is None, reason="fsaverage5 comes with nilearn")


def decimated(hemisphere: Hemisphere, faces: int = 4000) -> tuple[TriangleMesh, np.ndarray]:
    """A pial surface that libigl coarsens, and the depth at its vertices."""
    import igl

    surface = fsaverage5(hemisphere, "pial")
    vertices, corners, _, birth = igl.qslim(np.asfortranarray(surface.mesh.vertices), surface.mesh.faces, faces)
    assert validate(vertices, corners).ok
    return TriangleMesh(vertices, corners), surface.scalars["sulc"][birth]


@pytest.mark.parametrize("hemisphere", ["left", "right"])
def test_sulci_of_a_decimated_hemisphere_neither_vanish_nor_flood(hemisphere: Hemisphere) -> None:
    mesh, depth = decimated(hemisphere)
    curvature, mass = -mean_curvature(mesh), mesh.vertex_areas
    bound = float(np.percentile(np.abs(curvature), CLIPPED_AT))
    image = Image(np.clip(curvature, -bound, bound), "mean curvature")
    solution = ConvexChanVese().run(image, fem(mesh), primal_dual)
    found, region = solution.metrics, solution.segmentation > 0.5
    concave = float(mass @ (curvature > 0) / mass.sum())
    assert 0.8 * concave < found["brighter_share"] < 1.25 * concave
    assert solution.converged and solution.relative_gap <= 1e-2
    assert solution.lower_bound <= found["labelling_energy"] <= found["trivial_energy"] <= 0.0
    assert found["c1"] > 0.0 > found["c2"]
    # no depth is looked at; a shorter boundary must not cost agreement
    assert dice(mass, region, depth > 0) > dice(mass, curvature > 0, depth > 0)
    for factor in (1e-2, 1e2):
        scaled = segment((factor * mesh.vertices, mesh.faces), tolerance=1e-2)
        assert ((scaled.labels == 0) == region).all()
