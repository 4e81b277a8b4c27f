"""Pictures on surfaces: upright, unmirrored, of the stated size, and noise."""

from __future__ import annotations

import socket
from pathlib import Path

import numpy as np
import pytest
from PIL import Image as PillowImage

from surfexp.mesh.shapes.cup import cup
from surfexp.mesh.shapes.disk import disk
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.rectangle import rectangle
from surfexp.mesh.shapes.spherical_cap import spherical_cap
from surfexp.mesh.shapes.torus import torus
from surfexp.mesh.surface import Surface
from surfexp.variational.images.letters import GLYPHS, letters
from surfexp.variational.images.painting import add_noise, paint
from surfexp.variational.images.pictures import PACKAGED, picture, read_picture
from surfexp.variational.images.projections import project, view_frame
from surfexp.variational.images.two_phase import coloured_cells, two_phase

# brighter to the right and, four times as much, upward
RAMP = np.add.outer(400.0 * np.linspace(1, 0, 64), 100.0 * np.linspace(0, 1, 64))


def test_rectangle_shows_the_picture_as_a_reader_sees_it() -> None:
    surface = rectangle(41, 41, 1.0, 1.0)
    values = paint(surface, RAMP, "planar", front=(0, 0, 1), up=(0, 1, 0), width=1.0).values
    x, y, _ = surface.mesh.vertices.T
    inside = (np.abs(x - 0.5) < 0.45) & (np.abs(y - 0.5) < 0.45)
    exact = 64 / 63 * (400 * (y - 0.5) + 100 * (x - 0.5)) + 250
    assert values[inside] == pytest.approx(exact[inside], abs=1e-9)


@pytest.mark.parametrize("projection", ["planar", "cylindrical", "spherical"])
@pytest.mark.parametrize("front", [(-1.0, 0.0, 0.0), (0.0, 1.0, 0.3), (1.0, 1.0, 0.0)])
def test_picture_is_upright_and_not_mirrored_on_the_front(projection: str, front: tuple[float, float, float]) -> None:
    sphere = icosphere(4)
    values = paint(sphere, RAMP, projection, front=front, width=3.0).values  # type: ignore[arg-type]
    # of a viewer standing at `front` with z upward, the right hand is up x front
    right = np.cross([0, 0, 1], front) / np.linalg.norm(np.cross([0, 0, 1], front))
    points = sphere.mesh.vertices
    ahead = np.cross(right, [0, 0, 1])
    near = (points @ ahead > 0.8) & (np.abs(points[:, 2]) < 0.5)
    slope = np.linalg.lstsq(np.column_stack([points[near] @ right, points[near, 2], np.ones(near.sum())]), values[near])
    assert slope[0][0] > 20 and slope[0][1] > 80


def test_cup_wall_is_unrolled_without_distortion() -> None:
    surface = cup(4000)
    x, y, z = surface.mesh.vertices.T
    plane = project(surface, "cylindrical", radius=1.0)
    a, b = surface.mesh.edges.T
    wall = (np.hypot(x, y) > 0.99) & (x < -0.2) & (np.abs(z) < 0.9)
    both = wall[a] & wall[b]
    unrolled = np.linalg.norm(plane[a] - plane[b], axis=1)[both]
    chord = np.linalg.norm(surface.mesh.vertices[a] - surface.mesh.vertices[b], axis=1)[both]
    assert both.sum() > 500
    assert unrolled == pytest.approx(chord, rel=2e-3)


def test_cameraman_on_the_cup_is_recognisable_from_the_front() -> None:
    surface = cup(4000)
    image = paint(surface, picture("cameraman"))
    values, vertices = image.values, surface.mesh.vertices
    assert image.notes[0] == "painted by cylindrical projection, 2.6 x 2.6"
    # the coat is dark and left of the middle, the sky above bright: front is -x, so left is +y
    outside = (np.hypot(*vertices.T[:2]) > 0.99) & (vertices[:, 0] < -0.3)
    coat = outside & (np.abs(vertices[:, 1] - 0.55) < 0.15) & (np.abs(vertices[:, 2]) < 0.3)
    sky = outside & (vertices[:, 2] > 0.9) & (np.abs(vertices[:, 1]) < 0.5)
    assert values[coat].mean() < 40 < 140 < values[sky].mean()


