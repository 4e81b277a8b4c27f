"""On data of one's own nothing is said that an experiment's file says of its own data."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from surfexp.io.writing import write_mesh
from surfexp.lab.composition.launch import launch
from surfexp.lab.errors import UserError
from surfexp.lab.experiment.own_data import CLAIMS_LEFT_OUT, with_datasets, without_foreign_words
from surfexp.lab.plan.plan import Plan
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.torus import torus
from surfexp.report.page import write_report

EXPERIMENT = {
    "experiment": "cup",
    "title": "A cup (figure 2.2)",
    "description": "A cup.",
    "caption": "On a cup.",
    "claims": [{"claim": "x"}],
    "surface": "cup",
    "figures": ["denoising", {"name": "sweep", "title": "Cup", "caption": "cup", "reference": "2.2", "metric": "rmse"}],
    "variants": [{"comparison": "The cup", "caption": "A"}, {"comparison": "Its handle"}, {"comparison": "The cup"}],
}
METHODS = ["solver=newton", "solver.tolerance=1e-3", "++model.weight=1", "eigensolver=slicing,arpack"]
DATA = [
    "surface=file",
    "++surface.levels=3",
    "image.noise=3",
    "datasets=blobs",
    "+datasets=blobs",
    "grid.image.seed=[1]",
]


@pytest.mark.parametrize("override", ["results=x", "cores=2", "timing=true", "title=mine", "columns=[rmse]"])
def test_what_changes_no_stage_changes_no_word(override: str) -> None:
    assert without_foreign_words(EXPERIMENT, ["experiment=cup", override]) == EXPERIMENT


@pytest.mark.parametrize("override", METHODS)
def test_another_method_leaves_the_claims_out_and_says_so(override: str) -> None:
    words = without_foreign_words(EXPERIMENT, [override])
    assert words == EXPERIMENT | {"claims": [], "description": f"A cup. {CLAIMS_LEFT_OUT}"}


@pytest.mark.parametrize("override", [*DATA, "statistic.inputs.template.surface=file"])
def test_other_data_leave_titles_and_captions_out_too(override: str) -> None:
    words = without_foreign_words(EXPERIMENT, [override])
    assert words["claims"] == [] and words["title"].startswith("cup: ") and "caption" not in words
    assert words["figures"] == ["denoising", {"name": "sweep", "metric": "rmse"}]
    assert words["variants"] == [{"comparison": "Table 1"}, {"comparison": "Table 2"}, {"comparison": "Table 1"}]
    assert words["surface"] == "cup"  # stages are the business of overrides


def test_tables_on_own_data_are_called_by_their_task() -> None:
    experiment = {
        "experiment": "cup",
        "target": "classifier",
        "classifier": "nearest_neighbour",
        "variants": [
            {"comparison": "Animals"},
            {"comparison": "What figure 4.8 shows", "target": "statistic", "statistic": {"name": "class_readings"}},
            {"comparison": "More animals"},
            {"comparison": "A cup", "target": "solver", "model": {"name": "rof", "weight": 1.0}},
            {"comparison": "Animals"},
        ],
    }
    words = without_foreign_words(experiment, ["datasets=mine"])
    assert [variant["comparison"] for variant in words["variants"]] == [
        "Classifier: nearest neighbour",
        "Statistic: class readings",
        "Classifier: nearest neighbour, 2",
        "Model: rof",
        "Classifier: nearest neighbour",
    ]
    # a method that is asked for, or several, in place of the experiment's
    for override, cup in (("model=chan_vese", "Model: chan vese"), ("model=rof,tgv", "Table 4")):
        words = without_foreign_words(experiment, ["surface=file", override])
        assert words["variants"][3]["comparison"] == cup and words["variants"][0] == words["variants"][4]


@pytest.mark.parametrize(
    ("overrides", "title"),
    [
        (["surface=file", "surface.path=/data/lh.white"], "cup: lh.white"),
        (["surface.path='my brain.ply'", "surface=file", "image.path=a/b.gii"], "cup: b.gii, my brain.ply"),
        (["+datasets=blobs"], "cup: blobs"),
        (["surface.path=a/one.ply,b/two.ply,three.ply"], "cup: one.ply and 2 more"),
        (["datasets.people=blobs", "surface=icosphere"], "cup: blobs, icosphere"),
        (["grid.image.seed=[1]"], "cup: other data"),
        (["image.noise=3"], "cup: other data"),
    ],
)
def test_the_title_names_the_data_in_their_place(overrides: list[str], title: str) -> None:
    assert without_foreign_words(EXPERIMENT, overrides)["title"] == title


@pytest.fixture
def blobs(working_folder: Path) -> Path:
    items = []
    for number in range(4):
        for name, surface in (("ball", icosphere(1 + number % 2)), ("ring", torus(8 + number, 6))):
            file = working_folder / f"{name}{number}.ply"
            write_mesh(file, surface.mesh)
            items.append({"label": f"{name} @ {number}", "surface": {"name": "file", "path": str(file)}})
    datasets = working_folder / "conf" / "datasets" / "blobs.yaml"
    datasets.parent.mkdir(parents=True)
    datasets.write_text(yaml.safe_dump({"shapes": items}))
    return working_folder


def test_blobs_through_an_experiment_on_animals_show_nothing_of_animals(blobs: Path) -> None:
    plans: list[Plan] = []
    launch(["experiment=tosca_classification", "datasets=blobs"], plans.append)
    page = (write_report(plans[0], blobs / "results") / "report.html").read_text()
    assert len(plans[0].leaves) == 11 and "tosca_classification: blobs" in page
    for foreign in ("figure 4.8", "Animals", ">reproduced<", "centaur", "Lioness", "several poses", 'class="claims"'):
        assert foreign not in page, foreign


OWN = {"shapes": [{"surface": "file"}]}
BALL = [{"surface": "icosphere"}]
BALLS = [{"grid": {"surface.levels": [1, 2]}}]


def test_a_dataset_of_ones_own_replaces_the_one_dataset_of_surfaces() -> None:
    noise = [{"image": {"noise": 1}}]
    assert with_datasets({"people": BALLS, "noise": noise}, {"": OWN}) == {"people": OWN["shapes"], "noise": noise}
    assert with_datasets({"people": BALL, "shapes": BALL}, {"": OWN}) == {"people": BALL, **OWN}
    several = {"people": BALL, "gyri": BALL}
    assert with_datasets(several, {"gyri": OWN}) == {"people": BALL, "gyri": OWN["shapes"]}
    assert with_datasets(several, {}) == several


@pytest.mark.parametrize(
    ("datasets", "given", "words"),
    [
        (
            {"people": BALL, "gyri": BALL},
            {"": OWN},
            r"2 datasets of surfaces, choose datasets\.people=NAME, datasets\.gyri=NAME",
        ),
        ({"noise": [{"label": "low"}]}, {"": OWN}, "compares no surfaces of a dataset"),
        ({"people": BALL}, {"peopel": OWN}, "people"),
    ],
)
def test_it_is_said_which_dataset_can_be_replaced(datasets: dict, given: dict, words: str) -> None:
    with pytest.raises(UserError, match=words):
        with_datasets(datasets, given)


def test_every_experiment_with_datasets_takes_ones_own(blobs: Path) -> None:
    plans: list[Plan] = []
    launch(["experiment=spectral_mds", "datasets.shapes=blobs", "datasets.structures=blobs"], plans.append)
    launch(["experiment=callosum_group", "datasets=blobs"], plans.append)
    for plan in plans:
        surfaces = [node for node in plan.nodes.values() if node.kind == "surface" and node.plugin == "file"]
        assert len(surfaces) == 6  # of the eight files two pairs hold the same bytes
    with pytest.raises(UserError, match=r"unknown dataset 'blob'; did you mean 'blobs'"):
        launch(["experiment=callosum_group", "datasets=blob"], plans.append)
    with pytest.raises(UserError, match=r"axes=blobs: axes are called datasets now: write datasets=blobs"):
        launch(["experiment=callosum_group", "axes=blobs"], plans.append)
