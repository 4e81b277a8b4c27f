"""Whole pictures: bytes, colours, light, and input that is not as it should be."""

from __future__ import annotations

import hashlib
import subprocess
import sys

import numpy as np
import pytest

from surfexp.figures.ambient_occlusion import ambient_occlusion
from surfexp.figures.camera import fit_camera
from surfexp.figures.colormap import MISSING
from surfexp.figures.labelling import Labelling
from surfexp.figures.rasterizer import rasterize
from surfexp.figures.render import SurfaceView, draw, render
from surfexp.figures.shading import illumination, shade, to_display
from surfexp.mesh.shapes.disk import disk
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.triangle_mesh import TriangleMesh

SPHERE = icosphere(3).mesh
DISK = disk(6).mesh
SMALL = (60, 50)


def test_bytes_are_the_same_in_another_process() -> None:
    code = (
        "import hashlib; from surfexp.figures.render import render; from surfexp.mesh.shapes.icosphere import icosphere;"
        "mesh = icosphere(3).mesh; z = mesh.vertices[:, 2];"
        "print(hashlib.sha256(render(mesh, z, contour_field=z, size=(60, 50)).tobytes()).hexdigest())"
    )
    other = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.strip()
    z = SPHERE.vertices[:, 2]
    assert hashlib.sha256(render(SPHERE, z, contour_field=z, size=SMALL).tobytes()).hexdigest() == other


def unshaded(values: np.ndarray, factor: int = 2) -> np.ndarray:
    """The colours of the disk's middle pixel without light and shade."""
    camera = fit_camera(DISK, "top", SMALL)
    raster = rasterize(DISK, camera.supersampled(factor))
    table = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [0.5, 0.5, 0.5]])
    return shade(DISK, camera, raster, values, table, 0.0, factor).light[25, 30]


def test_colours_without_light_are_those_given() -> None:
    n = len(DISK.vertices)
    assert np.allclose(unshaded(np.tile([0.2, 0.3, 0.9], (n, 1))), [0.2, 0.3, 0.9])
    assert np.allclose(unshaded(np.full((n, 1), 0.4)), [0, 0, 1])
    assert np.allclose(unshaded(np.full((n, 1), 0.6)), [0, 1, 0])
    assert np.allclose(unshaded(np.full((n, 1), -7.0)), [0, 0, 1])
    assert np.allclose(unshaded(np.full((n, 1), 1.0)), [0, 1, 0])
    # no whole number holds these
    assert np.allclose(unshaded(np.full((n, 1), 1e25)), [0, 1, 0])
    assert np.allclose(unshaded(np.full((n, 1), -1e25)), [0, 0, 1])
    assert np.allclose(unshaded(np.full((n, 1), np.nan)), 0.5)


def test_light_depends_on_the_normal_only_and_is_about_one_toward_the_key() -> None:
    assert illumination(-0.45, 0.62, 0.643) == pytest.approx(1.0, abs=0.1)
    assert illumination(0.6, -0.6, 0.53) < 0.6 < illumination(0.0, 0.0, 1.0) < 1.05


def test_light_comes_from_the_upper_left_in_every_view() -> None:
    for view in ("front", "left", (200.0, -60.0)):
        pixels = render(SPHERE, view=view, size=(100, 100)).astype(int)
        upper_left, upper_right, lower_left = (pixels[i, j].sum() for i, j in ((30, 25), (30, 75), (75, 30)))
        assert upper_left > upper_right + 20 and upper_left > lower_left + 60


def test_coverage_of_a_picture_is_the_area_of_the_surface() -> None:
    camera = fit_camera(SPHERE, size=(200, 200))
    raster = rasterize(SPHERE, camera.supersampled(3))
    shaded = shade(SPHERE, camera, raster, np.zeros((len(SPHERE.vertices), 1)), np.zeros((2, 3)), 1.0, 3)
    assert shaded.coverage.sum() == pytest.approx(np.pi * camera.scale**2, rel=5e-3)
    assert shaded.coverage.max() == pytest.approx(1.0)


def test_each_label_has_its_colour() -> None:
    x = DISK.vertices[:, 0]
    index = np.where(x < -0.3, 0, np.where(x > 0.3, 1, 2)).astype(np.int64)
    colors = np.array([[0.9, 0.1, 0.1], [0.1, 0.1, 0.9], [0.1, 0.8, 0.1]])
    scene = SurfaceView(DISK, labels=Labelling(index, ("left", "right", "middle"), colors))
    row = draw(scene, fit_camera(DISK, "top", SMALL))[25].astype(int)
    assert [int(row[column].argmax()) for column in (14, 30, 45)] == [0, 1, 2]


