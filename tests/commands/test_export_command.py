"""`surfexp export`: every kind of stored result as files, read back by the tools that own the formats."""

from __future__ import annotations

import csv
import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import networkx
import nibabel
import numpy as np
import pandas
import pytest
from PIL import Image as Picture
from scipy.io import mmread
from scipy.sparse import load_npz

import surfexp as sx
from surfexp.commands.command_line import main
from surfexp.commands.exporting.folder import ExportFolder
from surfexp.commands.exporting.names import slug
from surfexp.contract.member import Member
from surfexp.embedding.distance import Distance
from surfexp.figures.figure import Figure
from surfexp.io.csv_cells import cell
from surfexp.io.label_files import read_labels, write_labels
from surfexp.io.reading import read_mesh
from surfexp.lab.digests import digest
from surfexp.lab.errors import UserError
from surfexp.lab.experiment.configuration import Settings
from surfexp.lab.plan.plan import Leaf, Node, Plan, flat_parameters
from surfexp.lab.registry import registry
from surfexp.lab.store.kinds import KINDS, stage_kind
from surfexp.lab.store.store import save
from surfexp.mesh.label_map import LabelMap
from surfexp.mesh.surface import Surface
from surfexp.mesh.surface_part import SurfacePart
from surfexp.operators.assembly import mass_matrix, stiffness
from surfexp.operators.calculus import gradient_matrix
from surfexp.operators.fem import fem
from surfexp.skeleton.feature import Feature
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.spectrum.signature import Signature
from surfexp.statistics.classification import Classification
from surfexp.statistics.distance_matrix import DistanceMatrix
from surfexp.statistics.point_embedding import PointEmbedding
from surfexp.statistics.statistic import Statistic
from surfexp.variational.image import Image
from surfexp.variational.solution import Solution

RNG = np.random.default_rng(1)
LABELS, CLASSES = ("../../evil", ".hidden", "Zoë, b"), ("a", "a", "b")


class Laboratory:
    """A results folder with a plan made by hand: what an export reads, without a run."""

    def __init__(self, folder: Path, experiment: str = "hand") -> None:
        self.results = folder / "results"
        self.plan = Plan(Settings(experiment=experiment))

    def stage(self, kind: str, plugin: str, result: Any = None, **parts: Any) -> str:
        """Add a stage with its inputs by role and its options; stored where there is a result."""
        inputs = {name: value for name, value in parts.items() if name not in ("options",)}
        options = parts.get("options", {})
        key = digest([kind, plugin, inputs, options])
        self.plan.nodes[key] = Node(key, kind, plugin, "", "", "", options, inputs)
        if result is not None:
            save(self.results, kind, key, result)
        return key

    def leaf(self, key: str, comparison: str = "", figures: tuple[str, ...] = (), **parameters: Any) -> None:
        """Ask for a stage: `solver__name` is the parameter solver.name."""
        settings = self.plan.settings.model_dump() | {"comparison": comparison, "target": self.plan.nodes[key].kind}
        named = {name.replace("__", "."): value for name, value in parameters.items()}
        assert named.items() <= flat_parameters(self.plan.nodes, key).items()
        self.plan.leaves.append(Leaf(key, key, settings, list(figures)))

    def export(self, *arguments: str, to: Path, code: int = 0, target: str = "") -> dict[str, dict[str, str]]:
        """Run the command; return the index by file."""
        self.plan.write(self.results)
        name = target or self.plan.settings.experiment
        assert main(["export", name, "--to", str(to), "--results", str(self.results), *arguments]) == code
        return rows_of(to) if (to / "index.csv").exists() else {}


def rows_of(folder: Path) -> dict[str, dict[str, str]]:
    with (folder / "index.csv").open(newline="") as stream:
        return {row["file"]: row for row in csv.DictReader(stream)}


@pytest.fixture
def laboratory(tmp_path: Path) -> Laboratory:
    return Laboratory(tmp_path)


@pytest.fixture(scope="module")
def sphere() -> Surface:
    made = sx.shape("icosphere", levels=2)
    height = made.mesh.vertices[:, 2]
    parcels = LabelMap((height > 0).astype(np.int64) - (height < -0.9), {0: "south", 1: "north"})
    return replace(made, scalars={'a "map"': height}, hemisphere="left", labels={"halves": parcels})


