"""Which hemisphere a file is of: what it says inside, else its name."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path

from surfexp.io.cifti import hemisphere_of_cifti, is_cifti
from surfexp.io.declared_sizes import check_declared_sizes
from surfexp.io.entrance import reading
from surfexp.io.gifti import hemisphere_of_gifti, is_gifti
from surfexp.io.npz import hemisphere_of_npz
from surfexp.io.ply import hemisphere_of_ply

INSIDE = {".ply": hemisphere_of_ply, ".npz": hemisphere_of_npz}
LEFT = {"l", "lh", "left"}
# lh and rh anywhere between signs, left and right, hemi-L, and the single letters of HCP and BIDS
NAMED_SIDE = re.compile(r"(?:^|(?<=[._-]))(lh|rh|LH|RH|left|right|(?<=hemi-)[LR]|(?<=[.])[LR](?=[.]))(?=$|[._-])")


def hemisphere_of_file(path: Path | str) -> str:
    """Return "left" or "right" where a GIFTI, CIFTI, PLY or npz file, or the name of another one, says so, else nothing.

    Raises
    ------
    ValueError
        If a GIFTI, CIFTI or npz file cannot be read; the message begins with its name.
    """
    path = Path(path)
    with reading(path, "cannot be read"):
        if is_cifti(path) and path.is_file():
            # one that holds both may be called after a movement of the left hand
            check_declared_sizes(path)
            return hemisphere_of_cifti(path)
        inside = ""
        if is_gifti(path):
            check_declared_sizes(path)
            inside = hemisphere_of_gifti(path)
        elif path.suffix.lower() in INSIDE and path.is_file():
            inside = INSIDE[path.suffix.lower()](path)
    return inside or hemisphere_of_name(path.name)


def hemisphere_of_name(name: str) -> str:
    """Return "left" or "right" for names such as lh.white, sub-1_hemi-L_pial.gii, fsLR.R.sulc.gii, else nothing."""
    sides = {"left" if match.lower() in LEFT else "right" for match in NAMED_SIDE.findall(name)}
    return sides.pop() if len(sides) == 1 else ""


def without_side(name: str) -> str:
    """Return a name without what says its side: thickness for lh.thickness, sub-1_pial for sub-1_hemi-L_pial."""
    found = NAMED_SIDE.search(name)
    if found is None:
        return name
    head, tail = name[: found.start()].removesuffix("hemi-"), name[found.end() :]
    return tail[1:] if not head else f"{head[:-1]}{tail}"


def common_name(left: str, right: str) -> str:
    """Return what the names of two hemispheres have in common, or both of them."""
    names = {without_side(left), without_side(right)}
    return names.pop() if len(names) == 1 else f"{left} and {right}"


def holds_both(path: Path) -> bool:
    """Whether one file of the format holds maps of both hemispheres, and says which are which."""
    return is_cifti(path) or path.suffix.lower() == ".npz"


def files_of_sides(path: Path) -> dict[str, Path]:
    """Return where each hemisphere is written to where a format holds one: lh.NAME and rh.NAME."""
    return {side: path.with_name(f"{side[0]}h.{path.name}") for side in ("left", "right")}


def written_files(path: Path, hemisphere: str) -> tuple[Path, ...]:
    """Return the files that maps of a hemisphere, or of both, are written to."""
    return tuple(files_of_sides(path).values()) if hemisphere == "both" and not holds_both(path) else (path,)


def holds_hemisphere(path: Path) -> bool:
    """Whether the format of a file has room for the hemisphere."""
    return is_gifti(path) or is_cifti(path) or path.suffix.lower() in INSIDE


def check_named_side(path: Path, hemisphere: str) -> None:
    """Refuse a file whose name says another hemisphere than what is written to it.

    Raises
    ------
    ValueError
        If it does.
    """
    named = hemisphere_of_name(path.name)
    if hemisphere and named and named != hemisphere:
        whose = "both" if hemisphere == "both" else f"the {hemisphere}"
        raise ValueError(
            f"{path} is named as the {named} hemisphere, what is written is of {whose}: choose another name"
        )


def check_given_side(what: str, file: Path | str, side: str) -> None:
    """Refuse a file that is given as one hemisphere and says that it is the other.

    Raises
    ------
    ValueError
        If it does, or it cannot be read.
    """
    if hemisphere_of_file(file) not in ("", side):
        raise ValueError(
            f"{what} {file} is given as {side}, it is of the other hemisphere: give the file of the {side} one"
        )


def check_same_side(what: str, file: Path | str, side: str) -> None:
    """Refuse a file of another hemisphere than a surface that says its own.

    Raises
    ------
    ValueError
        If it is, or it cannot be read.
    """
    found = hemisphere_of_file(file) if side else ""
    if found not in ("", side):
        raise ValueError(
            f"{what} {file} is of the {found} hemisphere, the surface of the {side}: give the file of the {side} one, "
            f"or --hemisphere {side} if its name is wrong"
        )


def common_hemisphere(files: Iterable[tuple[str, Path | str]]) -> str:
    """Return the hemisphere that files of one surface say, nothing where none says it.

    Parameters
    ----------
    files : iterable of (what it is, path)

    Raises
    ------
    ValueError
        If they say both, or one cannot be read.
    """
    first, side = "", ""
    for what, file in files:
        found = hemisphere_of_file(file)
        if side and found and found != side:
            raise ValueError(
                f"{what} {file} is of the {found} hemisphere, {first} of the {side}: "
                f"give the file of the {side} one, or --hemisphere {side} (hemisphere={side!r}) if its name is wrong"
            )
        if found and not side:
            first, side = f"the {what}" if what == "surface" else f"{what} {file}", found
    return side
