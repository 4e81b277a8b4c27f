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


def test_columns_that_contradict_one_another_are_refused_however_long_their_words() -> None:
    """A column of paths won over ids that said other rows."""
    table = {"participant_id": [f"sub-{k}" for k in range(20)], "file": shuffled("maps/lh.sub-{}.thickness.mgh")}
    with pytest.raises(ValueError, match=r"columns 'participant_id' and 'file' both name the maps"):
        rows_of_maps(table, FILES)
    table["file"] = [f"maps/lh.sub-{k}.thickness.mgh" for k in range(20)]
    assert rows_of_maps(table, FILES) == ("participant_id", list(range(20)))


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


def test_two_pairs_of_columns_that_say_different_rows_are_refused() -> None:
    """The visit was tested under the name of the treatment."""
    files = ["a_1.mgh", "a_2.mgh", "b_1.mgh", "b_2.mgh"]
    table = {"id": [*"aabb"], "treatment": [*"2112"], "visit": [*"1212"]}
    wanted = r"columns 'id and treatment' and 'id and visit' both name the maps, in different orders: leave one out"
    with pytest.raises(ValueError, match=wanted):
        rows_of_maps(table, files)
    words = table | {"treatment": ["placebo" if one == "2" else "drug" for one in table["treatment"]]}
    with pytest.raises(ValueError, match=wanted):
        rows_of_maps(words, [f"{file[:3]}_{arm}.mgh" for file, arm in zip(files, ["drug", "placebo"] * 2, strict=True)])
    assert rows_of_maps(words, files) == ("id and visit", [0, 1, 2, 3])


@pytest.mark.parametrize("folder", ["", "maps/", "/data/study/maps/", "other/"])
@pytest.mark.parametrize("form", ["maps/s{}.mgh", "/data/study/maps/s{}.mgh", "maps\\s{}", "s{}.mgh"])
def test_paths_of_a_table_name_files_wherever_they_are_given_from(form: str, folder: str) -> None:
    assert rows_of_maps({"file": shuffled(form)}, [f"{folder}s{k}.mgh" for k in range(20)]) == ("file", ROWS)


def test_paths_whose_files_have_one_name_are_told_apart_by_their_folders() -> None:
    files = [f"subjects/sub-{k}/surf/lh.thickness" for k in range(20)]
    for form in ("sub-{}/surf/lh.thickness", "/data/subjects/sub-{}/surf/lh.thickness"):
        assert rows_of_maps({"map": shuffled(form)}, files) == ("map", ROWS)
    assert rows_of_maps({"known": ["n/a"] * 4}, ["a.mgh", "n.mgh", "b.mgh", "c.mgh"]) is None


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