def system_of(surface: Surface) -> EigenSystem:
    vectors = RNG.standard_normal((len(surface.mesh.vertices), 3))
    return EigenSystem(np.array([0.0, 2.0, 2.0 + 1e-9]), vectors, np.full(3, 1e-12), 1e-14, True, clusters=((1, 3),))


def solution_of(surface: Surface) -> Solution:
    values = RNG.standard_normal(len(surface.mesh.vertices))
    dual = RNG.standard_normal((len(surface.mesh.faces), 2))
    history = {"iteration": np.array([10.0, 20.0]), "gap": np.array([0.1, 1 / 3])}
    regions = (values > 0).astype(float)
    return Solution(values, 1.5, dual, 1.4, 0.01, history=history, model="model", segmentation=regions, notes=("said",))


def arrays(path: Path) -> dict[str, np.ndarray]:
    with np.load(path, allow_pickle=False) as archive:
        return dict(archive)


def test_surfaces_carry_the_maps_that_were_made_on_them(
    laboratory: Laboratory, sphere: Surface, tmp_path: Path
) -> None:
    surface = laboratory.stage("surface", "ball", sphere)
    values = RNG.standard_normal((len(sphere.mesh.vertices), 2))
    picture = Image(values, "bright", clean=2 * values, known=values[:, 0] > 0, labels={"top/half": values[:, 1] > 0})
    image = laboratory.stage("image", "noisy", picture, surface=surface)
    solution = solution_of(sphere)
    for weight in (0.1, 0.2):
        solver = laboratory.stage("solver", "rof", solution, surface=surface, image=image, options={"weight": weight})
        laboratory.leaf(solver, solver__name="rof", solver__weight=weight)
    index = laboratory.export(to=tmp_path / "out")
    assert {Path(name).suffixes[-1] for name in index} == {".vtp", ".gii", ".npz", ".csv"}
    vertices, faces, maps = read_mesh(tmp_path / "out" / "surface-ball.vtp")
    assert np.array_equal(vertices, sphere.mesh.vertices) and np.array_equal(faces, sphere.mesh.faces)
    assert np.array_equal(maps["solver-rof-weight_0.1"], solution.values) and np.array_equal(
        maps["image-noisy 1"], values[:, 1]
    )
    assert np.array_equal(maps["image-noisy clean 0"], 2 * values[:, 0])
    assert np.array_equal(maps["halves"], sphere.labels["halves"].keys)

    points, triangles = nibabel.load(tmp_path / "out" / "surface-ball.surf.gii").agg_data()
    assert np.array_equal(points, vertices.astype(np.float32)) and np.array_equal(triangles, faces)
    maps_of_image = nibabel.load(tmp_path / "out" / "image-noisy.shape.gii")
    assert [array.metadata["Name"] for array in maps_of_image.darrays][:2] == ["bright 0", "bright 1"]
    assert maps_of_image.meta["AnatomicalStructurePrimary"] == "CortexLeft"
    assert np.array_equal(maps_of_image.darrays[1].data, values[:, 1].astype(np.float32))
    halves = nibabel.load(tmp_path / "out" / "surface-ball-halves.label.gii")
    assert np.array_equal(halves.agg_data(), sphere.labels["halves"].keys)
    assert halves.labeltable.get_labels_as_dict() == {-1: "no label -1", 0: "south", 1: "north"}
    regions = nibabel.load(tmp_path / "out" / "solver-rof-weight_0.1-segmentation.label.gii").agg_data()
    assert np.array_equal(regions, solution.segmentation)
    reference = nibabel.load(tmp_path / "out" / "image-noisy-half.label.gii").agg_data()
    assert np.array_equal(reference, picture.labels["top/half"])

    exact = arrays(tmp_path / "out" / "solver-rof-weight_0.1.npz")
    assert np.array_equal(exact["values"], solution.values) and np.array_equal(exact["dual"], solution.dual)
    history = pandas.read_csv(tmp_path / "out" / "solver-rof-weight_0.1-history.csv")
    assert np.array_equal(history["gap"], solution.history["gap"])
    row = index["solver-rof-weight_0.2.npz"]
    assert (row["solver.weight"], row["converged"], row["plugin"]) == ("0.2", "1.0", "rof")
    proof = json.loads((tmp_path / "out" / "solver-rof-weight_0.2.npz.json").read_text())
    assert proof["method"] == "solver/rof" and proof["options"] == {"weight": 0.2} and proof["notes"] == ["said"]
    assert proof["inputs"] == {"surface": surface, "image": image} and proof["key"] == row["key"]
    assert proof["result"]["lower_bound"] == 1.4 and proof["metrics"]["converged"] == 1.0 and proof["versions"]["numpy"]


