"""`surfexp fetch`: public collections that are too large to come with the package."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import Any

import click

from surfexp.anatomy.data_packages import PACKAGES, DataPackage
from surfexp.commands.click_command import shown
from surfexp.extras import require_installed
from surfexp.lab.errors import UserError

# the high-resolution shapes as .vert and .tri (Bronstein, Bronstein and Kimmel 2008)
COLLECTIONS = {"tosca": "http://tosca.cs.technion.ac.il/data/toscahires-asci.zip"}


@click.command(**shown("fetch", "tosca", "tosca --to shapes/tosca", cls=click.Command))
@click.argument("collection", type=click.Choice(sorted([*COLLECTIONS, *PACKAGES])), metavar="COLLECTION")
@click.option("--to", "folder", type=click.Path(path_type=Path), help="folder; the collection's name if not given")
@click.option("--url", help="another place that has the archive")
@click.option("--sha256", help="checksum that the archive must have")
def fetch(collection: str, folder: Path | None, url: str | None, sha256: str | None) -> None:
    """Get a public collection of surfaces.

    An archive is downloaded once, and its checksum is kept. Publishers name no checksum, so the first download is trusted
    unless --sha256 is given. A package is installed by you; each of its files that experiments read is checked by SHA-256,
    and nothing is copied.
    """
    if collection in PACKAGES:
        _check(PACKAGES[collection])
    else:
        _download(collection, url, folder, sha256)


def _check(package: DataPackage) -> None:
    """Say whether a package's files are there and are those that were seen, who may use them, and what reads them."""
    if package.folder() is None:
        raise UserError(f"{package.module} is not installed: pip install '{package.requirement}', then call this again")
    if faults := package.faults():
        raise UserError(
            f"{len(faults)} of {len(package.files)} files of {package.module} are not those of {package.requirement}: "
            f"{'; '.join(faults)}"
        )
    print(f"{package.module}: all {len(package.files)} files are those of {package.requirement}")
    print(package.terms)
    print("next: " + ", ".join(f"surfexp run experiment={experiment}" for experiment in package.experiments))


def _download(collection: str, given_url: str | None, to: Path | None, sha256: str | None) -> None:
    """Download an archive once and unpack it; its SHA-256 is written down and checked at every later time."""
    url, folder = given_url or COLLECTIONS[collection], to or Path(collection)
    archive, pin = folder / url.rpartition("/")[2], folder / "SHA256"
    known = sha256 or (pin.read_text().split()[0] if pin.is_file() else None)
    pooch = _pooch()
    try:
        pooch.retrieve(url, known_hash=known, fname=archive.name, path=folder, progressbar=False)
    except ValueError as error:
        raise UserError(f"{archive} is not the file that was pinned in {pin}: {str(error).splitlines()[0]}") from error
    except Exception as error:
        raise UserError(f"{url} cannot be fetched: {error}; give another place with --url") from error
    found = pooch.file_hash(str(archive))
    pin.write_text(f"{found}  {archive.name}\n")
    files = pooch.Unzip(extract_dir="shapes")(str(archive), "update" if known is None else "fetch", None)
    print(f"SHA-256 {found}{'' if known else ', trusted at this first download'}, kept in {pin}")
    print(
        f"{len(files)} files in {folder / 'shapes'}; next: surfexp collect {folder / 'shapes'} --surface tosca --to tosca"
    )


def _pooch() -> Any:
    require_installed("fetch", "pooch")
    pooch: Any = import_module("pooch")
    pooch.get_logger().setLevel("ERROR")
    return pooch
