"""Every answer follows the unit of length, from 1e-100 to 1e100 of it; beyond, arrays and files are refused alike."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import surfexp as sx
from surfexp.commands.command_line import main
from surfexp.mesh.length_scale import length_scale
from surfexp.mesh.shapes.ellipsoid import ellipsoid

BODY = ellipsoid(semiaxes=(1.0, 1.3, 1.7), levels=3).mesh
V, F = BODY.vertices, BODY.faces
RAMP = V[:, 2] + 0.4 * np.random.default_rng(0).standard_normal(len(V))
MAP = np.sign(V[:, 2]) + 0.2 * np.random.default_rng(0).standard_normal(len(V))


def answers(unit: float, folder: Path) -> dict[str, tuple[Any, int]]:
    """Return what functions say of a body, and the power of the unit in it."""
    body = sx.Surface((V * unit, F))
    spectrum = sx.Spectrum(body)
    inside = spectrum.between(0.5 / unit**2, 4.0 / unit**2)
    modes = sx.eigenpairs(body, 12)
    upper, lower = sx.geodesic(body, 0, bounds=True)
    parts, curved = sx.segment(body, MAP), sx.segment(body)
    automatic, wide = sx.denoise(body, MAP), sx.denoise(body, RAMP)
    assert (automatic.certificate["chosen"], wide.certificate["chosen"]) == ("edge_weighted_variation", "heat_kernel")
    graph = sx.reeb_graph(body, V[:, 2], count=9)
    sx.write(folder / "body.npz", body)
    row = sx.fingerprint(folder / "body.npz", 5).columns["body"]
    raw = sx.ShapeDNA(3, normalisation="raw").fit_transform([body])
    return {
        "values": (modes.values[1:], -2),
        "spacing": (modes.spacing, -2),
        "area": (modes.area, 2),
        "edge length": (modes.metrics["edge_length"], 1),
        "between": (inside.values, -2),
        "vectors between": (np.abs(inside.vectors).max(axis=0), -1),
        "count": (spectrum.count_below(4.0 / unit**2), 0),
        "upper": (upper, 1),
        "lower": (lower, 1),
        "perimeter": (parts.perimeter, 1),
        "energy": (parts.energy, 1),
        "lower bound": (parts.lower_bound, 1),
        "gap": (parts.labelling_gap, 0),
        "mean of curvature": (curved.c1, -1),
        "chosen": (automatic.certificate["parameter"], 0),
        "chosen width": (wide.certificate["parameter"], 1),
        "automatic": (automatic.values, 0),
        "smooth": (sx.smooth(body, MAP, 0.4 * unit).values, 0),
        "time": (sx.smooth(body, MAP, 0.4 * unit).certificate["time"], 2),
        "path": (sx.denoise_path(body, MAP, weights=(0.5, 1.0), tolerance=1e-2).at(0.7).values, 0),
        "noise": (sx.noise(body, MAP).level, 0),
        "positions": (graph.positions, 1),
        "contours": (np.abs(graph.contour_points).max(axis=0), 1),
        "lengths": (graph.lengths, 1),
        "area of the mesh": (body.mesh.area, 2),
        "normals": (body.mesh.vertex_normals, 0),
        "fingerprint area": (row[0], 2),
        "fingerprint volume": (row[1], 3),
        "fingerprint values": (row[3:], -2),
        "raw": (raw, -2),
        "variogram": (sx.null_maps(body, MAP, 2, method="variogram").values, 0),
    }


@pytest.fixture(scope="module")
def plain(tmp_path_factory: pytest.TempPathFactory) -> dict[str, tuple[Any, int]]:
    return answers(1.0, tmp_path_factory.mktemp("plain"))


@pytest.mark.parametrize("unit", [1e-100, 1e-74, 1e74, 1e100])
def test_answers_follow_the_unit(unit: float, plain: dict[str, tuple[Any, int]], tmp_path: Path) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error", RuntimeWarning)
        found = answers(unit, tmp_path)
    for name, (value, power) in found.items():
        expected = np.asarray(plain[name][0])
        assert np.allclose(value / unit**power, expected, rtol=1e-5, atol=1e-5 * np.abs(expected).max()), name


@pytest.mark.parametrize("unit", [1e-100, 1e100])
def test_pictures_and_views_do_not_know_the_unit(unit: float) -> None:
    axes = [sx.reeb_graph((V * size, F), V[:, 2], count=5) for size in (1.0, unit)]
    plain, other = (
        sx.plot((V * size, F), MAP, skeleton=axis, width=200).figure.pixels
        for size, axis in zip((1.0, unit), axes, strict=True)
    )
    assert (plain != other).any(axis=-1).mean() < 0.03
    assert len(sx.view((V * unit, F), MAP).html()) == pytest.approx(len(sx.view((V, F), MAP).html()), rel=0.01)


@pytest.mark.parametrize(
    ("largest", "scale"), [(1.0, 1.0), (1e20, 1.0), (0.0, 1.0), (2.0**300, 2.0**300), (2.0**-300, 2.0**-300)]
)
def test_the_scale_is_a_power_of_two_and_1_for_ordinary_sizes(largest: float, scale: float) -> None:
    assert length_scale(np.array([[largest, 0.0, np.nan], [0.0, -0.5 * largest, 0.0]])) == scale


@pytest.mark.parametrize("unit", [1e-110, 1e110])
def test_beyond_arrays_and_files_are_refused_alike(
    unit: float, working_folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(ValueError, match="change the unit"):
        sx.eigenpairs((V * unit, F), 3)
    lines = [" ".join(map(repr, row)) for row in (V * unit).tolist()] + [f"3 {a} {b} {c}" for a, b, c in F.tolist()]
    Path("body.off").write_text("\n".join(["OFF", f"{len(V)} {len(F)} 0", *lines]))
    with pytest.raises(ValueError, match="change the unit"):
        sx.read("body.off")
    assert main(["curvature", "body.off", "--to", "c.csv"]) == 2
    assert "change the unit" in capsys.readouterr().err


@pytest.mark.parametrize(("unit", "fits"), [(1e-40, False), (1e-3, True), (1e3, True), (1e40, False)])
def test_experiments_take_ordinary_sizes_alone(unit: float, fits: bool, working_folder: Path) -> None:
    from plugins.surface.file import file_surface

    sx.write("body.npz", (V * unit, F))
    if fits:
        assert len(file_surface(path=Path("body.npz"), unit="", mask=None).mesh.faces) == len(F)
    else:
        with pytest.raises(ValueError, match=r"body.npz has a largest coordinate .*: change the unit"):
            file_surface(path=Path("body.npz"), unit="", mask=None)
