"""Real files that packages bring, read by ours and by theirs, and what came of each."""

from __future__ import annotations

import os
import pickle
import select
import signal
import time
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from audits.reliability.agreement import disagreement
from audits.reliability.fuzzing import LONGEST_LINE
from audits.reliability.packages import SUFFIXES, files
from audits.reliability.readers import import_others, ours, theirs
from audits.reliability.truth import LABELS, LIST, MAPS, SURFACE, Found, Truth

RIGHT, REFUSED, ALONE, WRONG = "right", "refused", "no second reader", "wrong"
SECONDS = 120
# what a file may be refused for: a piece of the line, and the kind of reason
REASONS = {
    "points without faces": "points without faces",
    "it is a volume of shape": "a volume of voxels",
    "cells of VTK's type": "volumes or curved cells",
    "polygons are needed: DATASET": "a grid without polygons",
    "the file is empty": "an empty file",
    "a face names vertex": "a face names a vertex that is not there",
    "it ends after": "cut off",
    "is cut short": "a row that is cut short or no number",
    "where the length of": "a row that is cut short or no number",
    "Cannot locate external file": "a part of it is missing",
    "its format is unknown": "another format",
    "the first word is not OFF": "another format",
    "its homogeneous coordinates": "a surface in four dimensions",
}


@dataclass(frozen=True)
class Outcome:
    """One file: what came of it.

    Parameters
    ----------
    package, name, format : str
    outcome : str
        RIGHT, REFUSED, ALONE or WRONG.
    said : str
        The kind of reason of a refusal, or what is wrong.
    others : dict of str to str
        By reader: nothing where it agrees, else how it differs or why it cannot read the file.
    """

    package: str
    name: str
    format: str
    outcome: str
    said: str = ""
    others: dict[str, str] = field(default_factory=dict)


def read_corpus(store: Path) -> Iterator[Outcome | str]:
    """Yield what came of every file, and a line for every package that cannot be had."""
    import_others()
    for package, path, said in files(store):
        if path is None:
            yield said
        else:
            yield judged(package.name, path)


def judged(package: str, path: Path) -> Outcome:
    """Read a file with ours and with all others, each in a process of its own, and compare."""
    kind = kind_of(path)
    told = Truth(kind)
    found = in_process(ours, path, told)
    others = {name: in_process(read, path) for name, read in theirs(path, kind)}
    name, suffix = path.name, format_of(path)
    if isinstance(found, Exception):
        line = str(found).replace(f"{path.parent}/", "")
        reads = {who: _opinion(opinion) for who, opinion in others.items()}
        reason = next((kind for piece, kind in REASONS.items() if piece in line), "")
        if not isinstance(found, ValueError):
            line = f"{type(found).__name__}: {line}"
        good = isinstance(found, ValueError) and reason and len(line) <= LONGEST_LINE and "\n" not in line
        return Outcome(package, name, suffix, REFUSED if good else WRONG, reason if good else line, reads)
    said = {
        who: f"cannot read it: {str(other)[:80]}" if isinstance(other, Exception) else disagreement(found, other)
        for who, other in others.items()
    }
    readers = {who for who, other in others.items() if not isinstance(other, Exception) and said[who] != "no faces"}
    if not readers:
        return Outcome(package, name, suffix, ALONE, "", said)
    wrong = all(said[who] for who in readers)
    return Outcome(package, name, suffix, WRONG if wrong else RIGHT, "differs from all others" if wrong else "", said)


def _opinion(found: Found | Exception) -> str:
    if isinstance(found, Exception):
        return f"cannot read it: {str(found)[:80]}"
    if found.polygons is not None and found.vertices is not None:
        return f"finds {len(found.vertices)} vertices, {len(found.polygons)} faces"
    return "reads it"