def test_a_result_on_a_part_is_written_for_the_whole_too(
    laboratory: Laboratory, sphere: Surface, tmp_path: Path
) -> None:
    count = len(sphere.mesh.vertices)
    part = SurfacePart(sphere.mesh, np.arange(count) + 5, count + 5)
    surface = laboratory.stage("surface", "cut", replace(sphere, part=part))
    values = sphere.mesh.vertices[:, 0]
    laboratory.leaf(laboratory.stage("feature", "height", Feature(values), surface=surface), feature__name="height")
    laboratory.export(to=tmp_path / "out")
    whole = nibabel.load(tmp_path / "out" / "feature-height-whole.shape.gii").agg_data()
    assert np.isnan(whole[:5]).all() and np.array_equal(whole[5:], values.astype(np.float32))
    _, _, maps = read_mesh(tmp_path / "out" / "surface-cut.vtp")
    assert np.array_equal(maps["vertex of the whole"], part.vertices) and np.array_equal(maps["feature-height"], values)


def test_matrices_and_modes_leave_for_numpy_and_scipy(laboratory: Laboratory, sphere: Surface, tmp_path: Path) -> None:
    surface = laboratory.stage("surface", "ball", sphere)
    made, system = fem(sphere.mesh), system_of(sphere)
    operator = laboratory.stage("operator", "fem", made, surface=surface)
    eigensolver = laboratory.stage("eigensolver", "lanczos", system, surface=surface, operator=operator)
    correspondence = np.arange(4)
    close = Distance(0.5, 0.25, False, 7, np.eye(2), np.ones((3, 2)), np.ones((4, 2)), correspondence, method="signs")
    distance = laboratory.stage("distance", "spectral", close, source=eigensolver, target=eigensolver)
    laboratory.leaf(distance, distance__name="spectral")
    index = laboratory.export("--all", "--matrix-market", to=tmp_path / "out")
    assert {row["kind"] for row in index.values()} == {"surface", "operator", "eigensolver", "distance"}
    expected = {"stiffness": stiffness(made), "mass": mass_matrix(made), "gradient": gradient_matrix(made)}
    for name, matrix in expected.items():
        for read in (
            load_npz(tmp_path / "out" / f"operator-fem-{name}.npz"),
            mmread(tmp_path / "out" / f"operator-fem-{name}.mtx"),
        ):
            assert read.shape == matrix.shape and abs(read - matrix).max() == 0.0
    modes = arrays(tmp_path / "out" / "eigensolver-lanczos.npz")
    assert np.array_equal(modes["vectors"], system.vectors) and np.array_equal(modes["residuals"], system.residuals)
    values = pandas.read_csv(tmp_path / "out" / "eigensolver-lanczos-values.csv")
    assert np.array_equal(values["value"], system.values) and list(values["cluster"]) == [0, 1, 1]
    assert np.array_equal(arrays(tmp_path / "out" / "distance-spectral.npz")["correspondence"], correspondence)
    row = pandas.read_csv(tmp_path / "out" / "distance-spectral.csv").loc[0]
    assert (row["value"], row["lower_bound"], bool(row["optimal"])) == (0.5, 0.25, False)
    assert "eigensolver" not in {one["kind"] for one in laboratory.export(to=tmp_path / "rows").values()}


