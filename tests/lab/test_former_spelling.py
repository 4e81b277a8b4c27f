"""Experiments of earlier versions: refused with the present spelling, rewritten by a command, read in old results."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import yaml

from surfexp.commands.command_line import main
from surfexp.lab.errors import UserError
from surfexp.lab.experiment.claim import read_claims
from surfexp.lab.experiment.former_spelling import present, present_settings
from surfexp.lab.experiment.upgrade import upgraded
from surfexp.lab.experiment.written_out import written_out
from surfexp.lab.registry.catalogue import open_catalogue
from surfexp.lab.registry.folders import experiments

# former, present; comments and layout stay
FORMER = {
    "stage": ("surface: {cup: {vertices: 4000}}  # one handle", "surface: {name: cup, vertices: 4000}  # one handle"),
    "stage without options": ("surface: {cup: null}", "surface: {name: cup}"),
    "stage below its key": (
        "solver:\n  newton:\n    tolerance: 1.0e-10  # tight\nmodel: rof",
        "solver: {name: newton, tolerance: 1.0e-10}  # tight\nmodel: rof",
    ),
    "weight of a model": ("model: {name: tgv, w: 0.5, ratio: 2.0}", "model: {name: tgv, weight: 0.5, ratio: 2.0}"),
    "stages of a grid": ("grid: {operator: [fem, {libigl: {}}]}", "grid: {operator: [fem, {name: libigl}]}"),
    "input over an axis": (
        "distance_matrix: {name: signatures, inputs: {signatures: {over: b}}}",
        "distance_matrix: {name: signatures, inputs: {signatures: {dataset: b}}}",
    ),
    "sweep": (
        "figures: [denoising, {sweep: rmse, against: image.noise}]",
        "figures: [denoising, {name: sweep, metric: rmse, against: image.noise}]",
    ),
    "members by label": (
        "axes:\n  bones:\n    left, upper: {class: a, surface: {cup: {vertices: 9}}}\n    1.5: {surface: torus}",
        'datasets:\n  bones: [{label: "left, upper", class: a, surface: {name: cup, vertices: 9}}, {label: 1.5, surface: torus}]',
    ),
    "product": (
        "axes: {poses: {product: {surface.pose: {from: 1, to: 3}}, class: surface.pose}}",
        "datasets: {poses: [{grid: {surface.pose: [1, 2, 3]}, class: surface.pose}]}",
    ),
    "seeds of a product": (
        "axes: {a: {product: {image.noise: [1, 2], image.seed: {from: 0, to: 4}}}}",
        "datasets: {a: [{grid: {image.noise: [1, 2]}, repeat: {image.seed: 5}}]}",
    ),
    "list of products": (
        "axes:\n  a:\n    - &one\n      class: linear\n      product: {image.noise: [1, 2]}\n    - {<<: *one, class: b}",
        "datasets:\n  a:\n    - &one\n      class: linear\n      grid: {image.noise: [1, 2]}\n    - {<<: *one, class: b}",
    ),
    "defaults": ("defaults: [{/axes: subcortical}, _self_]", "defaults: [{/datasets: subcortical}, _self_]"),
    "claim below its statement": (
        "claims:\n  - It is small:\n      max: {metric: rmse, of: {solver.name: newton}}\n      between: [0, 3]",
        "claims:\n  - claim: It is small\n    quantity: {max: rmse}\n    rows: {solver.name: newton}\n    between: [0, 3]",
    ),
    "claim of a metric": (
        "claims:\n  - claim: It is small\n    all: rmse\n    between: [0, 3]",
        "claims:\n  - claim: It is small\n    quantity: {all: rmse}\n    between: [0, 3]",
    ),
    "ratio": (
        "claims:\n  - A: {ratio: {metric: rmse, of: {image.noise: 2}, to: {image.noise: 1}}, between: [0, 3]}",
        "claims:\n  - claim: A\n    quantity: {ratio: rmse}\n    rows: [{image.noise: 2}, {image.noise: 1}]\n"
        "    between: [0, 3]",
    ),
    "published": (
        'claims:\n  - {claim: A, published: {table: "2.2", value: "3"}, quantity: any, metric: rmse, between: [0, 3],\n'
        "    because: so}",
        'claims:\n  - claim: A\n    published: {table 2.2: "3"}\n    quantity: {any: rmse}\n    between: [0, 3]\n'
        "    because: so",
    ),
    "reference": (
        "claims:\n  - {claim: A, reference: Pleijel 1956, all: rmse, between: [0, 3], because: so}",
        "claims:\n  - claim: A\n    published: {Pleijel 1956: as stated}\n    quantity: {all: rmse}\n"
        "    between: [0, 3]\n    because: so",
    ),
    "not comparable": (
        'claims:\n  - {claim: A, published: {figure: "2", value: x}, all: rmse, not_comparable: Another machine.}',
        "claims:\n  - claim: A\n    published: {figure 2: x}\n    quantity: {all: rmse}\n    between: not comparable\n"
        "    because: Another machine.",
    ),
}


@pytest.mark.parametrize("texts", FORMER.values(), ids=FORMER)
def test_a_former_spelling_is_rewritten_refused_and_rewritten_once(texts: tuple[str, str]) -> None:
    former, now = texts
    assert upgraded(former) == now and upgraded(now) == now
    open_catalogue(Path.cwd())
    if "defaults" not in former:  # which Hydra reads itself
        with pytest.raises(UserError, match=r"is written .* now; `surfexp upgrade FILE` rewrites a file") as refused:
            written_out(yaml.safe_load(former))
        assert "\n" not in str(refused.value)
    if "claims" in now:
        read_claims(yaml.safe_load(now)["claims"])


@pytest.mark.parametrize("name", sorted(experiments()))
def test_the_experiments_have_no_former_spelling(name: str) -> None:
    text = experiments()[name].read_text(encoding="utf-8")
    assert upgraded(text) == text
    document = yaml.safe_load(text)
    assert present(document) is document


def test_an_anchor_that_is_used_elsewhere_means_the_same() -> None:
    former = (
        "axes: {rows: {one: &one {statistic: {first: 2}}}}\n"
        "variants:\n  - {<<: *one, operator: fem}\n"
        "solver: {newton: &tight {tolerance: 1.0e-9}}\n"
        "parts: {a: {solver: {primal_dual: *tight}}}\n"
    )
    found = yaml.safe_load(upgraded(former))
    assert found["variants"] == [{"statistic": {"first": 2}, "operator": "fem"}]
    assert found["datasets"] == {"rows": [{"label": "one", "statistic": {"first": 2}}]}
    assert found["parts"]["a"]["solver"] == {"name": "primal_dual", "tolerance": 1.0e-9}


def test_the_command_rewrites_files_and_moves_those_of_axes(
    working_folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    mine, old = working_folder / "mine.yaml", working_folder / "conf" / "axes" / "people.yaml"
    old.parent.mkdir(parents=True)
    mine.write_text("surface: {cup: {vertices: 4000}}\n")
    old.write_text("# of ours\nshapes:\n  anna: {surface: {file: {path: a.off}}}\n")
    assert main(["upgrade", str(mine), str(old), "--dry-run"]) == 0
    assert mine.read_text().startswith("surface: {cup") and old.exists()
    assert main(["upgrade", str(mine), str(old)]) == 0
    new = working_folder / "conf" / "datasets" / "people.yaml"
    assert new.read_text() == "# of ours\nshapes: [{label: anna, surface: {name: file, path: a.off}}]\n"
    assert mine.read_text() == "surface: {name: cup, vertices: 4000}\n" and not old.exists()
    assert "rewritten" in capsys.readouterr().out
    assert main(["upgrade", str(mine), str(new)]) == 0 and capsys.readouterr().out.count("up to date") == 2
    assert main(["upgrade", "nowhere.yaml"]) == 2 and "does not exist" in capsys.readouterr().err


def test_the_plan_of_an_earlier_version_is_read() -> None:
    settings: dict[str, Any] = {
        "experiment": "old",
        "axes": {"a": {"one": {"class": "x", "surface": {"name": "cup"}}}},
        "claims": [{"claim": "A", "quantity": "all", "metric": "rmse", "rows": {}, "between": [0, 1], "because": "so"}],
    }
    found = present_settings(settings)
    assert found["datasets"] == {"a": [{"label": "one", "class": "x", "surface": {"name": "cup"}}]}
    assert read_claims(found["claims"])[0].metric == "rmse" and "axes" not in found
