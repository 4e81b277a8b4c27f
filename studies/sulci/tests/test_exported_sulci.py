"""A table of sulcal lengths is exported with the named sulci of every surface."""

from __future__ import annotations

import csv
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from surfexp.anatomy.fsaverage5 import fsaverage5
from surfexp.commands.command_line import main
from surfexp.contract.member import Member
from surfexp.io.label_files import read_labels
from surfexp.lab.plan.resolution import make_plan
from surfexp.lab.registry.loading import load_all
from surfexp.lab.store.store import save
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.statistics.statistic import Statistic
from surfexp_studies.sulci import sulcal_export
from surfexp_studies.sulci.sulcal_measurement import NamedSulci


def test_sulci_have_the_labels_of_their_surfaces(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    ball = icosphere(2)
    regions = np.where(ball.mesh.vertices[:, 2] > 0, 1, -1)
    named = NamedSulci(np.arange(len(regions)), regions, regions)
    monkeypatch.setattr(sulcal_export, "make_template", lambda surface, count: SimpleNamespace(regions=regions))
    monkeypatch.setattr(sulcal_export, "name_sulci", lambda study, surface: named)
    surfaces = {Member("left anna"): ball, Member("right anna"): ball}
    files = list(sulcal_export.exported_sulci(tmp_path, ball, surfaces, regions=2))
    assert [label for label, _ in files] == [str(member) for member in surfaces for _ in range(3)]
    assert [file.name for _, file in files] == ["sulci.label.gii", "sulci.annot", "sulci.vtk"] * 2
    keys, names = read_labels(files[4][1])
    assert np.array_equal(keys, regions + 1) and names == ("unknown", "region 1", "region 2")


PIAL = {"surface": {"name": "fsaverage5", "sheet": "pial"}}
TABLE = {
    "experiment": "sulcal_table",
    "target": "statistic",
    "statistic": {
        "name": "sulcal_table",
        "regions": 2,
        "inputs": {"template": PIAL, "surfaces": {"dataset": "subjects"}},
    },
    "datasets": {
        "subjects": [{"label": f"{side} anna", "class": side, "group": "anna", **PIAL} for side in ("left", "right")]
    },
}


def rows_of(folder: Path) -> dict[str, dict[str, str]]:
    with (folder / "index.csv").open(newline="") as stream:
        return {row["file"]: row for row in csv.DictReader(stream)}


@pytest.mark.slow
def test_sulci_are_written_for_each_surface(tmp_path: Path) -> None:
    load_all(Path("/nonexistent"))
    plan = make_plan([TABLE])
    plan.write(tmp_path / "results")
    for key, node in plan.nodes.items():
        if node.kind == "surface":
            save(tmp_path / "results", node.kind, key, fsaverage5("left", "pial"))
    lengths = Statistic("sulcal lengths", {"sulcus": np.array([1.0])}, ("anna, left, sulcus 1",))
    save(tmp_path / "results", "statistic", plan.leaves[0].key, lengths)
    assert main(["export", "sulcal_table", "--to", str(tmp_path / "out"), "--results", str(tmp_path / "results")]) == 0
    tables = {name for name, row in rows_of(tmp_path / "out").items() if row["kind"] == "statistic"}
    sides = {f"{side}_anna{suffix}" for side in ("left", "right") for suffix in (".label.gii", ".annot", ".vtk")}
    assert tables == sides | {"statistic-sulcal_table.csv"}
    labels, _ = read_labels(tmp_path / "out" / "left_anna.annot")
    assert len(labels) == 10242 and labels.max() > 15 and 0.2 < (labels > 0).mean() < 0.6