def test_extensions() -> None:
    surface = rectangle(61, 21, 3.0, 1.0)
    middle = np.abs(surface.mesh.vertices[:, 0] - 1.5)
    for extension in ("reflect", "wrap", "edge"):
        values = paint(surface, RAMP, "planar", front=(0, 0, 1), up=(0, 1, 0), width=1.0, extension=extension).values  # type: ignore[arg-type]
        row = values.reshape(61, 21)[:, 10]
        if extension == "reflect":
            assert row[30:36] == pytest.approx(row[50:44:-1], abs=1e-9)
        elif extension == "wrap":
            assert row[25:35] == pytest.approx(row[45:55], abs=1e-9)
        else:
            assert np.ptp(values.reshape(61, 21)[45:, 10]) == pytest.approx(0.0, abs=1e-9)
    assert middle.max() == 1.5


def test_colour_and_coordinates() -> None:
    surface = torus(60, 30)
    colours = np.stack([RAMP, 0 * RAMP + 7, RAMP[::-1]], axis=2)
    image = paint(surface, colours, "coordinates", width=2 * np.pi, height=2 * np.pi, extension="wrap")
    assert image.values.shape == (1800, 3)
    assert image.values[:, 1] == pytest.approx(7.0)
    assert image.values[:, 0] == pytest.approx(
        paint(surface, RAMP, "coordinates", width=2 * np.pi, height=2 * np.pi, extension="wrap").values
    )
    assert image.notes == ("painted by coordinates projection, 6.283 x 6.283",)


def test_picture_covers_the_surface_unless_a_size_is_given() -> None:
    surface = rectangle(21, 11, 2.0, 1.0)
    image = paint(surface, RAMP, "planar", front=(0, 0, 1), up=(0, 1, 0))
    assert image.notes[0].endswith("2 x 2")
    wide = paint(surface, RAMP[:32], "planar", front=(0, 0, 1), up=(0, 1, 0), height=3.0)
    assert wide.notes[0].endswith("6 x 3")


def test_fine_detail_is_smoothed_to_the_mesh() -> None:
    checkerboard = 255.0 * (np.indices((512, 512)).sum(axis=0) % 2)
    values = paint(rectangle(21, 21), checkerboard, "planar", front=(0, 0, 1), up=(0, 1, 0)).values
    assert values == pytest.approx(127.5, abs=1.0)


def test_every_packaged_picture_is_there_without_a_network(monkeypatch: pytest.MonkeyPatch) -> None:
    def no_network(*arguments: object) -> None:
        raise AssertionError("the network was asked for")

    monkeypatch.setattr(socket, "socket", no_network)
    for name in PACKAGED:
        levels = picture(name)
        assert levels.ndim in (2, 3) and 0 <= levels.min() < levels.max() <= 255, name
    assert picture("cameraman").shape == (512, 512)
    assert picture("astronaut").shape == (512, 512, 3)


def test_picture_files(tmp_path: Path) -> None:
    PillowImage.fromarray(np.array([[0, 65535]], dtype=np.uint16)).save(tmp_path / "deep.png")
    assert read_picture(tmp_path / "deep.png").tolist() == [[0.0, 255.0]]
    PillowImage.new("RGBA", (2, 3), (1, 2, 3, 4)).save(tmp_path / "clear.png")
    assert read_picture(tmp_path / "clear.png")[0, 0].tolist() == [1.0, 2.0, 3.0]
    (tmp_path / "cut.png").write_bytes((tmp_path / "clear.png").read_bytes()[:40])
    for name in ("cut.png", "nowhere.png"):
        with pytest.raises(ValueError, match=name):
            read_picture(tmp_path / name)


