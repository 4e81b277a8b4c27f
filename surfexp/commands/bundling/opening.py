"""A bundle opened: measured before anything is unpacked, its names and bytes held against its own list."""

from __future__ import annotations

import hashlib
import json
import shutil
import stat
import zipfile
from pathlib import Path, PurePosixPath
from typing import Any
from urllib.parse import unquote

from surfexp.io.unpacked_sizes import check_unpacked
from surfexp.lab.errors import UserError

METADATA, PLAN, FACTS = "ro-crate-metadata.json", "plan.json", "bundle.json"
CODE, LONGEST_NAME, MOST_FILES, LARGEST_LIST = "plugins/", 240, 200_000, 256 << 20
ROOMS = (CODE, "conf/experiment/", "inputs/", "published/")
SINGLE = (METADATA, PLAN, "Snakefile", "config.yaml", FACTS, "README.md")


def opened(bundle: Path) -> list[str]:
    """Check all of a bundle; return the names of its files.

    Parameters
    ----------
    bundle : path
        A .zip, as `surfexp export --bundle` writes it.

    Returns
    -------
    list of str

    Raises
    ------
    UserError
        If it is no bundle, unpacks to too much, has a name that leads elsewhere, or bytes that its list does not know; by name.
    """
    if not bundle.is_file():
        raise UserError(f"file {str(bundle)!r} does not exist")
    try:
        with zipfile.ZipFile(bundle) as archive:
            members = [member for member in archive.infolist() if not member.is_dir()]
            _check_members(bundle, members)
            listed = _listed(bundle, archive)
            names = {member.filename for member in members} - {METADATA}
            for name in sorted(names ^ listed.keys()):
                said = "is in the archive and not" if name in names else "is not in the archive, but"
                raise UserError(f"{bundle}: {name!r} {said} in {METADATA}: get the bundle again")
            for name in sorted(names):
                with archive.open(name) as stream:
                    if hashlib.file_digest(stream, "sha256").hexdigest() != listed[name]:  # type: ignore[arg-type]
                        raise UserError(
                            f"{bundle}: {name!r} was changed: its SHA-256 is not that of {METADATA}; get the bundle again"
                        )
    except (zipfile.BadZipFile, NotImplementedError, RuntimeError, EOFError, OSError) as error:
        raise UserError(f"{bundle} is no bundle, or damaged: {' '.join(str(error).split())}") from None
    for needed in (PLAN, FACTS):
        if needed not in names:
            raise UserError(f"{bundle} has no {needed}: it was not written by surfexp export --bundle")
    return sorted(names)


def unpack(bundle: Path, names: list[str], folder: Path) -> None:
    """Write the files of a checked bundle below a folder that is empty, or made.

    Raises
    ------
    UserError
        If there is something in the folder.
    """
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise UserError(f"{folder} is not empty: choose another folder with --to")
    folder.mkdir(parents=True, exist_ok=True)
    with zipfile.ZipFile(bundle) as archive:
        for name in (METADATA, *names):
            target = folder.joinpath(*PurePosixPath(name).parts)
            target.parent.mkdir(parents=True, exist_ok=True)
            with archive.open(name) as stream, target.open("xb") as written:
                shutil.copyfileobj(stream, written)


def _check_members(bundle: Path, members: list[zipfile.ZipInfo]) -> None:
    if len(members) > MOST_FILES:
        raise UserError(f"{bundle} has {len(members):,} files, at most {MOST_FILES:,} are unpacked")
    try:
        check_unpacked(sum(member.file_size for member in members), bundle.stat().st_size)
    except ValueError as error:
        raise UserError(f"{bundle}: {error}") from None
    seen = set[str]()
    for member in members:
        if fault := fault_of(member.orig_filename, member.external_attr >> 16):
            raise UserError(f"{bundle}: the name {member.orig_filename!r} {fault}; nothing was unpacked")
        if member.filename.casefold() in seen:
            raise UserError(f"{bundle}: the name {member.filename!r} stands twice in it; nothing was unpacked")
        seen.add(member.filename.casefold())


def fault_of(name: str, mode: int = 0) -> str:
    """Say why a name of a file in an archive is refused, "" where it is not.

    Parameters
    ----------
    name : str
    mode : int
        Of the file, as Unix has it; 0 where it is not known.

    Examples
    --------
    >>> fault_of("../../.bashrc")
    'leads out of the folder'
    >>> fault_of("published/metrics.csv")
    ''
    """
    parts = name.split("/")
    if not name.isprintable() or "\\" in name or ":" in name or len(name) > LONGEST_NAME:
        return "is no name of a file on every machine"
    if name.startswith("/") or {"", ".", ".."} & set(parts):
        return "leads out of the folder"
    if mode and not stat.S_ISREG(mode) and stat.S_IFMT(mode):
        return "is of a link or a device"
    if name not in SINGLE and not name.startswith(ROOMS):
        return "is of no part of a bundle"
    return ""


def _listed(bundle: Path, archive: zipfile.ZipFile) -> dict[str, str]:
    """SHA-256 by name, as the description of a bundle has them."""
    try:
        if archive.getinfo(METADATA).file_size > LARGEST_LIST:
            raise UserError(f"{bundle}: {METADATA} has over {LARGEST_LIST:,} bytes")
        graph: list[dict[str, Any]] = json.loads(archive.read(METADATA))["@graph"]
        return {unquote(item["@id"]): str(item["sha256"]) for item in graph if "sha256" in item}
    except (KeyError, TypeError, ValueError, RecursionError):
        raise UserError(f"{bundle} has no {METADATA} that lists its files: it is no bundle of surfexp") from None
