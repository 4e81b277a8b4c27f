"""Which row of a table is of which map: never one that another column contradicts, never the order where names say otherwise."""

from __future__ import annotations

import numpy as np
import pytest

from surfexp.io.subject_table import rows_of_maps

ORDER = np.random.default_rng(0).permutation(20)
FILES = [f"lh.sub-{k}.thickness.mgh" for k in range(20)]
ROWS = np.argsort(ORDER).tolist()


def shuffled(form: str) -> list[str]:
    return [form.format(k) for k in ORDER]


def test_an_id_says_more_than_a_number_of_the_row() -> None:
    index = [str(k) for k in range(20)]
    assert rows_of_maps({"": index, "participant_id": shuffled("sub-{}")}, FILES) == ("participant_id", ROWS)
    assert rows_of_maps({"": index, "participant_id": shuffled("SUB-{}")}, FILES) == ("participant_id", ROWS)
    with pytest.raises(
        ValueError, match=r"columns 'row' and 'id' both name the maps, in different orders: leave one out"
    ):
        rows_of_maps({"row": index, "id": shuffled("{}")}, FILES)


def test_two_columns_tell_visits_apart() -> None:
    files = [f"lh.sub-{k:02}_ses-{visit}.mgh" for k in range(10) for visit in (1, 2)]
    table = {
        "participant_id": [f"sub-{k:02}" for visit in (1, 2) for k in range(10)],
        "session": [f"ses-{visit}" for visit in (1, 2) for k in range(10)],
    }
    rows = [k + 10 * visit for k in range(10) for visit in (0, 1)]
    assert rows_of_maps(table, files) == ("participant_id and session", rows)
    with pytest.raises(ValueError, match=r"sub-00_ses-1.mgh has 2 rows by column 'participant_id'"):
        rows_of_maps({"participant_id": table["participant_id"]}, files)


def test_the_name_of_the_file_counts_before_its_folders() -> None:
    files = [f"visit-1/lh.{k}.mgh" for k in range(20)]
    assert rows_of_maps({"id": shuffled("{}")}, files) == ("id", ROWS)
    folders = [f"study-1/sub-{k}/surf/lh.thickness" for k in range(20)]
    assert rows_of_maps({"id": shuffled("{}")}, folders) == ("id", ROWS)
    windows = [f"study-1\\sub-{k}\\surf\\lh.thickness" for k in range(20)]
    assert rows_of_maps({"id": shuffled("{}")}, windows) == ("id", ROWS)


def test_half_of_the_names_are_enough_to_refuse_the_order() -> None:
    with pytest.raises(ValueError, match=r"lh.sub-0.thickness.mgh has 0 rows by column 'participant_id'"):
        rows_of_maps({"participant_id": shuffled("sub-{:02}")}, FILES)


def test_no_name_leaves_the_order() -> None:
    assert rows_of_maps({"age": [str(20 + k) for k in range(20)], "sex": ["f", "m"] * 10}, FILES) is None
    assert rows_of_maps({"age": ["31", "24", "19"]}, ["a.mgh", "b.mgh", "24.mgh"]) is None