def test_letters() -> None:
    levels = letters("I", 64)
    assert set(np.unique(levels)) == {0.0, 255.0}
    assert (levels == levels[:, ::-1]).mean() > 0.98
    assert 0.05 < (letters() == 0).mean() < 0.4
    # an L has its ink at the left and at the foot
    ink = letters("L", 90) == 0
    assert ink[:, :45].sum() > ink[:, 45:].sum() and ink[45:].sum() > ink[:45].sum()
    assert all(len(bytes.fromhex(columns)) == 5 for columns in GLYPHS.values())
    for text, size, words in (("ä", 64, "Ä"), (" ", 64, "' '"), ("WIDE TEXT", 20, "size = 20")):
        with pytest.raises(ValueError, match=words):
            letters(text, size)


def test_noise_is_seeded_and_has_its_standard_deviation() -> None:
    image = paint(icosphere(5), RAMP, "spherical")
    noisy, again, other = (add_noise(image, 40.0, seed) for seed in (3, 3, 4))
    assert (noisy.values == again.values).all() and not np.allclose(noisy.values, other.values)
    assert noisy.clean is image.values and noisy.noise == 40.0
    assert np.std(noisy.values - image.values) == pytest.approx(40.0, rel=0.03)
    twice = add_noise(noisy, 30.0)
    assert twice.noise == 50.0 and twice.clean is image.values


def test_two_phase_and_cells() -> None:
    cap = spherical_cap(2.0, 20)
    assert cap.coordinates is not None
    image = two_phase(cap, cap.coordinates[:, 0] - 1.05, boundary_length=2 * np.pi * np.sin(1.05))
    inside = image.labels["inside"]
    assert (image.values[inside] == 255).all() and (image.values[~inside] == 0).all()
    assert cap.mesh.vertex_areas[inside].sum() == pytest.approx(2 * np.pi * (1 - np.cos(1.05)), rel=0.01)
    cells = coloured_cells(cap, 6, 1)
    assert cells.values.shape == (len(cap.mesh.vertices), 3) and len(np.unique(cells.values, axis=0)) == 6
    with pytest.raises(ValueError, match="both phases"):
        two_phase(cap, cap.coordinates[:, 0] + 1)


def test_bad_requests_are_named() -> None:
    flat = disk(3)
    bare = Surface(flat.mesh)
    for act, words in [
        (lambda: paint(flat, np.zeros(5)), r"shape \(5,\)"),
        (lambda: paint(flat, np.full((4, 4), np.nan)), "finite"),
        (lambda: paint(flat, RAMP, "conic"), "projection 'conic'"),  # type: ignore[arg-type]
        (lambda: paint(flat, RAMP, extension="nothing"), "extension 'nothing'"),  # type: ignore[arg-type]
        (lambda: paint(flat, RAMP, width=-1.0), "-1.0"),
        (lambda: paint(bare, RAMP, "coordinates"), "no coordinates"),
        (lambda: view_frame((0, 0, 1), (0, 0, 2)), "different directions"),
        (lambda: picture("lena"), "choose one of cameraman"),
        (lambda: add_noise(paint(flat, RAMP, "planar", front=(0, 0, 1), up=(0, 1, 0)), -1.0), "sigma = -1.0"),
        (lambda: coloured_cells(flat, 0), "cells = 0"),
    ]:
        with pytest.raises(ValueError, match=words):
            act()


def test_the_frame_of_a_view_is_orthonormal_whatever_the_lengths_of_its_directions() -> None:
    frame = view_frame((-3.0, 0.0, 0.0), (0.0, 0.0, 0.2))
    assert frame @ frame.T == pytest.approx(np.eye(3), abs=1e-12) and np.linalg.det(frame) == pytest.approx(1.0)
    assert frame == pytest.approx(view_frame((-1.0, 0.0, 0.0), (0.0, 0.0, 1.0)))
