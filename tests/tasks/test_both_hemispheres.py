"""Both hemispheres as one surface: read, worked on and written as each side apart is."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import nibabel
import numpy as np
import pytest

import surfexp as sx
from surfexp.commands.command_line import main
from surfexp.io.label_files import read_label_map
from surfexp.io.map_files import read_maps
from surfexp.mesh.both_hemispheres import joined, joined_labels, of_both
from surfexp.mesh.label_map import LabelMap
from surfexp.mesh.spatial_frame import SpatialFrame
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh

BALL, EGG = sx.shape("icosphere", levels=3).mesh, sx.shape("ellipsoid").mesh
LEFT = TriangleMesh(BALL.vertices - [3.0, 0.0, 0.0], BALL.faces)
RIGHT = TriangleMesh(EGG.vertices + np.array([3.0, 0.0, 0.0]), EGG.faces)
HEIGHTS = {"left": LEFT.vertices[:, 2], "right": RIGHT.vertices[:, 2]}
NOISE = {side: 0.2 * np.random.default_rng(k).standard_normal(len(HEIGHTS[side])) for k, side in enumerate(HEIGHTS)}
NOISY = {side: HEIGHTS[side] + NOISE[side] for side in HEIGHTS}
SIDES = {"left": Surface(LEFT, hemisphere="left"), "right": Surface(RIGHT, hemisphere="right")}
BRAIN = joined(SIDES["left"], SIDES["right"])
N = len(LEFT.vertices)


@pytest.fixture
def folder(working_folder: Path) -> Path:
    for side, letter in (("left", "l"), ("right", "r")):
        sx.write(f"{letter}h.white.ply", SIDES[side])
        sx.write(f"{letter}h.thickness.mgh", NOISY[side])
        sx.write(f"{letter}h.mask.csv", (HEIGHTS[side] > -0.4).astype(float))
        names = {1: "north", 2: f"only {side}"}
        sx.write(f"{letter}h.parts.label.gii", LabelMap(np.where(HEIGHTS[side] > 0, 1, 2), names), SIDES[side])
    return working_folder


def pair(name: str) -> dict[str, str]:
    return {"left": f"lh.{name}", "right": f"rh.{name}"}


def test_files_of_both_go_with_one_file_as_with_two(folder: Path) -> None:
    sx.write("brain.npz", BRAIN)
    values = np.concatenate(list(NOISY.values()))
    sx.write("map.npz", {"a": values, "b": values > 0}, BRAIN)
    sx.write("one.dscalar.nii", {"a": values}, BRAIN)
    for maps in ("map.npz", "one.dscalar.nii", {"x": "map.npz"}, pair("thickness.mgh")):
        for mask in ("one.dscalar.nii", pair("mask.csv"), pair("parts.label.gii"), None):
            given = {"maps": maps, "mask": mask, "labels": pair("parts.label.gii")}
            one, two = sx.read("brain.npz", **given), sx.read(**pair("white.ply"), **given)
            assert list(one.scalars) == list(two.scalars) and one.notes == two.notes
            for name in two.scalars:
                np.testing.assert_array_equal(one.scalars[name], two.scalars[name])
            np.testing.assert_array_equal(one.labels["parts"].keys, two.labels["parts"].keys)
            assert (one.mask is None) == (two.mask is None)
            assert one.mask is None or np.array_equal(one.mask, two.mask)
    inside = values > 0
    assert np.array_equal(sx.read("brain.npz", mask=inside).mask, inside)
    with pytest.raises(ValueError, match=r"for two hemispheres: give \{'left': file, 'right': file\}"):
        sx.read("brain.npz", maps="lh.thickness.mgh")


def test_both_in_one_file_have_to_be_sound_inside_their_mask_alone(folder: Path) -> None:
    flipped = BRAIN.mesh.faces.copy()
    flipped[:3] = flipped[:3, ::-1]
    sx.write("brain.npz", replace(BRAIN, mesh=TriangleMesh(BRAIN.mesh.vertices, flipped)))
    values = np.concatenate(list(NOISY.values()))
    sx.write("map.npz", {"a": values}, BRAIN)
    with pytest.raises(ValueError, match="repair"):
        sx.read("brain.npz", maps="map.npz")
    repaired = sx.read("brain.npz", maps="map.npz", unit="mm", repair=True)
    assert repaired.hemisphere == "both" and repaired.unit == "mm"
    np.testing.assert_array_equal(repaired.scalars["map"], values)
    inside = ~np.isin(np.arange(len(values)), BRAIN.mesh.faces[:3])
    assert np.array_equal(sx.read("brain.npz", mask=inside).mask, inside)


def test_a_surface_of_both_is_each_side_again(folder: Path) -> None:
    brain = sx.read(
        **pair("white.ply"),
        maps=pair("thickness.mgh"),
        labels=pair("parts.label.gii"),
        mask=pair("mask.csv"),
        unit="mm",
    )
    assert (brain.hemisphere, brain.name, list(brain.scalars), list(brain.labels)) == (
        "both",
        "white",
        ["thickness"],
        ["parts"],
    )
    assert brain.mesh.component_count == 2
    for side, one in brain.hemispheres().items():
        alone = sx.read(
            pair("white.ply")[side],
            maps={"thickness": pair("thickness.mgh")[side]},
            labels={"parts": pair("parts.label.gii")[side]},
            mask=pair("mask.csv")[side],
        )
        assert one.hemisphere == alone.hemisphere == side and one.unit == "mm"
        for name in ("vertices", "faces", "mask"):
            np.testing.assert_array_equal(getattr(one, name), getattr(alone, name))
        np.testing.assert_array_equal(one.scalars["thickness"], alone.scalars["thickness"])
        for name in alone.labels["parts"].names.values():
            np.testing.assert_array_equal(one.labels["parts"].where(name), alone.labels["parts"].where(name))
    assert set(brain.labels["parts"].names.values()) == {"north", "only left", "only right"}


def test_a_surface_that_is_not_both_is_its_own_hemisphere() -> None:
    assert SIDES["left"].hemispheres() == {"left": SIDES["left"]} and list(Surface(BALL).hemispheres()) == [""]


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ({"left": "rh.white.ply", "right": "lh.white.ply"}, "given as left, it is of the other"),
        ({"left": "lh.white.ply", "right": "lh.white.ply"}, "given as right, it is of the other"),
        (pair("white.ply") | {"maps": {"left": "rh.thickness.mgh", "right": "lh.thickness.mgh"}}, "given as left"),
        (
            pair("white.ply") | {"mask": {"left": "lh.mask.csv", "right": "lh.mask.csv"}},
            "mask lh.mask.csv is given as right",
        ),
        (
            pair("white.ply") | {"labels": {"left": "lh.parts.label.gii", "right": "lh.parts.label.gii"}},
            "given as right",
        ),
        (pair("white.ply") | {"maps": "lh.thickness.mgh"}, "for two hemispheres"),
        (pair("white.ply") | {"maps": ("lh.thickness.mgh", "rh.thickness.mgh")}, "for two hemispheres"),
        (pair("white.ply") | {"maps": [pair("thickness.mgh"), pair("thickness.mgh")]}, "are called 'thickness'"),
        (pair("white.ply") | {"hemisphere": "left"}, "give them alone"),
        (pair("white.ply") | {"path": "lh.white.ply"}, "give them alone"),
        ({"left": "lh.white.ply"}, "right is missing"),
        ({}, "left is missing"),
        ({"path": "lh.white.ply", "mask": pair("mask.csv")}, "mask is a pair"),
        ({"path": "lh.white.ply", "maps": pair("thickness.mgh")}, "is of the right hemisphere"),
    ],
)
def test_a_wrong_side_or_half_a_pair_is_refused(folder: Path, given: dict[str, object], says: str) -> None:
    with pytest.raises(ValueError, match=says):
        sx.read(**given)  # type: ignore[arg-type]


def test_hemispheres_that_do_not_fit_are_refused() -> None:
    with pytest.raises(ValueError, match="given as left, it is of hemisphere right"):
        joined(SIDES["right"], SIDES["left"])
    with pytest.raises(ValueError, match="one unit"):
        joined(replace(SIDES["left"], unit="mm"), SIDES["right"])
    with pytest.raises(ValueError, match="choose one of both"):
        Surface(BALL, hemisphere="left", right=BALL.vertices[:, 0] > 0)
    with pytest.raises(ValueError, match="choose one of left, right"):
        Surface(BALL, hemisphere="both")
    with pytest.raises(ValueError, match="642 left and"):
        sx.smooth(BRAIN, {"left": HEIGHTS["left"][1:], "right": HEIGHTS["right"]}, 0.2)
    with pytest.raises(ValueError, match="no right hemisphere"):
        sx.smooth(BRAIN, {"left": HEIGHTS["left"]}, 0.2)


def test_one_column_of_a_side_does_not_stand_for_all_subjects(folder: Path) -> None:
    left, right = (np.tile(HEIGHTS[side][:, None], 4) for side in ("left", "right"))
    told = r"has shape \(642, 4\) left and \(2562, 1\) right: give both sides the same columns"
    with pytest.raises(ValueError, match=f"map {told}"):
        sx.permutation_test(BRAIN, {"left": left, "right": right[:, :1]})
    sx.write("lh.all.npy", left)
    np.save("rh.all.npy", right[:, :1])
    with pytest.raises(ValueError, match=f"map 'all' {told}"):
        sx.permutation_test(BRAIN, {"left": "lh.all.npy", "right": "rh.all.npy"})


def test_maps_of_two_sides_need_a_surface_of_both() -> None:
    with pytest.raises(ValueError, match="thickness has two hemispheres, 'ball' is not both"):
        of_both(Surface(sx.shape("icosphere", levels=1).mesh, "ball"), np.zeros(42), np.zeros(42), "thickness")


def test_eigenvalues_are_the_sorted_union_of_those_of_each_side() -> None:
    found = sx.eigenpairs(BRAIN, 24)
    union = np.sort(np.concatenate([sx.eigenpairs(one, 24).values for one in SIDES.values()]))[:24]
    assert found.complete and (found.values[:2] < 1e-9).all()
    np.testing.assert_allclose(found.values, union, rtol=1e-8, atol=1e-9)


@pytest.mark.parametrize("method", ["rof", pytest.param("tgv", marks=pytest.mark.slow)])
def test_denoising_both_is_denoising_each_with_the_same_weight(method: str) -> None:
    """The weight counts in edge lengths of the surface, so that a side alone takes its share of it."""
    options = {"method": method, "noise": 0.2, "tolerance": 1e-9 if method == "rof" else 1e-6}
    edge = np.sqrt(BRAIN.mesh.area / len(BRAIN.mesh.faces))
    whole = sx.denoise(BRAIN, NOISY, weight=0.9, **({"ratio": 2.0} if method == "tgv" else {}), **options)
    for side, one in SIDES.items():
        share = np.sqrt(one.mesh.area / len(one.mesh.faces)) / edge
        ratio = {"ratio": 2.0 / share} if method == "tgv" else {}
        alone = sx.denoise(one, NOISY[side], weight=0.9 * share, **ratio, **options)
        own = whole.values[BRAIN.right == (side == "right")]
        difference = np.sqrt(np.average((own - alone.values) ** 2, weights=one.mesh.vertex_areas))
        bound = (
            whole.certificate["error_bound"] * np.sqrt(BRAIN.mesh.area / one.mesh.area)
            + alone.certificate["error_bound"]
        )
        assert difference <= bound < 0.02 and np.abs(alone.values - NOISY[side]).max() > 0.1


def test_linear_and_local_results_are_those_of_each_side() -> None:
    smooth, curvature, far = sx.smooth(BRAIN, NOISY, 0.4).values, sx.mean_curvature(BRAIN), sx.geodesic(BRAIN, [0, N])
    for side, one in SIDES.items():
        own = BRAIN.right == (side == "right")
        np.testing.assert_allclose(smooth[own], sx.smooth(one, NOISY[side], 0.4).values, atol=1e-8)
        np.testing.assert_allclose(curvature[own], sx.mean_curvature(one), rtol=1e-12)
        np.testing.assert_allclose(far[own], sx.geodesic(one, 0), rtol=1e-12)


def test_null_maps_keep_the_sides_apart_and_say_so() -> None:
    values = {"left": NOISY["left"], "right": np.cos(3.0 * NOISY["right"])}
    found = sx.null_maps(BRAIN, values, 6, modes=25)
    assert any("drawn apart" in note for note in found.notes)
    for side, other in (("left", "right"), ("right", "left")):
        changed = sx.null_maps(BRAIN, values | {other: np.sin(5.0 * values[other])}, 6, modes=25)
        own = BRAIN.right == (side == "right")
        # up to the unit in which the whole map is counted
        np.testing.assert_allclose(changed.values[own], found.values[own], atol=1e-8)
        assert np.abs(changed.values[~own] - found.values[~own]).max() > 0.1
    assert not any("drawn apart" in note for note in sx.null_maps(SIDES["left"], NOISY["left"], 2, modes=25).notes)


def test_a_test_of_both_names_the_hemisphere_of_each_cluster() -> None:
    random = np.random.default_rng(3)
    data = {side: random.standard_normal((len(HEIGHTS[side]), 12)) for side in HEIGHTS}
    data["left"][HEIGHTS["left"] > 0.7] += 3.0
    data["right"][HEIGHTS["right"] < -0.3] -= 3.0
    parcels = LabelMap(np.where(np.concatenate(list(HEIGHTS.values())) > 0, 1, 2), {1: "north", 2: "south"})
    found = sx.permutation_test(BRAIN, data, count=300, labels=parcels)
    table = found.table("regions")
    assert dict(zip(table["hemisphere"], table["parcels"], strict=True)) == {
        "left": "north 100%",
        "right": "south 100%",
    }
    assert [sx.permutation_test(SIDES["right"], data["right"], count=300).table()["hemisphere"][0]] == ["right"]
    assert "hemisphere" not in sx.permutation_test(BALL, data["left"], count=300).table()


@pytest.mark.parametrize("name", ["clean.dscalar.nii", "clean.npz"])
def test_one_file_holds_maps_of_both_and_says_which_are_which(folder: Path, name: str) -> None:
    clean = {"thickness": np.where(BRAIN.mesh.vertices[:, 2] < -0.5, np.nan, BRAIN.mesh.vertices[:, 2])}
    sx.write(name, clean, BRAIN)
    assert not list(folder.glob("*h.clean*"))
    for side in SIDES:
        own = BRAIN.right == (side == "right")
        np.testing.assert_allclose(read_maps(name, side)["thickness"], clean["thickness"][own], rtol=1e-6)
    again = sx.read(**pair("white.ply"), maps={"thickness": name})
    np.testing.assert_allclose(again.scalars["thickness"], clean["thickness"], rtol=1e-6)


def test_cifti_is_read_by_nibabel_with_both_structures(folder: Path) -> None:
    sx.write("clean.dscalar.nii", {"z": BRAIN.mesh.vertices[:, 2]}, BRAIN)
    axis = nibabel.load("clean.dscalar.nii").header.get_axis(1)
    assert axis.nvertices == {"CIFTI_STRUCTURE_CORTEX_LEFT": N, "CIFTI_STRUCTURE_CORTEX_RIGHT": len(RIGHT.vertices)}


@pytest.mark.parametrize("name", ["z.shape.gii", "z.mgh", "z.csv", "z.npy", "z.vtk", "z.thickness"])
def test_other_formats_become_two_files(folder: Path, name: str) -> None:
    sx.write(name, BRAIN.mesh.vertices[:, 2], BRAIN)
    assert not Path(name).exists()
    for side in SIDES:
        file = pair(name)[side]
        found = sx.read(file).scalars["map"] if name == "z.vtk" else next(iter(read_maps(file).values()))
        np.testing.assert_allclose(found, HEIGHTS[side], rtol=1e-6)


def test_rows_of_a_map_by_hemisphere() -> None:
    numbers = np.arange(len(BRAIN.vertices))
    found = BRAIN.by_hemisphere(numbers)
    assert list(found) == ["left", "right"] and np.array_equal(np.concatenate(list(found.values())), numbers)
    assert list(SIDES["right"].by_hemisphere(HEIGHTS["right"])) == ["right"]
    with pytest.raises(ValueError, match="map has shape"):
        BRAIN.by_hemisphere(numbers[1:])


def test_one_file_of_labels_serves_both(folder: Path) -> None:
    cifti = nibabel.cifti2
    keys = {side: np.where(HEIGHTS[side] > 0, 1, 2) for side in SIDES}
    models = [
        cifti.BrainModelAxis.from_mask(np.ones(len(keys[side]), bool), name=f"CIFTI_STRUCTURE_CORTEX_{side.upper()}")
        for side in SIDES
    ]
    table = {0: ("???", (0.0,) * 4), 1: ("north", (1.0,) * 4), 2: ("south", (0.5,) * 4)}
    header = cifti.Cifti2Header.from_axes((cifti.LabelAxis(["parts"], [table]), models[0] + models[1]))
    cifti.Cifti2Image(np.concatenate(list(keys.values()))[None].astype(np.float32), header).to_filename("p.dlabel.nii")
    brain = sx.read(**pair("white.ply"), labels="p.dlabel.nii", mask="p.dlabel.nii")
    np.testing.assert_array_equal(brain.labels["p"].where("north"), BRAIN.vertices[:, 2] > 0)
    assert brain.mask is not None and brain.mask.all()


def test_surfaces_labels_and_modes_are_written_by_side(folder: Path) -> None:
    sx.write("again.surf.gii", BRAIN)
    both = sx.read(**pair("again.surf.gii"))
    np.testing.assert_allclose(both.vertices, BRAIN.vertices, atol=1e-6)
    sx.write("halves.label.gii", sx.segment(BRAIN, NOISY), BRAIN)
    assert len(read_label_map("rh.halves.label.gii").keys) == len(RIGHT.vertices)
    modes = sx.eigenpairs(BRAIN, 4)
    sx.write("modes.npz", modes, BRAIN)
    with np.load("modes.npz") as found:
        np.testing.assert_array_equal(found["vectors"], modes.vectors)
        assert (found["hemisphere"] == np.where(BRAIN.right, "right", "left")).all()
    with pytest.raises(ValueError, match="named as the left hemisphere, what is written is of both"):
        sx.write("lh.z.mgh", BRAIN.mesh.vertices[:, 2], BRAIN)


def test_nilearn_gives_both_hemispheres() -> None:
    surface = pytest.importorskip("nilearn.surface")
    mesh = surface.PolyMesh(**{side: surface.InMemoryMesh(one.vertices, one.faces) for side, one in SIDES.items()})
    image = surface.SurfaceImage(mesh, dict(NOISY))
    wanted = sx.smooth(BRAIN, NOISY, 0.4).values
    for given, values in ((image, "map"), (image, image), (mesh, image), (mesh, image.data), (mesh.parts, NOISY)):
        np.testing.assert_array_equal(sx.smooth(given, values, 0.4).values, wanted)
    one = surface.PolyMesh(left=mesh.parts["left"])
    np.testing.assert_array_equal(
        sx.smooth(one, image, 0.4).values, sx.smooth(SIDES["left"], NOISY["left"], 0.4).values
    )
    back = surface.SurfaceImage(mesh, BRAIN.by_hemisphere(wanted))
    np.testing.assert_array_equal(sx.smooth(back, back, 0.4).values, sx.smooth(BRAIN, wanted, 0.4).values)


@pytest.mark.parametrize(
    ("left", "right"),
    [
        ({1: "a", 2: "b"}, {1: "a", 2: "b"}),
        ({1: "a", 2: "b"}, {1: "b", 2: "a"}),
        ({1: "a", 2: "b"}, {1: "c", 2: "b"}),
        ({1: "a", 9: "b"}, {1: "c", 9: "d"}),
        ({9: "a"}, {1: "b"}),
        ({}, {1: "b"}),
        ({1: "a"}, {2: "b", 1: "c"}),
    ],
)
def test_a_name_has_one_label_on_both_sides(left: dict[int, str], right: dict[int, str]) -> None:
    """The first free number after 1 to 9 is 10, which stands at a vertex of either side without a name."""
    given = np.array([1, 2, 9, 10])
    first, second = joined_labels(LabelMap(given, left), LabelMap(given, right))
    assert first.names == second.names and set(first.names.values()) == {*left.values(), *right.values()}
    for table, own in ((first, left), (second, right)):
        assert [table.names.get(key) for key in table.keys.tolist()] == [own.get(key) for key in given.tolist()]


def test_repair_keeps_sides_and_files(folder: Path) -> None:
    """A vertex of the left side is split: its copy stands behind both sides, and results are on the vertices of the files."""
    pinch = np.flatnonzero(LEFT.vertices[:, 2] > 0.9)[0]
    torn = TriangleMesh(
        np.r_[LEFT.vertices, [[0.0, 0.0, 9.0], [1.0, 0.0, 9.0], [0.0, 1.0, 9.0]]],
        np.r_[LEFT.faces, [[pinch, N, N + 1], [N, N + 1, N + 2]]],
    )
    sx.write("lh.torn.npz", torn)
    brain = sx.read(left="lh.torn.npz", right="rh.white.ply", repair=True)
    assert brain.file is not None and len(brain.file.standing) == N + 3 + len(RIGHT.vertices)
    values = np.arange(len(brain.file.standing), dtype=float)
    sx.write("number.npy", values, brain)
    np.testing.assert_array_equal(np.load("lh.number.npy"), values[: N + 3])
    np.testing.assert_array_equal(np.load("rh.number.npy"), values[N + 3 :])
    sx.write("number.npz", values, brain)
    np.testing.assert_array_equal(read_maps("number.npz", "right")["number"], values[N + 3 :])
    curvature = sx.mean_curvature(brain)
    np.testing.assert_array_equal(curvature[brain.right], sx.mean_curvature(SIDES["right"]))
    halves = {side: one.vertices[:, 2] for side, one in brain.hemispheres().items()}
    assert len(halves["left"]) == N + 4
    np.testing.assert_array_equal(
        sx.smooth(brain, halves, 0.3).values, sx.smooth(brain, brain.vertices[:, 2], 0.3).values
    )
    again = sx.repair(brain)
    assert again.right is not None and again.right.sum() == len(RIGHT.vertices)


def test_hemispheres_at_one_place_are_sound_and_repaired_apart() -> None:
    """Spheres and inflated surfaces of both sides lie in one another; no vertex of one is a copy of the other's."""
    brain = joined(Surface(BALL, hemisphere="left", labels={"a": LabelMap(np.ones(N, int), {1: "x"})}), Surface(BALL))
    assert sx.check(brain).ok and sx.eigenpairs(brain, 3).complete
    same = sx.repair(brain)
    np.testing.assert_array_equal(same.vertices, brain.vertices)
    assert same.notes == () and (same.labels["a"].where("x") == ~brain.right).all()
    turned = replace(
        brain, mesh=TriangleMesh(brain.vertices, np.where(brain.right[brain.faces], brain.faces[:, ::-1], brain.faces))
    )
    assert "1280 faces of inside-out" in sx.check(turned).lines()[0]
    mended = sx.repair(turned)
    assert sx.check(mended).ok and mended.notes[0].startswith("right: ") and len(mended.notes) == 1


