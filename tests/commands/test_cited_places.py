"""From a number of the dissertation to the experiments about it."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from surfexp.commands.cited_places import asked_place, experiments_at, places_of
from surfexp.commands.command_line import main
from surfexp.lab.errors import UserError
from surfexp.lab.registry.folders import experiments

DOCUMENTS = {
    "one": {"chapter": [2, 4], "figures": [{"name": "segmentation", "reference": "figure 2.3"}]},
    "other": {"variants": [{"claims": [{"claim": "A", "published": {"table 2.3": "2.4"}}]}]},
    "third": {"claims": [{"published": {"figure 2.30 left": "7"}}], "image": {"reference": "2.3"}},
    "fourth": {"figures": [{"name": "restoration", "reference": "equation (2.7)"}]},
}


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("2.3", ("", "2.3")),
        ("figure 2.3", ("figure", "2.3")),
        ("Table  3.1", ("table", "3.1")),
        ("equation (2.7)", ("equation", "2.7")),
        ("2", ("", "2")),
        ("quickstart", None),
        ("solver/primal_dual", None),
        ("figure", None),
    ],
)
def test_what_is_a_place(text: str, place: tuple[str, str] | None) -> None:
    assert asked_place(text) == place


@pytest.mark.parametrize(
    ("place", "found"),
    [
        (("", "2.3"), {"one": ["figure 2.3"], "other": ["table 2.3"]}),
        (("figure", "2.3"), {"one": ["figure 2.3"]}),
        (("figure", "2.30"), {"third": ["figure 2.30"]}),
        (("", "2.7"), {"fourth": ["equation 2.7"]}),
        (("", "2"), {"one": ["chapter 2"]}),
    ],
)
def test_experiments_are_found_by_number(place: tuple[str, str], found: dict[str, list[str]]) -> None:
    assert experiments_at(place, DOCUMENTS) == found


def test_a_number_that_nothing_is_about_is_answered_with_those_of_its_chapter() -> None:
    with pytest.raises(UserError, match=r"about figure 2\.9; .* figure 2\.3, table 2\.3, equation 2\.7, figure 2\.30$"):
        experiments_at(("figure", "2.9"), DOCUMENTS)
    with pytest.raises(UserError, match="chapter 9 they are about: nothing"):
        experiments_at(("", "9.1"), DOCUMENTS)


def test_every_figure_that_a_file_refers_to_leads_back_to_it(
    working_folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    import yaml

    documents = {name: yaml.safe_load(file.read_text()) for name, file in experiments().items()}
    seen = 0
    for name, file in experiments().items():
        for kind, number in re.findall(r"reference: (figure|table) (\d+\.\d+)", file.read_text()):
            assert name in experiments_at((kind, number), documents)
            seen += 1
    assert seen > 20 and sum(1 for document in documents.values() for _ in places_of(document)) > 100
    for words in (["figure", "2.3"], ["figure 2.3"], ["2.3"]):
        assert main(["info", *words]) == 0
        assert "ccv_cup" in capsys.readouterr().out
    assert main(["info", "figure", "99.1"]) == 2
    assert capsys.readouterr().err.count("\n") == 1


@pytest.mark.parametrize(
    ("place", "experiment", "said"),
    [
        ("table 2.2", "method_comparison", "Seconds for convex Chan-Vese"),
        ("figure 4.6", "caudate_putamen", "N = 300"),
        ("theorem 2.2.1", "total_variation", "length of the boundary"),
        ("theorem 6.2.1", "distance_convergence", "No verdict: a theorem on infinitely many eigenfunctions"),
        ("section 5.3", "boundary_noise", "No verdict: follows for bends that keep lengths"),
        ("figure 1.1", "", "No verdict: a drawing of a definition"),
    ],
)
def test_a_place_is_answered_with_what_it_says_and_who_measures_it(
    place: str, experiment: str, said: str, working_folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["info", place]) == 0
    out = capsys.readouterr().out
    assert out.startswith(f"{place}: ") and said in out and experiment in out
    assert bool(experiment) == ("surfexp run experiment=NAME" in out)
