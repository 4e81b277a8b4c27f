"""What Hydra's page on its override grammar shows, said of our own options: what it sweeps, and what it refuses."""

from __future__ import annotations

from pathlib import Path

import pytest

from surfexp.commands.request import plan_and_act
from surfexp.lab.errors import UserError
from surfexp.lab.plan.plan import Plan

BASE = ["experiment=rof_cup", "surface=icosphere", "operator=fem", "model=rof", "~variants", "figures=[]", "~claims"]
WALK: list[tuple[list[str], str, list[object]]] = [
    (["surface.levels=3"], "surface.levels", [3]),
    (["++surface.levels=3"], "surface.levels", [3]),
    (["surface.levels=1,2,3"], "surface.levels", [1, 2, 3]),
    (["surface.levels=choice(1,2)"], "surface.levels", [1, 2]),
    (["surface.levels=range(1,4)"], "surface.levels", [1, 2, 3]),
    (["surface.levels=range(1,6,step=2)"], "surface.levels", [1, 3, 5]),
    (["surface.levels=sort(3,1,2,reverse=true)"], "surface.levels", [3, 2, 1]),
    (["surface.levels=tag(fine,choice(1,2))"], "surface.levels", [1, 2]),
    (["surface.levels=int(2.0)"], "surface.levels", [2]),
    (["solver.tolerance=1e-3,1e-5"], "solver.tolerance", [1e-3, 1e-5]),
    (["solver.tolerance=float(choice(1e-3,1e-5))"], "solver.tolerance", [1e-3, 1e-5]),
    (["solver=newton,primal_dual"], "solver.name", ["newton", "primal_dual"]),
    (["solver=glob([new*,fista*])"], "solver.name", ["fista_dual", "newton"]),
    (["image.noise=null"], "", []),
    (["surface.levels=interval(1,2)"], "", []),
    (["surface.levels=[1,2]"], "", []),
    (["surface.levls=1"], "", []),
    (["~surface.levls"], "", []),
]


@pytest.mark.slow
@pytest.mark.parametrize(("words", "option", "values"), WALK, ids=[words[0] for words, _, _ in WALK])
def test_a_word_of_the_grammar_does_what_hydra_says(
    working_folder: Path, words: list[str], option: str, values: list[object]
) -> None:
    solver = [] if any(word.startswith("solver=") for word in words) else ["solver=primal_dual"]
    plans: list[Plan] = []
    if not option:
        with pytest.raises(UserError) as error:
            plan_and_act([*BASE, *solver, *words], plans.append)
        assert "\n" not in str(error.value) and words[0].lstrip("~").partition("=")[0].partition(".")[0] in str(
            error.value
        )
        return
    plan_and_act([*BASE, *solver, *words], plans.append)
    found = [plan.parameters(leaf)[option] for plan in plans for leaf in plan.leaves]
    assert found == values
