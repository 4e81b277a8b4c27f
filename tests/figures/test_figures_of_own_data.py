"""Figures of a map of one's own have its scale, its name and its unit, and send to no figure of the dissertation."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from surfexp.lab.registry import registry
from surfexp.lab.registry.loading import load_all
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.operators.fem import fem
from surfexp.variational.image import Image
from surfexp.variational.images.painting import add_noise
from surfexp.variational.solution import Solution

load_all(Path("/nonexistent"))
SURFACE = icosphere(3)
MAP = Image(2.5 + 0.4 * SURFACE.mesh.vertices[:, 2], "thickness", "mm")


def figure(name: str, image: Image, **options: Any) -> Any:
    method = registry.plugin("figure", name)
    solution = Solution(image.values if image.clean is None else image.clean, 0.0, model="rof", solver="primal_dual")
    inputs = {"surface": SURFACE, "image": image, "operator": fem(SURFACE.mesh), "solver": solution}
    return method(dict(width=600, **options), **inputs)


@pytest.mark.parametrize("name", ["denoising", "restoration"])
@pytest.mark.parametrize("noise", [0.0, 0.1])
def test_a_map_in_millimetres_is_not_black_and_not_called_a_picture(name: str, noise: float) -> None:
    drawn = figure(name, add_noise(MAP, noise) if noise else MAP)
    greys = drawn.pixels[..., 0][np.ptp(drawn.pixels, axis=-1) == 0]
    assert np.quantile(greys, 0.9) > 100 and len(np.unique(greys)) > 50
    assert "hickness on" in drawn.caption
    for foreign in ("Lena", "255", "figure", "dissertation", "standing in"):
        assert foreign not in drawn.caption, drawn.caption


def test_a_scale_shift_of_the_values_changes_the_colour_bar_and_no_colour() -> None:
    other = Image(1000.0 * MAP.values - 7.0, "thickness", "um")
    first, second = (figure("denoising", image).pixels for image in (MAP, other))
    half = first.shape[0] // 2
    assert (np.abs(first[:half].astype(int) - second[:half].astype(int)) > 1).mean() < 0.01


def test_of_a_time_series_the_first_channel_is_drawn() -> None:
    series = Image(MAP.values[:, None] + np.arange(24.0), "bold", "")
    alone = Image(MAP.values, "bold", "")
    drawn, first = figure("denoising", series), figure("denoising", alone)
    half = first.pixels.shape[0] // 2
    assert (drawn.pixels[:half] == first.pixels[:half]).all()
    assert drawn.caption.startswith("Bold, channel 1 of 24 on")


def test_an_experiment_may_name_the_figure_that_it_answers() -> None:
    assert figure("denoising", MAP, reference="figure 2.2").caption.endswith("Compare figure 2.2 of the dissertation.")


def test_a_map_as_it_came_is_not_called_clean(tmp_path: Path) -> None:
    np.save(tmp_path / "thickness.npy", MAP.values)
    method = registry.plugin("image", "file")
    given = method({"path": tmp_path / "thickness.npy", "unit": "mm"}, surface=SURFACE)
    noisy = method({"path": tmp_path / "thickness.npy", "noise": 0.1}, surface=SURFACE)
    assert given.clean is None and np.array_equal(noisy.clean, MAP.values) and noisy.noise == 0.1