def test_background_is_white_and_missing_values_are_grey() -> None:
    pixels = render(DISK, np.full(len(DISK.vertices), np.nan), view="top", size=SMALL)
    assert (pixels[0, 0] == 255).all() and pixels.shape == (50, 60, 3) and pixels.dtype == np.uint8
    red, green, blue = pixels[25, 30].astype(int)
    assert red == green == blue and abs(red - 255 * MISSING[0]) < 20
    scene = SurfaceView(DISK, np.where(np.arange(len(DISK.vertices)) < 4, np.nan, 1.0))
    assert scene.missing == 4


def test_one_nan_does_not_reach_beyond_its_faces() -> None:
    values = np.linspace(0.0, 1.0, len(DISK.vertices))
    holed = values.copy()
    holed[0] = np.nan
    whole = render(DISK, values, limits=(0, 1), view="top", size=SMALL)
    hole = (whole != render(DISK, holed, limits=(0, 1), view="top", size=SMALL)).any(axis=2)
    camera = fit_camera(DISK, "top", SMALL)
    row, column = np.nonzero(hole)
    distance = np.hypot(column + 0.5 - camera.origin[0], row + 0.5 - camera.origin[1]) / camera.scale
    assert len(distance) and distance.max() < 1.0 / 6.0 + 1.0 / camera.scale


def test_back_of_an_open_surface_is_bluer_than_its_front() -> None:
    front, back = (render(DISK, view=view, size=SMALL)[25, 30].astype(int) for view in ("top", "bottom"))
    assert back[2] - back[0] > front[2] - front[0] + 20


def test_red_contour_is_pure() -> None:
    pixels = render(
        DISK, view="top", contour_field=DISK.vertices[:, 0], contour_color="red", contour_width=4, size=SMALL
    )
    assert (pixels[25, 30] == [255, 0, 0]).all()


def test_rgb_channels_are_drawn_directly() -> None:
    colors = np.tile([1.0, 0.0, 0.0], (len(DISK.vertices), 1))
    red, green, blue = render(DISK, colors, view="top", size=SMALL)[25, 30]
    assert red > 230 and green == blue == 0


def test_a_pit_is_darker_than_a_plain() -> None:
    x = np.linspace(-1.0, 1.0, 81)
    radius = np.hypot(x[:, None], x[None, :])
    depth = 20.0 * np.exp(-((radius / 0.15) ** 2))
    normals = np.zeros((81, 81, 3))
    normals[..., 2] = 1.0
    hidden = ambient_occlusion(depth, normals, 15.0)
    assert hidden[40, 40] > 0.3 and hidden[40, 5] == 0.0
    # a plane hides nothing of itself, however steep
    steep = np.broadcast_to(3.0 * np.arange(81.0), (81, 81))
    normals[:] = np.array([3.0, 0.0, 1.0]) / np.sqrt(10.0)
    assert ambient_occlusion(steep, normals, 15.0).max() == 0.0


def test_surfaces_that_cannot_be_seen_are_white_pictures() -> None:
    empty = TriangleMesh(np.zeros((0, 3)), np.zeros((0, 3), dtype=int))
    point = TriangleMesh(np.zeros((3, 3)), np.array([[0, 1, 2]]))
    nowhere = TriangleMesh(np.full((3, 3), np.nan), np.array([[0, 1, 2]]))
    for mesh in (empty, point, nowhere):
        assert (render(mesh, size=SMALL) == 255).all()


def test_one_bad_vertex_does_not_spoil_the_picture() -> None:
    vertices = SPHERE.vertices.copy()
    vertices[0] = np.nan
    good, bad = render(SPHERE, size=SMALL), render(TriangleMesh(vertices, SPHERE.faces), size=SMALL)
    assert (bad != 255).any() and np.abs(good.astype(int) - bad).max(axis=2).mean() < 12


def test_mistakes_are_named() -> None:
    with pytest.raises(ValueError, match=r"\(5,\), expected \(642,\) or \(642, 3\)"):
        render(SPHERE, np.zeros(5))
    with pytest.raises(ValueError, match="supersampling is 9"):
        draw(SurfaceView(SPHERE), fit_camera(SPHERE), 9)


def test_levels_of_the_display_are_the_nearest_ones() -> None:
    light = np.concatenate([np.linspace(-0.1, 1.2, 100_001), ((np.arange(256.0)) / 255.0) ** 2.2])
    expected = np.rint(255.0 * np.clip(light, 0.0, 1.0) ** (1.0 / 2.2))
    assert (to_display(light.reshape(-1, 1)).ravel() == expected).all()
    assert to_display(np.array([np.nan]))[0] == 255