def in_process(read: Callable[..., Found], *given: Any) -> Found | Exception:
    """Return what a reader finds, or the exception that it ends with, crash and time limit included."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(reading)
        try:
            answer: Any = read(*given)
        except ValueError as error:
            answer = ValueError(str(error))
        except BaseException as error:
            answer = RuntimeError(f"{type(error).__name__}: {error}")
        with os.fdopen(writing, "wb") as pipe:
            pickle.dump(answer, pipe)
        os._exit(0)
    os.close(writing)
    data, end = bytearray(), time.monotonic() + SECONDS
    while select.select([reading], [], [], max(end - time.monotonic(), 0.0))[0]:
        piece = os.read(reading, 1 << 20)
        if not piece:
            break
        data += piece
    else:
        os.kill(child, signal.SIGKILL)
        data.clear()
    os.close(reading)
    status = os.waitpid(child, 0)[1]
    if not data:
        return RuntimeError(f"ended by signal {status} or after {SECONDS} s")
    answer = pickle.loads(data)  # noqa: S301 - written by the process above
    assert isinstance(answer, (Found, Exception))
    return answer


def format_of(path: Path) -> str:
    """Return the ending of a file by which its format is known."""
    name = path.name.lower()
    kinds = (".surf.gii", ".label.gii", ".shape.gii", ".func.gii", ".dscalar.nii", ".dlabel.nii", ".csv")
    return max((suffix for suffix in (*kinds, *SUFFIXES) if name.endswith(suffix)), key=len)


def kind_of(path: Path) -> str:
    """Return by which door a file is read: that of surfaces, maps, labels or lists of vertices."""
    name = path.name.lower()
    if name.endswith((".gii", ".gii.gz")):
        import nibabel

        try:
            intents = {array.intent for array in nibabel.load(path).darrays}
        except Exception:
            return SURFACE
        codes = {word: nibabel.nifti1.intent_codes[f"NIFTI_INTENT_{word}"] for word in ("POINTSET", "LABEL")}
        return SURFACE if codes["POINTSET"] in intents else LABELS if codes["LABEL"] in intents else MAPS
    if name.endswith((".annot", ".dlabel.nii")):
        return LABELS
    if name.endswith(".label"):
        return LIST
    maps = (".mgh", ".mgz", ".nii", ".nii.gz", ".csv", ".curv", ".sulc", ".thickness", ".area")
    return MAPS if name.endswith(maps) else SURFACE


def tables(found: list[Outcome]) -> str:
    """Return tables in Markdown: files by format and by package, reasons of refusals, and where readers differ."""
    heads = " | ".join((RIGHT, REFUSED, ALONE, WRONG))
    rows: list[str] = []
    for what, key in (("format", lambda item: item.format), ("package", lambda item: item.package)):
        rows += [f"| {what} | files | {heads} |", "|---|---|---|---|---|---|"]
        for name in sorted({key(item) for item in found}):
            rows.append(f"| {name} | {_counts([item for item in found if key(item) == name])} |")
        rows += [f"| **all** | {_counts(found)} |", ""]
    reasons = Counter(item.said for item in found if item.outcome == REFUSED)
    rows += ["| refused for | files | another reader finds faces |", "|---|---|---|"]
    for reason, count in sorted(reasons.items(), key=lambda pair: (-pair[1], pair[0])):
        some = [item for item in found if item.outcome == REFUSED and item.said == reason]
        rows.append(f"| {reason} | {count} | {sum(any(map(_finds_faces, item.others.values())) for item in some)} |")
    rows += ["", "| reader | files | agrees | differs | cannot read |", "|---|---|---|---|---|"]
    for reader in sorted({who for item in found for who in item.others}):
        opinions = [item.others[reader] for item in found if reader in item.others and item.outcome != REFUSED]
        unread = sum(said.startswith("cannot read it") or said == "no faces" for said in opinions)
        agrees = opinions.count("")
        rows.append(f"| {reader} | {len(opinions)} | {agrees} | {len(opinions) - agrees - unread} | {unread} |")
    return "\n".join(rows) + "\n"


def _counts(some: list[Outcome]) -> str:
    counts = Counter(item.outcome for item in some)
    return " | ".join(map(str, (len(some), *(counts[outcome] for outcome in (RIGHT, REFUSED, ALONE, WRONG)))))


def _finds_faces(said: str) -> bool:
    return said.startswith("finds") and not said.endswith(" 0 faces")