def test_the_space_of_both_is_what_their_files_share() -> None:
    same = SpatialFrame({"cras": np.zeros(3)}, metadata={"GeometricType": "Anatomical", "side": "l"})
    other = SpatialFrame({"cras": np.ones(3)}, metadata={"GeometricType": "Anatomical", "side": "r"})
    alike = joined(replace(SIDES["left"], frame=same), replace(SIDES["right"], frame=same))
    assert alike.frame.volume and not alike.notes
    apart = joined(replace(SIDES["left"], frame=same), replace(SIDES["right"], frame=other))
    assert apart.frame.metadata == {"GeometricType": "Anatomical"} and not apart.frame.volume
    assert "differ in volume geometry" in apart.notes[0]


def test_pictures_show_the_sides_apart() -> None:
    pytest.importorskip("matplotlib")
    four = sx.plot(BRAIN, np.concatenate(list(NOISY.values())), width=800)
    assert [[view.title for view in row] for row in four.views] == [
        ["left, lateral", "left, medial", "right, lateral", "right, medial"]
    ]
    pairwise = sx.plot(list(SIDES.values()), [NOISY["left"], NOISY["right"]], width=800)
    np.testing.assert_array_equal(four.figure.pixels, pairwise.figure.pixels)
    seen = sx.view(BRAIN, np.concatenate(list(NOISY.values())))
    assert len(seen.scene.panels) == 2 and [one.name for one in seen.scene.surfaces]
    columns = (
        np.outer(np.concatenate(list(NOISY.values())), [1.0, 2.0, 3.0, 4.0])
        + 5.0 * np.repeat([0, 1], [N, len(RIGHT.vertices)])[:, None]
    )
    series = sx.view(BRAIN, columns, views=["lateral", "medial"]).scene
    left, right = (one.fields[0] for one in series.surfaces)
    assert left.scale == right.scale and left.scale.limits is not None
    names = [f"column {k} of 4" for k in (1, 2, 3, 4)]
    assert [step.name for step in left.steps] == [step.name for step in right.steps] == names
    assert series.titles == ["left, lateral", "left, medial", "right, lateral", "right, medial"]
    labels = LabelMap(np.r_[np.ones(N, int), np.full(len(RIGHT.vertices), 2)], {1: "l", 2: "r"})
    for shown in (labels, labels.keys, BRAIN.right, sx.segment(BRAIN, NOISY), sx.smooth(BRAIN, NOISY, 0.3)):
        assert len(sx.plot(BRAIN, shown, borders=labels, width=400).views[0]) == 4


