"""The caption of a parcellation says where its image was clipped, and writes lengths as tables do."""

from __future__ import annotations

from pathlib import Path

import numpy as np

import surfexp as sx
from surfexp.lab.registry import registry
from surfexp.lab.registry.catalogue import open_catalogue
from surfexp.operators.fem import fem
from surfexp.variational.image import Image
from surfexp.variational.solution import Solution


def test_a_clipped_image_says_so() -> None:
    surface = sx.shape("icosphere", levels=2)
    height = surface.mesh.vertices[:, 2]
    image = Image(np.clip(height, -0.5, 0.5), "height", "mm", notes=("height is clipped at ±0.5 mm",))
    upper = (height > 0.0).astype(np.float64)
    solution = Solution(height, 1.0, model="threshold", segmentation=upper, metrics={"perimeter": 8416.7})
    open_catalogue(Path.cwd())
    draw = registry.plugin("figure", "parcellation")
    inputs = {"surface": surface, "image": image, "operator": fem(surface.mesh), "solver": solution}
    figure = draw({"views": ["front"], "width": 300}, **inputs)
    assert "Height is clipped at ±0.5 mm." in figure.caption and "8\u202f417" in figure.caption