def test_a_skeleton_leaves_for_viewers_and_graph_programs(
    laboratory: Laboratory, sphere: Surface, tmp_path: Path
) -> None:
    graph = sx.reeb_graph(sphere, sphere.mesh.vertices[:, 2], count=4)
    surface = laboratory.stage("surface", "ball", sphere)
    laboratory.leaf(laboratory.stage("skeleton", "reeb", graph, surface=surface), skeleton__name="reeb")
    laboratory.export("--kind", "skeleton", to=tmp_path / "out")
    read = networkx.read_graphml(tmp_path / "out" / "skeleton-reeb.graphml")
    assert np.array_equal([read.nodes[str(k)]["value"] for k in range(len(graph.values))], graph.values)
    assert read.number_of_edges() == len(graph.arcs)
    lines = (tmp_path / "out" / "skeleton-reeb.vtk").read_text().splitlines()
    points = np.array([line.split() for line in lines[5 : 5 + len(graph.positions)]], dtype=float)
    assert np.allclose(points, graph.positions, rtol=1e-8, atol=1e-8)


def test_tables_keep_every_digit_and_every_label(laboratory: Laboratory, tmp_path: Path) -> None:
    surfaces = {label: laboratory.stage("surface", f"shape{k}") for k, label in enumerate(LABELS)}
    third = np.array([[0.0, 1 / 3, 0.5], [1 / 3, 0.0, 0.1], [0.5, 0.1, 0.0]])
    matrix = DistanceMatrix(LABELS, third, CLASSES, coordinates=third[:, :2])
    distances = laboratory.stage("distance_matrix", "euclid", matrix, surfaces=surfaces)
    points = PointEmbedding(third[:, :2], LABELS, CLASSES, LABELS)
    found = Classification(LABELS, CLASSES, LABELS, ("a", "b", "b"), ("a", "b"), np.array([[1, 1], [0, 1]]))
    signature = Signature(third[0], "dna", {"area": np.array([2.0])})
    table = Statistic(
        "Shares, all", {"n": np.array([1.0, 2.0]), "share": np.array([[1 / 3, 0.4, 0.6], [0.25, np.nan, 0.3]])}
    )
    for kind, plugin, result in (
        ("embedding", "mds", points),
        ("classifier", "knn", found),
        ("signature", "dna", signature),
        ("statistic", "shares", table),
    ):
        key = laboratory.stage(kind, plugin, result, distances=distances)
        laboratory.leaf(key, comparison=f"table of {plugin}", **{f"{kind}__name": plugin})
    index = laboratory.export("--kind", "distance_matrix", to=tmp_path / "out")
    read = pandas.read_csv(tmp_path / "out" / "distance_matrix-euclid.csv")
    assert tuple(read["label"]) == LABELS and tuple(read["class"]) == CLASSES and tuple(read.columns[3:]) == LABELS
    assert np.array_equal(read[list(LABELS)], third)
    assert np.array_equal(
        pandas.read_csv(tmp_path / "out" / "distance_matrix-euclid-coordinates.csv")[["x1", "x2"]], third[:, :2]
    )
    index = laboratory.export(to=tmp_path / "out")
    assert {row["kind"] for row in index.values()} == {
        "distance_matrix",
        "embedding",
        "classifier",
        "signature",
        "statistic",
    }
    folder = tmp_path / "out"
    assert np.array_equal(pandas.read_csv(folder / "embedding-table_of_mds-mds.csv")[["x1", "x2"]], points.points)
    assert tuple(pandas.read_csv(folder / "classifier-table_of_knn-knn.csv")["predicted"]) == found.predicted
    confusion = pandas.read_csv(folder / "classifier-table_of_knn-knn-confusion.csv", index_col=0)
    assert np.array_equal(confusion, found.confusion) and tuple(confusion.columns) == found.names
    numbers = pandas.read_csv(folder / "signature-table_of_dna-dna.csv")
    assert np.array_equal(numbers[numbers["signature"] == "dna"]["value"], third[0]) and len(numbers) == 4
    with (folder / "statistic-table_of_shares-shares.csv").open() as stream:
        assert list(csv.reader(stream)) == [
            ["row", "n", "share", "share, low", "share, high"],
            ["1", "1", repr(1 / 3), "0.4", "0.6"],
            ["2", "2", "0.25", "", "0.3"],
        ]


