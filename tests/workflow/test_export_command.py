"""`surfexp export`: files from finished results, again and again."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest

from surfexp.anatomy.fsaverage5 import fsaverage5
from surfexp.commands.command_line import main
from surfexp.io.label_files import read_labels
from surfexp.statistics.statistic import Statistic
from surfexp.workflow import registry
from surfexp.workflow.plan import make_plan
from surfexp.workflow.store import save

registry.load_all(Path("/nonexistent"))
PIAL = {"surface": {"name": "fsaverage5", "sheet": "pial"}}
TABLE = {
    "experiment": "sulcal_table",
    "target": "statistic",
    "statistic": {
        "name": "sulcal_table",
        "regions": 2,
        "inputs": {"template": PIAL, "surfaces": {"over": "subjects"}},
    },
    "axes": {"subjects": {f"{side} anna": {"class": side, "group": "anna", **PIAL} for side in ("left", "right")}},
}
COUNTS = {"experiment": "counts", "target": "statistic", "statistic": "distance_growth"}


def planned(configuration: dict[str, object], results: Path, statistic: Statistic) -> str:
    plan = make_plan([configuration])
    plan.write(results)
    for key, node in plan.nodes.items():
        if node.kind == "surface":
            save(results, node.kind, key, fsaverage5("left", "pial"))
    save(results, "statistic", plan.leaves[0].key, statistic)
    return plan.leaves[0].key


def test_a_table_is_written_as_often_as_it_is_asked_for(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    columns = {"n": np.array([1.0, 2.0]), "share": np.array([[0.5, 0.4, 0.6], [0.25, np.nan, 0.3]])}
    planned(COUNTS, tmp_path / "results", Statistic("Shares, all", columns))
    for folder in ("first", "second"):
        arguments = ["export", "counts", "--to", str(tmp_path / folder), "--results", str(tmp_path / "results")]
        assert main(arguments) == 0
        file = tmp_path / folder / "shares_all.csv"
        assert capsys.readouterr().out.strip() == str(file)
        with file.open() as stream:
            assert list(csv.reader(stream)) == [
                ["row", "n", "share", "share, low", "share, high"],
                ["1", "1", "0.5", "0.4", "0.6"],
                ["2", "2", "0.25", "", "0.3"],
            ]


def test_what_is_not_finished_is_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    make_plan([COUNTS]).write(tmp_path)
    assert main(["export", "counts", "--results", str(tmp_path)]) == 2
    assert "is not finished: surfexp run experiment=counts" in capsys.readouterr().err


@pytest.mark.slow
def test_sulci_are_written_for_each_surface(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    lengths = Statistic("sulcal lengths", {"sulcus": np.array([1.0])}, ("anna, left, sulcus 1",))
    planned(TABLE, tmp_path / "results", lengths)
    assert main(["export", "sulcal_table", "--to", str(tmp_path), "--results", str(tmp_path / "results")]) == 0
    names = [Path(line).name for line in capsys.readouterr().out.split()]
    assert names[0] == "sulcal_lengths.csv" and len(names) == 7
    labels, _ = read_labels(tmp_path / "left_anna.annot")
    assert len(labels) == 10242 and labels.max() > 15 and 0.2 < (labels > 0).mean() < 0.6