def test_the_average_cortex_comes_with_both() -> None:
    brain = sx.shape("fsaverage5", hemisphere="both")
    assert brain.hemisphere == "both" and len(brain.vertices) == 20484 and len(brain.scalars["sulc"]) == 20484


def test_a_list_of_files_is_refused_with_the_way_for_both() -> None:
    with pytest.raises(ValueError, match="path is a list, one file is needed; both hemispheres are left= and right="):
        sx.read(["lh.white", "rh.white"])  # type: ignore[arg-type]


@pytest.mark.parametrize("task", [sx.distance, sx.align])
def test_spectral_distances_of_both_are_refused_with_the_way_for_one(task: Callable[..., object]) -> None:
    with pytest.raises(ValueError, match=r"both hemispheres, .* need one: .* surface.hemispheres\(\)\['left'\]"):
        task(BRAIN, BRAIN, 3)
    right = BRAIN.hemispheres()["right"]
    task(right, right, 3)


def test_fingerprints_of_both_are_a_column_for_each_side(working_folder: Path) -> None:
    for side, name in (("left", "lh.ply"), ("right", "rh.ply")):
        sx.write(name, SIDES[side])
    assert main(["fingerprint", "lh.ply+rh.ply", "-k", "4", "--to", "both.csv"]) == 0
    assert main(["fingerprint", "lh.ply", "rh.ply", "-k", "4", "--to", "apart.csv"]) == 0
    assert Path("both.csv").read_text() == Path("apart.csv").read_text()
    assert "lh" in Path("both.csv").read_text() and main(["fingerprint", "lh.ply+no.ply", "--to", "c.csv"]) == 2