def test_figures_are_the_pictures_of_the_report(laboratory: Laboratory, sphere: Surface, tmp_path: Path) -> None:
    pixels = RNG.integers(0, 255, (8, 9, 3), dtype=np.uint8)
    surface = laboratory.stage("surface", "ball", sphere)
    drawn, other = (
        laboratory.stage("figure", name, Figure(pixels, "What is seen."), surface=surface) for name in ("map", "plot")
    )
    laboratory.leaf(surface, figures=(drawn, other), surface__name="ball")
    report = laboratory.results / "hand" / "figures" / f"plot-{other[:8]}.png"
    report.parent.mkdir(parents=True)
    report.write_bytes(b"bytes of the report")
    laboratory.export(to=tmp_path / "out")
    with Picture.open(tmp_path / "out" / "figure-map-ball.png") as picture:
        assert np.array_equal(np.asarray(picture), pixels)
    assert (tmp_path / "out" / "figure-plot-ball.png").read_bytes() == b"bytes of the report"
    proof = json.loads((tmp_path / "out" / "figure-map-ball.png.json").read_text())
    assert proof["result"]["caption"] == "What is seen."


@dataclass(frozen=True, eq=False)
class Thickness:
    values: np.ndarray
    by_side: dict[str, np.ndarray]
    metrics: dict[str, float] = field(default_factory=dict)


