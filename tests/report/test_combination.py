"""What no run can compute is refused when it is planned; what can be computed, published schemes too, is planned."""

from __future__ import annotations

from pathlib import Path

import pytest

from surfexp.commands.command_line import main

PLAIN = ["columns=[]", "figures=[]", "surface=icosphere", "image=two_phase"]


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (
            ["model=convex_chan_vese", "solver=chambolle_dual", "operator=fem"],
            "'chambolle_dual' does not solve model 'convex_chan_vese', choose one of primal_dual",
        ),
        (["model=multiphase", "solver=primal_dual", "operator=vertex_averaged"], "needs a consistent operator"),
        (["model=rof", "solver=newton", "operator=vertex_averaged"], "with a vertex-averaged operator"),
    ],
)
def test_a_wrong_combination_is_refused_before_anything_runs(
    options: list[str], said: str, working_folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["plan", *PLAIN, *options]) == 2
    line = capsys.readouterr().err
    assert said in line and "published_" not in line.replace("as_published", "") and len(line.splitlines()) == 1


def test_published_schemes_and_foreign_solvers_are_planned(working_folder: Path) -> None:
    published = ["model=convex_chan_vese", "solver=chambolle_dual", "solver.scheme=as_published"]
    assert main(["plan", *PLAIN, *published, "operator=vertex_averaged"]) == 0
    assert main(["plan", *PLAIN, "model=convex_chan_vese", "solver=threshold", "operator=fem"]) == 0


def test_figures_of_regions_are_left_out_where_the_model_has_none(
    working_folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["columns=[]", "surface=icosphere", "image=two_phase", "operator=fem", "solver=primal_dual"]
    assert main(["plan", *words, "figures=[parcellation, denoising]", "model=rof"]) == 0
    shown = capsys.readouterr()
    assert shown.err.splitlines() == ["surfexp: figure/parcellation is left out: rof has no regions to draw"]
    assert shown.out.splitlines()[-1] == "5 to compute, 0 done"
    assert main(["plan", *words, "figures=[denoising]", "model=rof"]) == 0
    again = capsys.readouterr()
    assert again.out.splitlines()[-1] == "5 to compute, 0 done" and not again.err
    assert main(["plan", *words, "figures=[parcellation]", "model=convex_chan_vese"]) == 0
    kept = capsys.readouterr()
    assert kept.out.splitlines()[-1] == "5 to compute, 0 done" and not kept.err
