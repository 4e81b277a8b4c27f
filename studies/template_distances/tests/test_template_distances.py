"""Distances to a template are those of the pairs."""

from __future__ import annotations

import pytest

from surfexp.embedding.spectral_distance import spectral_distance
from surfexp.mesh.shapes.ellipsoid import ellipsoid
from surfexp.populations.disguise import disguise
from surfexp_studies.template_distances.template_distances import embedded, template_distances


def test_distances_to_a_template_are_those_of_the_pairs_and_know_a_copy() -> None:
    template = ellipsoid(3, (1.0, 1.35, 0.7))
    others = [ellipsoid(3, (1.0, 1.5, 0.6)), disguise(template, scale=5.0)]
    done: list[int] = []
    found = template_distances(template, iter(others), 6, exact=True, progress=done.append)
    pairs = [spectral_distance(embedded(template, 6), embedded(other, 6)).value for other in others]
    assert found["distance"] == pytest.approx(pairs) and found["distance"][1] < 1e-6 < found["distance"][0]
    assert (found["lower bound"] <= found["distance"]).all() and not found["doubtful"].any()
    assert done == [1, 2]
    assert template_distances(template, [], 6)["distance"].shape == (0,)
