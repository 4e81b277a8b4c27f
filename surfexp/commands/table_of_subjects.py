"""What a table of subjects says of each map of a test."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from surfexp.commands.certificate import Inputs

if TYPE_CHECKING:
    from surfexp.contract.arrays import Floats


def names_of_maps(read: Mapping[str, Mapping[str, Floats]]) -> list[str]:
    """What a row of the table can be told by: the file of each map, with the map's name where a file has several."""
    names: list[str] = []
    for file, maps in read.items():
        for name, values in maps.items():
            count = 1 if values.ndim == 1 else values.shape[1]
            names += [file if len(maps) == 1 else f"{file} {name}"] * count
    return names


def of_subjects(
    subjects: str | None,
    files: Inputs,
    columns: Mapping[str, str | None],
    maps: list[str],
    in_order: bool,
    one_file: bool,
) -> tuple[dict[str, Any], tuple[str, ...]]:
    """Return what the columns of a table say of each map, and how its rows were found.

    Parameters
    ----------
    subjects : str, optional
        File of the table, which joins the inputs.
    files : Inputs
    columns : dict of str to str, optional
        Name of the column of each option; covariates are several with commas between.
    maps : list of str
        As `names_of_maps` returns them.
    in_order : bool
        Whether the user says that rows are in the order of the maps.
    one_file : bool
        Whether one file holds all maps: it has an order of its own, that of several files is their names'.

    Raises
    ------
    ValueError
        If a column or the table is missing, or it cannot be told which row a map has.
    """
    asked = {
        option: [part.strip() for part in (given.split(",") if option == "covariates" else [given])]
        for option, given in columns.items()
        if given
    }
    if subjects is None:
        if asked:
            raise ValueError(f"--{next(iter(asked))} names a column: give --subjects FILE")
        if in_order:
            raise ValueError("--in-order is of the rows of a table: give --subjects FILE")
        return {}, ()
    if not asked:
        raise ValueError(
            f"--subjects {subjects} says nothing of the test: name a column (--groups, --covariates, --blocks)"
        )
    from surfexp.io.subject_table import read_subjects
    from surfexp.mesh.given_numbers import one_of

    files.add(subjects)
    table = read_subjects(subjects)
    for option, names in asked.items():
        for name in names:
            one_of(name, f"--{option}", table)
    rows, how = _rows(subjects, table, maps, in_order, one_file)
    answer: dict[str, Any] = {option: [table[names[0]][row] for row in rows] for option, names in asked.items()}
    if "covariates" in asked:
        answer["covariates"] = [[number(table[name][row], name) for name in asked["covariates"]] for row in rows]
    return answer, (f"The rows of {Path(subjects).name} are taken {how}",)


def _rows(
    subjects: str, table: Mapping[str, list[str]], maps: list[str], in_order: bool, one_file: bool
) -> tuple[list[int], str]:
    """The row of each map, and how it was found."""
    from surfexp.io.subject_table import rows_of_maps

    count = len(next(iter(table.values())))
    try:
        found = None if in_order else rows_of_maps(table, maps)
    except ValueError as error:
        raise ValueError(f"{subjects}: {error}") from None
    if found is not None:
        left = count - len(maps)
        return found[1], f"by column {found[0]!r}" + (f" ({left} without a map)." if left else ".")
    if not (in_order or one_file):
        raise ValueError(
            f"{subjects}: no column names the {len(maps)} maps: add one of their files, or say --in-order if the rows are "
            "in their order"
        )
    if count != len(maps):
        raise ValueError(
            f"{subjects} has {count} rows for {len(maps)} maps: give a row for each map in their order, or a column of their "
            "files"
        )
    return list(range(count)), "in the order of the maps" + ("." if in_order else ": no column names their subjects.")


def number(word: str, where: str) -> float:
    """Return a number that is given as text.

    Raises
    ------
    ValueError
        If it is none, naming where it stands.
    """
    try:
        return float(word)
    except ValueError:
        raise ValueError(f"{where} has {word!r}, a number is needed") from None