KEYS = {side: np.where(HEIGHTS[side] > 0.0, 2, 1) for side in HEIGHTS}
WORDS = {side: np.where(HEIGHTS[side] > 0.0, "north", "south") for side in HEIGHTS}
STACKED = np.r_[KEYS["left"], KEYS["right"]]


def test_labels_are_given_by_side_as_maps_are() -> None:
    wanted = sx.parcels(BRAIN, NOISY, STACKED)
    tables = {side: LabelMap(KEYS[side], {1: "south", 2: "north"}) for side in KEYS}
    floats = {side: KEYS[side].astype(float) for side in KEYS}
    for given in (KEYS, floats, WORDS, tables):
        found = sx.parcels(BRAIN, NOISY, given)
        assert sorted(found.means) == sorted(wanted.means) and found.hemispheres.count("left") == 2
    subjects = np.random.default_rng(0).standard_normal((len(STACKED), 6))
    tested = [sx.permutation_test(BRAIN, subjects, count=20, forming_p=0.2, labels=one) for one in (KEYS, STACKED)]
    assert [one.parcels for one in tested[0].clusters] == [one.parcels for one in tested[1].clusters]
    picture = sx.plot(BRAIN, STACKED, width=300).figure.pixels
    assert np.array_equal(sx.plot(BRAIN, KEYS, width=300).figure.pixels, picture)
    lines = sx.plot(BRAIN, NOISY, borders=STACKED, width=300).figure.pixels
    for given in (KEYS, floats, WORDS):
        assert np.array_equal(sx.plot(BRAIN, NOISY, borders=given, width=300).figure.pixels, lines)
    names = [view.labels.names for row in sx.plot(BRAIN, WORDS, width=300).views for view in row if view.labels]
    assert names and {*names} == {("north", "south")}


@pytest.mark.parametrize(
    ("call", "line"),
    [
        (lambda: sx.parcels(BRAIN, NOISY, {"left": KEYS["left"]}), "labels have no right hemisphere"),
        (
            lambda: sx.parcels(SIDES["left"], NOISY["left"], {"right": KEYS["left"]}),
            "labels have right, the surface is of",
        ),
        (
            lambda: sx.denoise(BRAIN, {"L": NOISY["left"], "R": NOISY["right"]}),
            "map has the parts L, R: give it as left and",
        ),
    ],
)
def test_half_of_the_labels_and_other_words_for_sides_are_refused(call: Callable[[], object], line: str) -> None:
    with pytest.raises(ValueError, match=line):
        call()
