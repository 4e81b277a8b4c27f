"""The skeleton of a bent strip is as long as the strip."""

from __future__ import annotations

import pytest

from surfexp.mesh.shapes.strip import strip
from surfexp_studies.skeletons.skeleton_study import eigenmap_skeleton


@pytest.mark.parametrize("bend", [0.0, 0.5, 1.2])
def test_the_length_of_a_developable_strip(bend):
    mesh = strip(bend=bend, jag=0.25).mesh
    skeleton, _ = eigenmap_skeleton(mesh)
    assert skeleton.is_chain
    assert skeleton.metrics["mean_distance_length"] == pytest.approx(60.0, rel=5e-3)
    assert skeleton.metrics["geodesic_length"] == pytest.approx(60.0, rel=2.5e-2)
