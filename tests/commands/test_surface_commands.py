"""Commands on files of one's own: file in, file out, certificate beside it."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path

import nibabel
import numpy as np
import pytest

import surfexp as sx
from surfexp.commands.all_commands import SECTIONS
from surfexp.commands.command_line import main
from surfexp.io.map_files import read_maps
from surfexp.io.quantity_of_file import quantity_named


@pytest.fixture
def files(working_folder: Path) -> Path:
    """A GIFTI surface, a map with NaN, a mask, in the working folder."""
    sphere = sx.shape("ellipsoid", levels=3)
    z = sphere.mesh.vertices[:, 2]
    sx.write("brain.surf.gii", sphere)
    inside = z > -0.5
    noisy = np.where(inside, z + 0.1 * np.random.default_rng(0).standard_normal(len(z)), np.nan)
    sx.write("noisy.shape.gii", noisy, sphere)
    sx.write("inside.npy", inside.astype(float))
    sx.write("own.vtp", {"height": z}, sphere)
    return working_folder


def certificate(name: str) -> dict:
    return json.loads(Path(f"{name}.json").read_text())


def test_a_map_with_nan_is_denoised_to_gifti(files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    call = ["denoise", "brain.surf.gii", "noisy.shape.gii", "--method", "rof", "--to", "clean.shape.gii"]
    assert main(call) == 0
    clean = nibabel.load("clean.shape.gii").agg_data()
    noisy = nibabel.load("noisy.shape.gii").agg_data()
    assert np.array_equal(np.isnan(clean), np.isnan(noisy))
    proof = certificate("clean.shape.gii")
    assert proof["relative_gap"] <= 1e-4 and proof["noise"] == pytest.approx(0.1, rel=0.1)
    assert proof["inputs"]["noisy.shape.gii"] == hashlib.sha256(Path("noisy.shape.gii").read_bytes()).hexdigest()
    assert "these are the mask" in capsys.readouterr().err


def test_modes_of_a_masked_surface_leave_in_several_formats(files: Path) -> None:
    for name in ("modes.npz", "modes.vtk", "modes.csv", "modes.func.gii"):
        assert main(["modes", "brain.surf.gii", "-k", "6", "--mask", "inside.npy", "--to", name]) == 0
        assert certificate(name)["complete"] is True and certificate(name)["residual"] <= 1e-8
    kept = np.load("modes.npz")
    direct = sx.eigenpairs(sx.read("brain.surf.gii", mask="inside.npy"), 6)
    assert np.array_equal(kept["values"], direct.values)
    assert np.array_equal(kept["vectors"], direct.vectors, equal_nan=True)


def test_every_other_command_leaves_a_file(files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    calls = [
        ["denoise", "brain.surf.gii", "noisy.shape.gii", "--method", "tgv", "--ratio", "3", "--to", "slopes.shape.gii"],
        ["smooth", "brain.surf.gii", "noisy.shape.gii", "--width", "0.3mm", "--unit", "mm", "--to", "smooth.mgh"],
        ["geodesic", "brain.surf.gii", "0", "5", "--to", "distance.csv"],
        ["curvature", "brain.surf.gii", "--to", "curvature.vtp"],
        ["skeleton", "brain.surf.gii", "--to", "skeleton.vtk"],
        ["distance", "brain.surf.gii", "brain.surf.gii", "-n", "5", "--to", "map.npz"],
        ["align", "brain.surf.gii", "brain.surf.gii", "-k", "5", "--to", "aligned.npz"],
    ]
    for call in calls:
        assert main(call) == 0, call
        assert Path(call[-1]).stat().st_size > 0 and Path(f"{call[-1]}.json").exists()
    assert "proved least" in capsys.readouterr().out
    assert main(["convert", "brain.surf.gii", "brain.ply"]) == 0
    assert main(["plot", "brain.ply", "noisy.shape.gii", "--width", "300", "--to", "a.png"]) == 0
    assert Path("a.png").read_bytes().startswith(b"\x89PNG")


def test_maps_keep_their_names(files: Path) -> None:
    sphere = sx.read("brain.surf.gii")
    noise = np.random.default_rng(1).standard_normal((2, len(sphere.mesh.vertices)))
    sx.write("two.func.gii", {"one": noise[0], "two": noise[1]}, sphere)
    calls = {
        "smooth brain.surf.gii two.func.gii --width 0.3 --to both.func.gii": ["one", "two"],
        "smooth brain.surf.gii two.func.gii --width 0.3 --to both.vtk": ["one", "two"],
        "smooth brain.surf.gii two.func.gii --width 0.3 --to both.npy": ["both"],
        "smooth own.vtp height --width 0.3 --to smooth.vtp": ["height"],
        "denoise own.vtp height --to clean.shape.gii": ["height"],
        "denoise brain.surf.gii noisy.shape.gii --to clean.csv": ["noisy"],
    }
    for call, names in calls.items():
        assert main(call.split()) == 0
        name = call.split()[-1]
        maps = sx.read(name).scalars if name.endswith((".vtk", ".vtp")) else read_maps(name)
        assert list(maps) == names, call
    own = sx.read("own.vtp")
    for k, result in enumerate((sx.smooth(own, "height", 0.3), sx.denoise(own, "height", method="auto", noise=0.1))):
        sx.write(f"api{k}.shape.gii", result, own)
        assert list(read_maps(f"api{k}.shape.gii")) == ["height"]
    smoothed = read_maps("both.func.gii")
    together = read_maps("both.npy")["both"]
    assert np.allclose(np.column_stack(list(smoothed.values())), together, atol=1e-6)


@pytest.mark.parametrize(
    ("arguments", "task"),
    [
        (["smooth", "brain.surf.gii", "noisy.shape.gii", "--width", "1"], "denoising.smooth"),
        (["denoise", "brain.surf.gii", "noisy.shape.gii"], "denoising.denoise"),
        (["noise", "brain.surf.gii", "noisy.shape.gii"], "noise_of_map.noise"),
        (["curvature", "brain.surf.gii", "--mask", "inside.npy"], "skeletons.mean_curvature"),
        (["geodesic", "brain.surf.gii", "5", "--mask", "inside.npy"], "skeletons.geodesic"),
    ],
)
def test_a_format_without_nan_is_refused_before_anything_is_computed(
    files: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, arguments: list[str], task: str
) -> None:
    monkeypatch.setattr(f"surfexp.tasks.{task}", lambda *given, **options: pytest.fail("it computed"))
    assert main([*arguments, "--to", "lh.out"]) == 2
    assert "lh.out cannot say NaN" in capsys.readouterr().err and not Path("lh.out").exists()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["plot", "own.vtp", "hieght", "--to", "a.png"], "no map that own carries; did you mean 'height'?"),
        (["smooth", "own.vtp", "x", "--width", "1", "--to", "a.gii"], "no map that own carries; it carries height"),
        (["denoise", "brain.surf.gii", "nosuch.gii", "--to", "a.gii"], "no such file"),
        (["denoise", "brain.surf.gii", "noisy.shape.gii"], "--to"),
        (["modes", "brain.surf.gii", "--to", "a.xyz"], "unknown format"),
        (["modes", "brain.surf.gii", "-k", "-3", "--to", "a.npz"], "-3"),
        (["smooth", "brain.surf.gii", "noisy.shape.gii", "--width", "wide", "--to", "a.gii"], "no width"),
        (["geodesic", "brain.surf.gii", "99999", "--to", "a.csv"], "99999"),
        (["modes", "brain.surf.gii", "--mask", "noisy.shape.gii:x", "--to", "a.npz"], "noisy.shape.gii"),
    ],
)
def test_mistakes_are_one_line_and_exit_code_2(
    files: Path, capsys: pytest.CaptureFixture[str], arguments: list[str], words: str
) -> None:
    assert main(arguments) == 2
    said = capsys.readouterr().err.strip()
    assert words in said and said.splitlines()[-1].startswith("surfexp: ")


@pytest.mark.parametrize("name", sorted(SECTIONS["Surfaces and maps"]))
def test_help_has_two_examples(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([name, "--help"]) == 0
    assert capsys.readouterr().out.count(f"surfexp {name} ") >= 3


def test_regions_leave_as_labels_with_their_proof(files: Path) -> None:
    assert main(["segment", "brain.surf.gii", "noisy.shape.gii", "--to", "parts.label.gii"]) == 0
    labels = nibabel.load("parts.label.gii")
    assert set(np.unique(labels.agg_data())) == {0, 1, 2}
    proof = certificate("parts.label.gii")
    assert proof["converged"] and proof["gap"] <= 1e-3 and proof["lower_bound"] <= proof["energy"]
    assert proof["options"] == {"tolerance": 1e-3, "map": "noisy.shape.gii"}
    assert main(["segment", "brain.surf.gii", "--to", "curved.annot"]) == 0
    assert "clipped" in certificate("curved.annot")["notes"][0]


@pytest.mark.parametrize(
    ("width", "unit", "wanted"),
    [
        ("0.5", "m", 0.5),
        ("500mm", "m", 0.5),
        ("50cm", "m", 0.5),
        ("0.5", "", 0.5),
        ("0.5mm", "mm", 0.5),
        ("500µm", "mm", 0.5),
        ("500 \u03bcm", "mm", 0.5),
        ("0.5um", "µm", 0.5),
        ("500nm", "um", 0.5),
        ("500um", "mm", 0.5),
        ("0.5m", "m", 0.5),
    ],
)
def test_a_width_is_in_the_unit_of_the_surface(working_folder: Path, width: str, unit: str, wanted: float) -> None:
    ball = sx.shape("icosphere", levels=2)
    sx.write("ball.surf.gii", ball)
    sx.write("height.csv", ball.vertices[:, 2])
    call = ["smooth", "ball.surf.gii", "height.csv", "--width", width, *(["--unit", unit] if unit else [])]
    assert main([*call, "--to", "smooth.npz"]) == 0
    said = json.loads(Path("smooth.npz.json").read_text())
    assert said["options"]["width"] == pytest.approx(wanted, rel=1e-15)
    assert not said["notes"]


@pytest.mark.parametrize(
    ("width", "unit", "line"),
    [
        (
            "5cm",
            "",
            "--width 5cm is in cm, the unit of the surface is not known: give --unit nm, um, mm, cm, m, or a number alone",
        ),
        (
            "0.006mm",
            "",
            "--width 0.006mm is in mm, the unit of the surface is not known: give --unit nm, um, mm, cm, m, or a number",
        ),
        ("5mm", "px", "--width 5mm is in mm, the surface in 'px': give --unit nm, um, mm, cm, m, or a number alone"),
        ("5 miles", "", "'5 miles' is no width: write 6 or 6mm (nm, um, mm, cm, m)"),
    ],
)
def test_widths_in_no_known_unit_are_refused(
    working_folder: Path, capsys: pytest.CaptureFixture[str], width: str, unit: str, line: str
) -> None:
    ball = sx.shape("icosphere", levels=2)
    sx.write("ball.surf.gii", ball)
    sx.write("height.csv", ball.vertices[:, 2])
    call = ["smooth", "ball.surf.gii", "height.csv", "--width", width, *(["--unit", unit] if unit else [])]
    assert main([*call, "--to", "smooth.npz"]) == 2
    assert line in capsys.readouterr().err


def test_a_kernel_wider_than_the_surface_is_said() -> None:
    ball = sx.shape("icosphere", levels=2)
    extent = 2.0 * 3.0**0.5
    assert not sx.smooth(ball, ball.vertices[:, 2], 0.9 * extent).notes
    assert sx.smooth(ball, ball.vertices[:, 2], 1.1 * extent).notes == (
        "The width 3.81051 is more than the extent of the surface, 3.46: the result is close to its mean.",
    )


def test_convert_takes_its_target_as_every_other_command(
    working_folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    sx.write("a.ply", sx.shape("icosphere", levels=1))
    assert main(["convert", "a.ply", "--to", "b.off"]) == 0 and main(["convert", "a.ply", "c.off"]) == 0
    assert Path("b.off").read_bytes() == Path("c.off").read_bytes()
    for targets in ([], ["c.off", "--to", "b.off"]):
        assert main(["convert", "a.ply", *targets]) == 2
        assert (
            f"{len(targets) and 2} targets are given, one is needed: surfexp convert SURFACE" in capsys.readouterr().err
        )


def test_each_attached_map_has_a_name_of_its_own(working_folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    sx.write("a.ply", sx.shape("icosphere", levels=1))
    sx.write("z.csv", np.arange(42.0))
    attached = ["--map", "h=z.csv", "--map"]
    assert main(["convert", "a.ply", "b.ply", *attached, "second=z.csv"]) == 0
    for wrong, line in (("h=other.csv", "'h' is z.csv already"), ("z.csv", "NAME=FILE"), ("=z.csv", "NAME=FILE")):
        assert main(["convert", "a.ply", "c.ply", *attached, wrong]) == 2
        assert line in capsys.readouterr().err and not Path("c.ply").exists()


def test_a_surface_where_a_map_is_needed_is_called_one(
    working_folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    sx.write("a.ply", sx.shape("icosphere", levels=1))
    assert main(["smooth", "a.ply", "a.ply", "--width", "1", "--to", "b.ply"]) == 2
    assert "a.ply cannot be read as a scalar map: it is a surface: give it first" in capsys.readouterr().err


def test_the_ways_out_of_a_defective_mesh_exist(working_folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Numbers are the file's, and every command that names --repair takes it."""
    ball = sx.shape("icosphere", levels=2)
    twice = np.r_[[[9.0, 9.0, 9.0]], ball.vertices], np.r_[ball.faces, ball.faces[-1:]] + 1
    sx.write("good.ply", ball)
    Path("bad.off").write_text(
        f"OFF\n{len(twice[0])} {len(twice[1])} 0\n"
        + "".join("{} {} {}\n".format(*row) for row in twice[0])
        + "".join("3 {} {} {}\n".format(*row) for row in twice[1])
    )
    assert main(["check", "bad.off"]) == 2
    found = capsys.readouterr().out.partition("non-manifold edges (")[2].partition(")")[0]
    for call in (
        ["modes", "bad.off", "-k", "3", "--to", "m.npz"],
        ["distance", "bad.off", "good.ply", "-n", "3"],
        ["align", "good.ply", "bad.off", "-k", "3", "--to", "a.npz"],
    ):
        assert main(call) == 2
        said = capsys.readouterr().err
        assert f"non-manifold edges ({found})" in said
        assert "give --repair (repair=True), or surfexp repair bad.off --to repaired.ply" in said
        assert main([*call, "--repair"]) == 0
        assert "bad.off: dropped, because" in capsys.readouterr().err
    assert main(["repair", "bad.off", "--to", "mended.ply"]) == 0
    assert "1 vertices have no face and keep their numbers: --renumber drops them." in capsys.readouterr().out
    two = sx.shape("icosphere", levels=1)
    sx.write("two.ply", (np.r_[two.vertices, two.vertices + 3.0], np.r_[two.faces, two.faces + len(two.vertices)]))
    assert main(["distance", "two.ply", "good.ply", "-n", "3"]) == 2
    assert "take the largest: a mask of it, or surfexp repair FILE --largest-component" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("file", "quantity"),
    [
        ("surf/lh.thickness", "thickness"),
        ("rh.curv", "curv"),
        ("clean.shape.gii", "clean"),
        ("lh.bold.func.gii.gz", "bold"),
        ("a/sulc.mgh", "sulc"),
        ("sulc", "sulc"),
        ("", ""),
    ],
)
def test_a_bar_is_named_by_what_the_file_is_about(file: str, quantity: str) -> None:
    assert quantity_named(file) == quantity
