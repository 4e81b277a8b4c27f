"""Odd things that people hand in, each with what the answer has to equal, or the word for what is refused."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from face_calls import MAP, F, Given, V

COUNT = len(V)


@dataclass(frozen=True)
class Odd:
    """An odd input.

    Parameters
    ----------
    name : str
    part : str
        Which part of the bundle is odd.
    given : Given
    reference : Given, optional
        The plain bundle of the same answer; without one the input is refused.
    says : str
        What a refusal has to name.
    also_refused : bool
        Whether functions may refuse it in place of the answer.
    unit, map_unit : float
        By which the answers differ from the reference's.
    offset, map_offset : float
        The same, as sums.
    """

    name: str
    part: str
    given: Given
    reference: Given | None = None
    says: str = ""
    also_refused: bool = False
    unit: float = 1.0
    map_unit: float = 1.0
    offset: float = 0.0
    map_offset: float = 0.0


def of(part: str, name: str, value: Any, plain: Any = None, **rest: Any) -> Odd:
    """An odd value of one part; `plain` is the plain one of the same meaning."""
    reference = None if plain is None else Given(**{part: plain})
    return Odd(f"{part}: {name}", part, Given(**{part: value}), reference, **rest)


def backwards(array: Any) -> Any:
    return array[::-1].copy()[::-1]


def read_only(array: Any) -> Any:
    frozen = array.copy()
    frozen.flags.writeable = False
    return frozen


def boxed(array: Any) -> Any:
    return array.astype(object)


def changed(array: Any, where: Any, value: Any) -> Any:
    copy = array.copy()
    copy[where] = value
    return copy


def same_numbers(part: str, plain: Any, kinds: dict[str, Callable[[Any], Any]]) -> list[Odd]:
    return [of(part, name, make(plain), plain) for name, make in kinds.items()]


LAYOUTS: dict[str, Callable[[Any], Any]] = {
    "big-endian": lambda it: it.astype(it.dtype.newbyteorder(">")),
    "Fortran order": np.asfortranarray,
    "negative strides": backwards,
    "read-only": read_only,
    "masked without a mask": np.ma.masked_array,
    "lists": lambda it: it.tolist(),
    "objects": boxed,
}
ROUNDED = np.round(100 * V).astype(np.int64)
WHOLE_MAP = np.round(100 * MAP).astype(np.int64)
HIDDEN = np.zeros(COUNT, dtype=bool)
HIDDEN[[7, 30]] = True
UPPER = V[:, 2] > -0.5
ISLAND = (V[:, 2] > 0.3) | np.isin(np.arange(COUNT), F[np.argmin(V[F][:, :, 2].max(axis=1))])
TWO = np.r_[V, V + 9.0], np.r_[F, F + COUNT]
LOOSE = np.r_[V, [[9.0, 9.0, 9.0]]]
REPAIR = r"(sx\.|surfexp )repair"

VERTICES = [
    *same_numbers("vertices", V, LAYOUTS | {"a table of pandas": pd.DataFrame}),
    *(of("vertices", t, V.astype(t), V.astype(t).astype(float)) for t in ("float16", "float32", "longdouble")),
    *(of("vertices", t, ROUNDED.astype(t), ROUNDED.astype(float)) for t in ("int16", "int64")),
    of("vertices", "complex", V + 1j, says="vertices.*complex"),
    of("vertices", "text", V.astype(str), says="vertices"),
    of("vertices", "dates", V.astype("datetime64[s]"), says="vertices"),
    of("vertices", "None", None, says="vertices"),
    of("vertices", "dictionaries", np.full((COUNT, 3), {}), says="vertices"),
    of("vertices", "ragged", [[0.0, 0.0, 0.0], [1.0]], says="vertices"),
    of("vertices", "two columns", V[:, :2], says=r"vertices.*\(162, 2\)"),
    of("vertices", "one number", 3.0, says="vertices"),
    of("vertices", "too few", V[:100], says="vertex 161|out of range"),
    of("vertices", "times 1e110", V * 1e110, says="change the unit"),
    of("vertices", "times 1e-110", V * 1e-110, says="change the unit"),
    of("vertices", "all equal", np.ones_like(V), says="."),
    *(
        Odd(f"vertices: times {unit:g}", "vertices", Given(vertices=V * unit, unit=unit), Given(), unit=unit)
        for unit in (1e-100, 1e-74, 1e-40, 1e40, 1e74, 1e100)
    ),
    Odd("vertices: plus 1e6", "vertices", Given(vertices=V + 1e6), Given(), offset=1e6),
    of("vertices", "one NaN", changed(V, 5, np.nan), says="finite", also_refused=True),
    of("vertices", "one infinite", changed(V, (5, 0), np.inf), says="finite|infinite", also_refused=True),
    of("vertices", "all NaN", np.full_like(V, np.nan), says="finite|no whole face"),
    Odd(
        "vertices: none", "vertices", Given(vertices=np.zeros((0, 3)), faces=np.zeros((0, 3))), says="faces|0 vertices"
    ),
]
FACES = [
    *same_numbers("faces", F, LAYOUTS | {"whole floats": lambda it: it.astype(float)}),
    *(of("faces", t, F.astype(t), F) for t in ("int32", "uint8", "uint64", "float16")),
    of("faces", "fractions", F + 0.5, says="faces has the value"),
    of("faces", "booleans", F > 3, says="faces.*booleans"),
    of("faces", "NaN", changed(F.astype(float), (3, 0), np.nan), says="faces has the value nan"),
    of("faces", "masked", np.ma.masked_less(F, 2), says="faces"),
    of("faces", "complex", F + 0j, says="faces"),
    of("faces", "text", F.astype(str), says="faces"),
    of("faces", "quadrangles", np.column_stack([F, F[:, 0]]), says=r"faces.*\(320, 4\)"),
    of("faces", "from 1", F + 1, says="vertex 162|out of range"),
    of("faces", "negative", changed(F, (0, 0), -1), says="vertex -1|out of range"),
    of("faces", "beyond 64 bits", changed(F.astype(float), (0, 0), 1e30), says="faces has the value 1e\\+30"),
    of("faces", "none", np.zeros((0, 3), dtype=int), says="faces"),
    of("faces", "some flipped", np.r_[F[:9, ::-1], F[9:]], says=REPAIR),
    of("faces", "inside out", F[:, ::-1], says=REPAIR),
    of("faces", "twice", np.r_[F, F[:5]], says=REPAIR),
    of("faces", "of one vertex twice", np.r_[F, [[0, 0, 1]]], says=REPAIR),
    of("faces", "three at an edge", np.r_[F, [[F[0, 0], F[0, 1], int(F[-1, 2])]]], says=REPAIR),
]
SURFACES = [
    Odd(
        "surface: one triangle", "vertices", Given(V[:3], [[0, 1, 2]], MAP[:3], sources=0), says=".", also_refused=True
    ),
    Odd(
        "surface: two components",
        "vertices",
        Given(*TWO, np.r_[MAP, MAP]),
        says="connected|component|piece",
        also_refused=True,
    ),
    Odd("surface: a vertex without faces", "vertices", Given(LOOSE, F, np.r_[MAP, 0.0]), Given(), says="unreferenced"),
    Odd("surface: numbered at random", "vertices", Given(V, F[::-1]), Given()),
    *(Odd(f"surface: {name}", "vertices", Given(given, None), says="surface") for name, given in ()),
]
MAPS = [
    *same_numbers(
        "values",
        MAP,
        LAYOUTS
        | {"a series of pandas": lambda it: pd.Series(it, np.arange(COUNT)[::-1]), "a column": lambda it: it[:, None]},
    ),
    *(of("values", t, MAP.astype(t), MAP.astype(t).astype(float)) for t in ("float16", "float32", "longdouble")),
    *(of("values", t, WHOLE_MAP.astype(t), WHOLE_MAP.astype(float)) for t in ("int16", "int64")),
    of(
        "values",
        "unsigned",
        (WHOLE_MAP - WHOLE_MAP.min()).astype(np.uint16),
        (WHOLE_MAP - WHOLE_MAP.min()).astype(float),
    ),
    of("values", "booleans", MAP > 0, (MAP > 0).astype(float)),
    of("values", "masked", np.ma.masked_array(MAP, HIDDEN), np.where(HIDDEN, np.nan, MAP)),
    of(
        "values",
        "masked over a code",
        np.ma.masked_array(np.where(HIDDEN, -9999.0, MAP), HIDDEN),
        np.where(HIDDEN, np.nan, MAP),
    ),
    of(
        "values",
        "NA of pandas",
        pd.array(np.where(HIDDEN, np.nan, MAP), dtype="Float64"),
        np.where(HIDDEN, np.nan, MAP),
    ),
    Odd(
        "values: NaN",
        "values",
        Given(values=np.where(HIDDEN, np.nan, MAP)),
        Given(values=np.where(HIDDEN, np.nan, MAP), mask=~HIDDEN),
    ),
    of("values", "complex", MAP + 1j, says="map.*complex"),
    of("values", "text", MAP.astype(str), says="map"),
    of("values", "objects", np.full(COUNT, {}), says="map"),
    of("values", "ragged", [[1.0], [1.0, 2.0]], says="map"),
    of("values", "too short", MAP[:-1], says=r"map.*161"),
    of("values", "empty", [], says="map"),
    of("values", "one number", 1.0, says="map"),
    of("values", "a cube", np.ones((COUNT, 2, 2)), says="map"),
    of("values", "no such name", "sulc", says="no map 'sulc'|map 'map' is"),
    of("values", "infinite", changed(MAP, 3, np.inf), says="infinite"),
    of("values", "all NaN", np.full(COUNT, np.nan), says="NaN at all", also_refused=True),
    of("values", "one code for no data", changed(MAP, 3, -9999.0), says="far from all others", also_refused=True),
    of("values", "constant", np.ones(COUNT), np.ones(COUNT), says="constant|is 1 at every vertex", also_refused=True),
    of("values", "of two values", np.sign(V[:, 2] + 1e-9), np.sign(V[:, 2] + 1e-9)),
    of(
        "values",
        "0 but at 7 vertices",
        changed(np.zeros(COUNT), np.arange(7), 1.0),
        changed(np.zeros(COUNT), np.arange(7), 1.0),
    ),
    Odd("values: times 1e100", "values", Given(values=MAP * 1e100), Given(), map_unit=1e100),
    Odd("values: times 1e-100", "values", Given(values=MAP * 1e-100), Given(), map_unit=1e-100),
    Odd("values: times 1e300", "values", Given(values=MAP * 1e300), Given(), map_unit=1e300),
    Odd("values: plus 1e6", "values", Given(values=MAP + 1e6), Given(), map_offset=1e6),
]
MASKS = [
    of("mask", "0 and 1", UPPER.astype(int), UPPER),
    of("mask", "0.0 and 1.0", UPPER.astype(float), UPPER),
    of("mask", "lists", UPPER.tolist(), UPPER),
    of("mask", "a column", UPPER[:, None], UPPER),
    of("mask", "NaN and 1", np.where(UPPER, 1.0, np.nan), UPPER),
    of("mask", "masked", np.ma.masked_array(np.ones(COUNT), ~UPPER), UPPER),
    of("mask", "a series of pandas", pd.Series(UPPER, np.arange(COUNT)[::-1]), UPPER),
    of("mask", "text", UPPER.astype(int).astype(str), says="mask"),
    of("mask", "complex", UPPER + 1j, says="mask"),
    of("mask", "too short", UPPER[:-1], says=r"mask.*161"),
    of("mask", "none inside", np.zeros(COUNT, dtype=bool), says="mask", also_refused=True),
    of("mask", "an island of a face", ISLAND, says="3 vertices|outside the mask", also_refused=True),
]
SOURCES = [
    of("sources", "whole floats", [3.0, 40.0], (3, 40)),
    of("sources", "a mask", np.isin(np.arange(COUNT), (3, 40)), (3, 40)),
    of("sources", "one number of numpy", np.uint8(3), 3),
    of("sources", "an array of no dimension", np.array(3), 3),
    of("sources", "twice the same", (3, 40, 3), (3, 40)),
    of("sources", "a series of pandas", pd.Series([3, 40], [9, 1]), (3, 40)),
    of("sources", "a fraction", 2.5, says="sources has the value 2.5"),
    of("sources", "negative", -1, says="vertex -1"),
    of("sources", "too large", COUNT, says="vertex 162"),
    of("sources", "huge", 10**30, says="sources"),
    of("sources", "text", "3", says="sources"),
    of("sources", "none", [], says="sources"),
    of("sources", "NaN", np.nan, says="sources"),
    of("sources", "short mask", [True, False], says="sources"),
    of("sources", "hidden", np.ma.masked_array([3, 40], [True, False]), says="sources"),
    of("sources", "None", None, says="sources"),
]
NAMED = r"(count|n|k|levels|seed|width|weights?|smoothness|radius|tolerance) (=|is) "
COUNTS = [
    *(of("count", f"{type(value).__name__} 4", value, 4) for value in (4.0, np.int8(4), np.float32(4), np.array(4))),
    *(
        of("count", repr(value)[:20], value, says=NAMED)
        for value in (2.5, "4", True, np.nan, np.inf, -1, 4j, [4], 1e300)
    ),
    of("count", "None", None, says=NAMED),
    of("count", "too large", 10**9, says="= 1000000000|k = 1000000001"),
    of("count", "of 5000 digits", 10**5000, says=NAMED),
]
SEEDS = [
    of("seed", "5.0", 5.0, 5),
    of("seed", "beyond 64 bits", 2**70, 2**70),
    *(of("seed", repr(value), value, says=NAMED) for value in (-1, 2.5, "5", np.nan, [1])),
    of("seed", "None", None, says=NAMED),
]
WIDTHS = [
    of("width", "a number of numpy", np.float64(0.4), 0.4),
    of("width", "an array of no dimension", np.array(0.4), 0.4),
    of("width", "float32", np.float32(0.5), 0.5),
    of("width", "whole", 1, 1.0),
    *(of("width", repr(value), value, says=NAMED) for value in (np.nan, np.inf, -1.0, 0.0, "3mm", 4j, True, [0.4])),
    # of weights it means that none is given
    of("width", "None", None, says=NAMED, also_refused=True),
    of("width", "1e300", 1e300, says=".", also_refused=True),
    of("width", "1e-300", 1e-300, says=".", also_refused=True),
]
TOLERANCES = [
    *(of("tolerance", repr(value), value, says="tolerance = ") for value in (np.nan, -1.0, 0.0, 2.0, "1e-3", 1j)),
]
MATRICES = [
    *(
        of(part, name, make(getattr(Given(), part)), getattr(Given(), part))
        for part in ("stiffness", "mass")
        for name, make in {
            "csc": lambda it: it.tocsc(),
            "coo": lambda it: it.tocoo(),
            "complex without an imaginary part": lambda it: it.astype(complex),
            "longdouble": lambda it: it.astype(np.longdouble),
        }.items()
    ),
    *(
        of(part, name, make(getattr(Given(), part)), says=word)
        for part, word in (("stiffness", "A |stiffness"), ("mass", "M |mass"))
        for name, make in {
            "NaN": lambda it: it * np.nan,
            "infinite": lambda it: it * np.inf,
            "dense": lambda it: it.toarray(),
            "not square": lambda it: it[:, :-1],
            "of another size": lambda it: it[:-1, :-1],
            "not symmetric": lambda it: it + 9 * it.tocsr()[:, [1, 0, *range(2, COUNT)]],
            "text": lambda it: "matrix",
        }.items()
    ),
]
ODD = [
    *VERTICES,
    *FACES,
    *SURFACES,
    *MAPS,
    *MASKS,
    *SOURCES,
    *COUNTS,
    *SEEDS,
    *WIDTHS,
    *TOLERANCES,
    *MATRICES,
]
