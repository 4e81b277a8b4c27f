"""The surfaces and labelled structures of files, folders and FreeSurfer subjects, by the names of their columns."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from os.path import commonpath
from pathlib import Path
from typing import Any

from surfexp.anatomy.aseg import LabelledStructure, structures_in
from surfexp.io.mesh_patterns import MESH_PATTERNS, files_called
from surfexp.tasks.surface_file import PathLike

CORTEX = ("lh.white", "lh.pial", "rh.white", "rh.pial")
# FreeSurfer's segmentation volume: in a subject's folder, and as fMRIPrep writes it among BIDS derivatives
SEGMENTATION, DERIVATIVE = Path("mri/aseg.mgz"), "*_desc-aseg_dseg.nii.gz"
Source = Path | LabelledStructure


def structures(sources: Sequence[PathLike]) -> dict[str, Source]:
    """Return the surfaces and labelled structures of files, folders and FreeSurfer subjects, by the name of their column.

    Where sources hold surfaces of one name, as lh.white of two folders, names begin with what tells the sources apart.

    Raises
    ------
    ValueError
        If a source is not there, or there is no surface at all.
    """
    by_source = {source: _structures_of(source) for source in map(_path, sources)}
    first: dict[str, Source] = {}
    pairs = [(name, one) for found in by_source.values() for name, one in found.items()]
    doubled = {name for name, one in pairs if first.setdefault(name, one) != one}
    apart = {source: found for source, found in by_source.items() if not doubled.isdisjoint(found)}
    named = by_source | (_told_apart(apart) if apart else {})
    found = {name: one for held in named.values() for name, one in held.items()}
    if not found:
        given_names = ", ".join(map(str, sources))
        raise ValueError(
            f"no surface in {given_names}: neither surf/lh.white and the like, nor {SEGMENTATION}, nor {', '.join(MESH_PATTERNS)}"
        )
    return found


def _told_apart(by_source: dict[Path, dict[str, Source]]) -> dict[Path, dict[str, Source]]:
    """Return structures by names that begin with the path of their source, from where the paths part."""
    base = commonpath([source.absolute().parent for source in by_source])
    places = {source: source.absolute().relative_to(base) for source in by_source}
    short = {source: str(place.with_name(_stem(place))) for source, place in places.items()}
    alike = Counter(short.values())
    return {
        source: {short[source] if alike[short[source]] == 1 else str(places[source]): source}
        if source.is_file()
        else {f"{places[source]} {name}": one for name, one in found.items()}
        for source, found in by_source.items()
    }


def _path(given: Any) -> Path:
    if not isinstance(given, str | Path):
        kind = type(given).__name__
        raise ValueError(
            f"sources hold a {kind}, paths are needed; of surfaces in memory take sx.ShapeDNA or sx.eigenpairs"
        )
    return Path(given)


def _structures_of(source: Path) -> dict[str, Source]:
    if source.is_file():
        return {_stem(source): source}
    if not source.is_dir():
        raise ValueError(f"{source} is neither a file nor a folder")
    if _is_subject(source):
        return _subject(source, "")
    if subjects := sorted(filter(_is_subject, source.iterdir())):
        return {name: found for one in subjects for name, found in _subject(one, f"{one.name} ").items()}
    files = files_called(source)
    short = [str(file.relative_to(source).with_name(_stem(file))) for file in files]
    whole = [str(file.relative_to(source)) for file in files]
    names = [long if short.count(name) > 1 else name for name, long in zip(short, whole, strict=True)]
    surfaces: dict[str, Source] = dict(zip(names, files, strict=True))
    for volume in sorted(source.rglob(DERIVATIVE)):
        prefix = str(volume.relative_to(source)).removesuffix(DERIVATIVE[1:])
        surfaces |= {f"{prefix} {name}": structure for name, structure in structures_in(volume).items()}
    return surfaces


def _is_subject(folder: Path) -> bool:
    return (folder / "surf").is_dir() or (folder / SEGMENTATION).is_file()


def _subject(subject: Path, prefix: str) -> dict[str, Source]:
    files = {name: subject / "surf" / name for name in CORTEX}
    found: dict[str, Source] = {f"{name.replace('.', '-')}-2d": file for name, file in files.items() if file.is_file()}
    if (subject / SEGMENTATION).is_file():
        found |= structures_in(subject / SEGMENTATION)
    return {f"{prefix}{name}": source for name, source in found.items()}


def _stem(file: Path) -> str:
    if file.suffix in (".white", ".pial"):
        return file.name
    return file.name.removesuffix(".surf.gii") if file.name.endswith(".surf.gii") else file.stem
