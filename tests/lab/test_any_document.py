"""Whatever a file holds, writing it out ends in a configuration or in one line; and it is the same when done twice."""

from __future__ import annotations

import copy
from typing import Any

import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from surfexp.lab.errors import UserError
from surfexp.lab.experiment.written_out import named, written_out

WORDS = [
    *("surface", "image", "operator", "solver", "distance", "statistic", "figure", "target", "grid", "repeat", "parts"),
    *(
        "axes",
        "datasets",
        "label",
        "variants",
        "figures",
        "claims",
        "columns",
        "product",
        "class",
        "group",
        "level",
        "inputs",
        "name",
    ),
    *(
        "sweep",
        "against",
        "all",
        "ratio",
        "between",
        "metric",
        "of",
        "to",
        "because",
        "over",
        "dataset",
        "quantity",
        "rows",
        "image.seed",
        "image.noise",
    ),
    *("icosphere", "levels", "left", "A statement", "experiment", "results", "hydra", "title", "grid.x", "."),
]
ATOMS = st.none() | st.booleans() | st.integers(-3, 3) | st.floats(-2, 2) | st.sampled_from(WORDS) | st.dates()
KEYS = st.sampled_from(WORDS) | st.integers(0, 2) | st.none() | st.booleans()
VALUES = st.recursive(
    ATOMS, lambda inner: st.lists(inner, max_size=3) | st.dictionaries(KEYS, inner, max_size=3), max_leaves=12
)
DOCUMENTS = st.dictionaries(st.sampled_from(WORDS), VALUES, max_size=6)


@settings(max_examples=250)
@given(DOCUMENTS)
def test_a_document_is_written_out_or_refused_in_a_line(document: dict[str, Any]) -> None:
    before = copy.deepcopy(document)
    try:
        found = written_out(named(document, "mine"))
        assert written_out(copy.deepcopy(found)) == found
        yaml.safe_dump(found)
    except UserError as error:
        assert "\n" not in str(error) and str(error)
    assert document == before
