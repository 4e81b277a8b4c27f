"""`surfexp fetch`: public collections that are too large to come with the package."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import Any

from surfexp.commands.parser import Parser
from surfexp.extras import require_installed
from surfexp.workflow.errors import UserError

# the high-resolution shapes as .vert and .tri (Bronstein, Bronstein and Kimmel 2008)
COLLECTIONS = {"tosca": "http://tosca.cs.technion.ac.il/data/toscahires-asci.zip"}


def command(name: str, arguments: list[str]) -> int:
    """Download a collection once and unpack it; its SHA-256 is written down, and held against at every later time.

    The publishers name no checksum: the first download is trusted unless --sha256 is given.
    """
    parser = Parser(f"surfexp {name}", description=command.__doc__)
    parser.add_argument("collection", choices=sorted(COLLECTIONS))
    parser.add_argument("--to", type=Path, help="folder; default: the collection's name in the working folder")
    parser.add_argument("--url", help="another place that has the archive")
    parser.add_argument("--sha256", help="checksum that the archive must have")
    given = parser.parse_args(arguments)
    url, folder = given.url or COLLECTIONS[given.collection], given.to or Path(given.collection)
    archive, pin = folder / url.rpartition("/")[2], folder / "SHA256"
    known = given.sha256 or (pin.read_text().split()[0] if pin.is_file() else None)
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
    return 0


def _pooch() -> Any:
    require_installed("fetch", "pooch")
    pooch: Any = import_module("pooch")
    pooch.get_logger().setLevel("ERROR")
    return pooch
