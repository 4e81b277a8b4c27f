"""Every public function with every odd input: the right answer, or one line with a way out that exists."""

from __future__ import annotations

import pickle
import re
import warnings
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from face_calls import BODY, CALLS, MAP, OTHER, Answer, Call, F, Given, V
from odd_inputs import ODD, Odd

import surfexp as sx
from surfexp.face import FACE

WAYS_OUT = re.compile(
    r"(is|are|must be).* (needed|positive)|need |choose|give |take |repair|change the unit|narrow|widen|set them to NaN"
    r"|write NaN|mark what|the vertices are 0|(surface|mesh) has \d+ vertices|expected \(count, 3\)|at most|it has "
)
JUDGED: Counter[str] = Counter()
ANSWERS: dict[bytes, Answer | ValueError] = {}


@pytest.fixture(scope="module", autouse=True)
def _summary() -> Iterator[None]:
    yield
    print(f"\n{len(CALLS)} functions, {len(ODD)} odd inputs: {dict(JUDGED)}")


def compared(answer: Answer, reference: Answer, call: Call, odd: Odd) -> str:
    """Say where an answer differs from the reference; nothing where it does not."""
    if odd.name in call.apart or (call.mixes_maps and (odd.map_unit != 1.0 or odd.map_offset != 0.0)):
        return ""
    for name in answer.keys() & reference.keys():
        expected = reference[name]
        found, expected = np.atleast_1d(answer[name]), np.atleast_1d(expected)
        if name == "pixels":
            # beside another unit a map has other words at its colour bar, and beside an offset other colours
            same = found.shape != expected.shape or (found != expected).any(axis=-1).mean() < 0.03
            if not same and not odd.map_offset:
                return "pixels differ"
            continue
        if found.dtype.kind not in "fc":
            rows = np.sort(found, axis=0), np.sort(expected, axis=0)
            if not np.array_equal(*rows if name == "faces" else (found[: len(expected)], expected)):
                return f"{name} differ"
            continue
        scale = odd.unit ** call.units.get(name, 0) * odd.map_unit ** call.map_units.get(name, 0)
        follows = name in call.map_units and name not in call.spreads
        shift = odd.offset * (name in ("vertices", "positions")) + odd.map_offset * follows
        found = (found[: len(expected)].reshape(expected.shape) - shift) / scale
        size = np.nanmax(np.abs(expected), initial=0.0)
        near = np.abs(found - expected) <= 1e-6 * size
        if found.shape != expected.shape or not (near | (np.isnan(found) & np.isnan(expected))).all():
            return f"{name} differ by {np.nanmax(np.abs(found - expected)) / size:.1e}"
    return ""


def plain_answer(name: str, reference: Given, folder: Path) -> Answer:
    key = pickle.dumps((name, [getattr(reference, part) for part in CALLS[name].parts.split()]))
    if key not in ANSWERS:
        try:
            ANSWERS[key] = CALLS[name].run(reference, folder)
        except ValueError as error:
            ANSWERS[key] = error
    if isinstance(ANSWERS[key], ValueError):
        raise ANSWERS[key]
    return ANSWERS[key]


def judged(name: str, number: int, folder: Path) -> tuple[str, str]:
    """Return "right", "told" or "wrong" for a cell, and what happened."""
    call, odd = CALLS[name], ODD[number]
    try:
        answer = call.run(odd.given, folder)
    except ValueError as error:
        line = str(error)
        if odd.reference is not None and not odd.also_refused and name != "check":
            return "wrong", f"refused: {line}"
        if "\n" in line or len(line) > 400 or not re.search(odd.says, line) or not WAYS_OUT.search(line):
            return "wrong", f"words: {line}"
        ways = [*re.findall(r"sx\.(\w+)", line)]
        if not all(hasattr(sx, way) for way in ways):
            return "wrong", f"no such way out: {line}"
        return "told", line
    except Exception as error:
        return "wrong", f"{type(error).__name__}: {error}"
    if odd.reference is None:
        mended = name == "repair" and "repair" in odd.says
        return ("right", "") if odd.also_refused or mended else ("wrong", f"taken: {str(answer)[:100]}")
    difference = compared(answer, plain_answer(name, odd.reference, folder), call, odd)
    return ("wrong", difference) if difference else ("right", "")


@pytest.mark.parametrize("name", CALLS)
def test_an_odd_input_is_answered_right_or_refused_with_a_way_out(name: str, tmp_path: Path) -> None:
    wrong = []
    for number, odd in enumerate(ODD):
        if CALLS[name].takes(odd.part):
            with warnings.catch_warnings():
                warnings.simplefilter("error", RuntimeWarning)
                verdict, said = judged(name, number, tmp_path)
            JUDGED[verdict] += 1
            wrong += [f"{odd.name}: {said}"] if verdict == "wrong" else []
    assert not wrong, "\n".join(wrong)


def test_every_public_function_is_among_them() -> None:
    """Tetrahedra, matrices, proofs of results and experiments have inputs and tests of their own."""
    others = {"Solid", "ldlt", "proof_page", "load", "run", "check_reeb_distance"}
    assert set(FACE) - {name.split()[0] for name in CALLS} == others


WORDS: dict[str, Callable[[Any], Any]] = {
    "denoise method": lambda word: sx.denoise((V, F), MAP, method=word),
    "smooth method": lambda word: sx.smooth((V, F), MAP, 0.4, method=word),
    "null_maps method": lambda word: sx.null_maps((V, F), MAP, 3, method=word),
    "eigenpairs mass": lambda word: sx.eigenpairs((V, F), 3, mass=word),
    "eigenpairs boundary": lambda word: sx.eigenpairs((V, F), 3, boundary=word),
    "Spectrum mass": lambda word: sx.Spectrum((V, F), mass=word),
    "Spectrum boundary": lambda word: sx.Spectrum((V, F), boundary=word),
    "distance weighting": lambda word: sx.distance((V, F), OTHER, 3, weighting=word),
    "align weighting": lambda word: sx.align((V, F), OTHER, 3, weighting=word),
    "SpectralDistance weighting": lambda word: sx.SpectralDistance(3, weighting=word).fit([OTHER]),
    "ShapeDNA normalisation": lambda word: sx.ShapeDNA(3, normalisation=word).fit([OTHER]),
    "NodalCounts counting": lambda word: sx.NodalCounts(3, counting=word).fit([OTHER]),
    "reeb_graph levels": lambda word: sx.reeb_graph((V, F), MAP, levels=word),
    "shape shape": lambda word: sx.shape(word),
    "shape form": lambda word: sx.shape("cortex", form=word),
    "read hemisphere": lambda word: sx.read("body.ply", hemisphere=word),
    "Surface hemisphere": lambda word: sx.Surface(BODY, hemisphere=word),
    "plot views": lambda word: sx.plot((V, F), MAP, views=[word], width=200),
    "plot colormap": lambda word: sx.plot((V, F), MAP, colormap=word, width=200),
}


@pytest.mark.parametrize("word", ["rofl", 3, ("a", "b"), "x" * 10_000], ids=["unknown", "number", "tuple", "long"])
@pytest.mark.parametrize("place", WORDS)
def test_a_word_that_is_none_is_told_from_those_that_are(place: str, word: object, working_folder: Path) -> None:
    sx.write("body.ply", OTHER)
    with pytest.raises(ValueError, match=rf"^{place.split()[1].rstrip('s')}\w* = .*, (choose|.* needed)") as caught:
        WORDS[place](word)
    assert len(str(caught.value)) < 400 and "\n" not in str(caught.value)
