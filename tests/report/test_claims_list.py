"""The list of the dissertation's statements against the claims of the experiments, both ways."""

from __future__ import annotations

import re
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

import pytest
import yaml

from surfexp.lab.experiment.claim import NOT_COMPARABLE, PLACES, claims_of

ROOT = Path(__file__).resolve().parents[2]
STATEMENTS: list[dict[str, Any]] = yaml.safe_load(
    files("surfexp.reproduction").joinpath("statements.yaml").read_text()
)["statements"]
FAULTS: list[dict[str, str]] = yaml.safe_load(
    (ROOT / "audits" / "mutation" / "claims.yaml").read_text(encoding="utf-8")
)["faults"]
KINDS = ("table", "figure", "section", "equation", "theorem", "lemma", "remark", "definition")
FIGURES = {"1": 3, "2": 8, "3": 1, "4": 8, "5": 10, "6": 8}
NUMBERED = (
    [f"figure {chapter}.{k}" for chapter, count in FIGURES.items() for k in range(1, count + 1)]
    + ["table 2.1", "table 2.2", "table 6.1", "remark 1.2.1", "remark 1.3.1", "remark 2.3.1", "remark 2.3.2"]
    + [f"theorem {n}" for n in ("2.2.1", "2.2.2", "2.2.3", "3.1.1", "3.1.2", "3.1.3", "3.2.1", "4.3.1", "4.3.2")]
    + ["theorem 6.2.1", "theorem 6.2.2", "lemma 6.2.1", "lemma 6.2.2"]
    + ["definition 4.3.1", "definition 5.2.1", "definition 6.2.1"]
)


@cache
def claims() -> list[tuple[str, dict[str, Any]]]:
    files = sorted((ROOT / "conf" / "experiment").glob("*.yaml"))
    return [(file.stem, claim) for file in files for claim in claims_of(file)]


def citation(claim: dict[str, Any]) -> str:
    (source,) = claim["published"]
    return str(source)


CITED = [(name, claim) for name, claim in claims() if "published" in claim and citation(claim).split()[0] in PLACES]
BY_ID = {statement["id"]: statement for statement in STATEMENTS}


def test_every_numbered_statement_is_listed_once() -> None:
    names = [statement["id"] for statement in STATEMENTS]
    assert len(names) == len(set(names))
    assert not set(NUMBERED) - set(names)


@pytest.mark.parametrize("statement", STATEMENTS, ids=lambda statement: statement["id"])
def test_a_statement_has_verdicts_or_the_reason_why_none_is_possible(statement: dict[str, Any]) -> None:
    assert set(statement) <= {"id", "section", "states", "values", "verdicts", "none", "ours"}
    assert re.fullmatch(rf"({'|'.join(KINDS)}) \d(\.\d+)*( [a-z, ]+)?", statement["id"])
    assert statement["section"] and statement["states"]
    assert ("verdicts" in statement) != ("none" in statement)
    citing = {name for name, claim in CITED if citation(claim) == statement["id"]}
    assert citing == set(statement.get("verdicts", []))
    assert set(statement.get("ours", [])) <= {name for name, claim in claims() if "published" not in claim}


@pytest.mark.parametrize(("experiment", "claim"), CITED, ids=lambda item: item if isinstance(item, str) else "")
def test_a_citation_is_listed_with_its_value(experiment: str, claim: dict[str, Any]) -> None:
    statement = BY_ID.get(citation(claim))
    assert statement is not None, f"{experiment}: {citation(claim)} is not in surfexp/reproduction/statements.yaml"
    assert claim["published"][citation(claim)] in statement.get("values", []), f"{experiment}: {claim['claim']}"


def test_places_stand_in_keys_and_not_in_prose() -> None:
    place = re.compile(r"\((figure|section|theorem|lemma|table) ")
    assert not [claim["claim"] for _, claim in claims() if place.search(claim["claim"])]


def test_every_interval_has_a_reason_and_no_ours_has_a_verdict_of_others() -> None:
    for name, claim in claims():
        assert claim.get("because") != "not stated yet", f"{name}: {claim['claim']}"
        assert "otherwise" not in claim or ("published" in claim and claim["between"] != NOT_COMPARABLE)


def test_a_planted_fault_stands_in_one_place_and_may_name_a_claim() -> None:
    stated = [(name, claim["claim"]) for name, claim in claims()]
    for fault in FAULTS:
        begins = fault.get("claim", "")
        named = [text for name, text in stated if name == fault["experiment"] and text.startswith(begins)]
        assert named, f"{fault['experiment']}: no claim begins with {begins!r}"
        count = (ROOT / fault["path"]).read_text(encoding="utf-8").count(fault["old"])
        assert count == 1 and fault["new"] != fault["old"], f"{fault['path']}: {fault['old']!r} occurs {count} times"