def test_a_kind_of_ones_own_leaves_as_arrays_and_metrics(
    laboratory: Laboratory, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("surfexp.lab.store.kinds.KINDS", KINDS)
    stage_kind("toy_thickness", Thickness)
    try:
        result = Thickness(np.arange(3.0), {"../up": np.ones(2)}, {"mean": 1 / 3, "odd": float("nan")})
        laboratory.leaf(laboratory.stage("toy_thickness", "layers", result), toy_thickness__name="layers")
        index = laboratory.export(to=tmp_path / "out")
    finally:
        del KINDS["toy_thickness"]
    found = arrays(tmp_path / "out" / "toy_thickness-layers.npz")
    assert set(found) == {"values", "by_side._up"} and np.array_equal(found["values"], result.values)
    metrics = pandas.read_csv(tmp_path / "out" / "toy_thickness-layers.csv", index_col=0)["value"]
    assert metrics["mean"] == 1 / 3 and np.isnan(metrics["odd"])
    assert index["toy_thickness-layers.csv"]["mean"] == repr(1 / 3)
    assert json.loads((tmp_path / "out" / "toy_thickness-layers.csv.json").read_text())["metrics"]["odd"] == "nan"


def test_labels_of_strangers_never_leave_the_folder(laboratory: Laboratory, sphere: Surface, tmp_path: Path) -> None:
    labels = (*LABELS, "/etc/passwd", "..", "CON\\aux", "左", "右", "x" * 300, "a\nb", "-rf")
    members = {
        label: laboratory.stage(
            "surface", "shape", replace(sphere, labels={label: sphere.labels["halves"]}), options={"n": k}
        )
        for k, label in enumerate(labels)
    }
    table = Statistic("t", {"n": np.ones(1)})
    laboratory.leaf(laboratory.stage("statistic", "spread", table, surfaces=members), statistic__name="spread")
    before = {path for path in tmp_path.rglob("*") if "results" not in path.parts}
    index = laboratory.export("--kind", "surface", to=tmp_path / "deep" / "out")
    written = {path for path in tmp_path.rglob("*") if "results" not in path.parts and path.is_file()} - before
    assert {path.parent for path in written} == {tmp_path / "deep" / "out"}
    assert all(path.name[0] not in ".-" and path.name.isascii() and len(path.name) < 150 for path in written)
    assert len(index) == 3 * len(labels) and {row["label"] for row in index.values()} == set(map(cell, labels))
    assert len({name.lower() for name in index}) == len(index)


@pytest.mark.parametrize(
    ("value", "name"),
    [("../../a b", "a_b"), ("...", ""), (0.1 + 0.2, "0.3"), ("Zoë", "zoe"), ("/data/lh.white", "lh.white"), (-5, "5")],
)
def test_a_slug_is_safe(value: Any, name: str) -> None:
    assert slug(value) == name


def test_files_of_others_are_not_overwritten_and_own_ones_are(
    laboratory: Laboratory, sphere: Surface, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    surface = laboratory.stage("surface", "ball", sphere)
    laboratory.leaf(laboratory.stage("feature", "height", Feature(np.arange(162.0)), surface=surface))
    first = laboratory.export(to=tmp_path / "out")
    assert laboratory.export(to=tmp_path / "out") == first
    only = laboratory.export("--kind", "surface", to=tmp_path / "out")
    assert only == first, "the index keeps what an earlier export has written"

    mine = tmp_path / "out" / "feature-height.shape.gii"
    for occupied in (mine, tmp_path / "out" / f"{mine.name}.json"):
        for path in (tmp_path / "out").iterdir():
            path.unlink()
        occupied.write_text("mine")
        capsys.readouterr()
        laboratory.export(to=tmp_path / "out", code=2)
        assert f"{occupied} is not of an earlier export" in capsys.readouterr().err
        assert occupied.read_text() == "mine" and list((tmp_path / "out").iterdir()) == [occupied]
    (tmp_path / "out" / "index.csv").write_text("a,b\n1,2\n")
    assert main(["export", "hand", "--to", str(tmp_path / "out"), "--results", str(laboratory.results)]) == 2
    assert "is not the index of an export" in capsys.readouterr().err


def test_an_interrupted_export_leaves_nothing(tmp_path: Path) -> None:
    with pytest.raises(KeyboardInterrupt), ExportFolder(tmp_path / "out") as folder:
        folder.claim("a", ".csv").write_text("half")
        raise KeyboardInterrupt
    assert not (tmp_path / "out").exists()
    with ExportFolder(tmp_path / "out") as folder:
        names = [folder.claim("a", ".csv").name for _ in range(2)]
        for name in names:
            (folder.staging / name).write_text("whole")
        folder.publish([{"file": name, "kind": "k", "plugin": "p", "comparison": "", "label": ""} for name in names])
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == ["a-2.csv", "a.csv", "index.csv"]
    (tmp_path / "file").write_text("")
    with pytest.raises(UserError, match="is a file"):
        ExportFolder(tmp_path / "file")


def test_what_is_not_finished_is_named_with_the_way_to_finish_it(
    laboratory: Laboratory, sphere: Surface, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    surface = laboratory.stage("surface", "ball")
    good = laboratory.stage("feature", "height", surface=surface)
    laboratory.leaf(good, feature__name="height")
    bad = laboratory.stage("feature", "depth", surface=surface)
    laboratory.leaf(bad, feature__name="depth")
    event = laboratory.results / "events" / "feature" / f"{bad}.json"
    event.parent.mkdir(parents=True)
    event.write_text(json.dumps({"failure": "feature/depth: planted"}))
    assert laboratory.export(to=tmp_path / "out", code=1) == {} and not (tmp_path / "out").exists()
    said = capsys.readouterr().err.splitlines()
    finish = f"surfexp run experiment=hand results={laboratory.results}"
    assert f"surfexp: left out: feature/height feature-height is not finished: {finish}" in said
    assert f"surfexp: left out: feature/depth feature-depth has no result (feature/depth: planted): {finish}" in said
    save(laboratory.results, "feature", good, Feature(np.arange(162.0)))
    save(laboratory.results, "surface", surface, sphere)
    damaged = laboratory.results / "store" / "surface" / surface / "arrays.npz"
    damaged.write_bytes(damaged.read_bytes()[:-1])
    assert {row["kind"] for row in laboratory.export(to=tmp_path / "out").values()} == {"feature"}
    assert "arrays.npz does not have the digest" in capsys.readouterr().err
    for number in range(20):
        other = laboratory.stage("feature", f"other{number}", surface=surface)
        laboratory.leaf(other, feature__name=f"other{number}")
    laboratory.export("--kind", "feature", to=tmp_path / "out")
    assert capsys.readouterr().err.splitlines()[-2] == "surfexp: left out: and 11 more"


def test_one_run_is_exported_by_the_key_of_its_row(
    laboratory: Laboratory, sphere: Surface, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    surface = laboratory.stage("surface", "ball", sphere)
    keys = []
    for level in (1, 2):
        feature = Feature(np.full(162, float(level)))
        keys.append(laboratory.stage("feature", "height", feature, surface=surface, options={"level": level}))
        laboratory.leaf(keys[-1], feature__level=level)
    for target in (keys[1], keys[1][:8]):
        index = laboratory.export(to=tmp_path / target, target=target)
        assert {row["key"] for row in index.values()} == {keys[1], surface}
        assert "feature-height-level_2.shape.gii" in index, "files are called as in an export of everything"
    laboratory.export(to=tmp_path / "out", target="hnad", code=2)
    assert "unknown experiment or run" in (said := capsys.readouterr().err) and "did you mean 'hand'?" in said
    laboratory.export(to=tmp_path / "out", target="quickstart", code=2)
    assert "surfexp run experiment=quickstart" in capsys.readouterr().err
    for unknown in ("0" * 20, "0" * 32):
        laboratory.export(to=tmp_path / "out", target=unknown, code=2)
    capsys.readouterr()
    laboratory.export("--kind", "featur", to=tmp_path / "out", code=2)
    assert "unknown kind of results of 'hand' 'featur'; did you mean 'feature'?" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_a_run_of_the_dashboard_is_exported_by_its_id(laboratory: Laboratory, sphere: Surface, tmp_path: Path) -> None:
    from mlflow.tracking import MlflowClient

    from surfexp.records.tracking import record
    from surfexp.report.page import write_report

    surface = laboratory.stage("surface", "ball", sphere)
    laboratory.leaf(surface, surface__name="ball")
    laboratory.plan.write(laboratory.results)
    record(laboratory.plan, laboratory.results).attach(write_report(laboratory.plan, laboratory.results))
    client = MlflowClient(f"sqlite:///{laboratory.results / 'mlflow.db'}")
    experiment = client.get_experiment_by_name("hand")
    assert experiment is not None
    runs = client.search_runs([experiment.experiment_id])
    assert len(runs) == 2
    for run in runs:
        index = laboratory.export(to=tmp_path / "out", target=run.info.run_id)
        assert {row["key"] for row in index.values()} == {surface}


def toy_table(template: Surface, surfaces: dict[Member, Surface], *, level: float = 0.0) -> Statistic:
    """A table of one's own surfaces, which is exported with labels of each."""
    return Statistic("heights")


def labels_above(
    folder: Path, template: Surface, surfaces: Mapping[Member, Surface], *, level: float
) -> Iterator[tuple[str, Path]]:
    for number, (member, surface) in enumerate(surfaces.items()):
        file = folder / f"{number}.annot"
        write_labels(file, (surface.mesh.vertices[:, 2] > level).astype(np.int64), ("below", template.name))
        yield str(member), file


def test_what_a_plugin_writes_beside_its_result_has_the_names_it_gives_and_what_is_missing_is_said(
    laboratory: Laboratory,
    sphere: Surface,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setitem(registry.PLUGINS, ("statistic", "toy_table"), None)  # restored at the end
    del registry.PLUGINS["statistic", "toy_table"]
    registry.register("statistic", "toy_table", exports=labels_above)(toy_table)
    ball = laboratory.stage("surface", "ball", sphere)
    members = {"left anna": ball, "../LEFT anna": ball, "right": laboratory.stage("surface", "missing")}
    lengths = Statistic("lengths", {"length": np.array([1.0])}, ("left anna",))
    table = laboratory.stage("statistic", "toy_table", lengths, template=ball, surfaces=members, options={"level": 0.5})
    laboratory.leaf(table, statistic__name="toy_table")
    index = laboratory.export("--kind", "statistic", to=tmp_path / "out")
    assert set(index) == {"statistic-toy_table.csv", "left_anna.annot", "left_anna-2.annot"}
    keys, names = read_labels(tmp_path / "out" / "left_anna-2.annot")
    assert np.array_equal(keys, sphere.mesh.vertices[:, 2] > 0.5) and names == ("below", sphere.name)
    assert "left out: further files" in capsys.readouterr().err


def test_help_has_two_examples(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["export", "--help"]) == 0
    assert capsys.readouterr().out.count("surfexp export ") >= 3
