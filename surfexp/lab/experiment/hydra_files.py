"""What Hydra reads under a name: one file, since of two it would take one and say nothing."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from surfexp.lab.errors import UserError


def check_one_file(name: str, repository: Any) -> None:
    """Refuse a name of a group, `experiment/rof_cup`, under which two folders have different files.

    Parameters
    ----------
    name : str
    repository
        Hydra's, of configuration files.

    Raises
    ------
    UserError
        Naming both files.
    """
    sources = [source for source in repository.get_sources() if source.scheme() == "file" and source.is_config(name)]
    files = [Path(source.path, f"{name}.yaml") for source in sources]
    for other in files[1:]:
        if other.read_bytes() != files[0].read_bytes():
            raise UserError(f"{name} is two files, {files[0]} and {other.resolve()}: give one another name")


def loaded(name: str, repository: Any) -> Any:
    """Return what Hydra reads under a name of a group, None where there is nothing; UserError as `check_one_file`."""
    check_one_file(name, repository)
    return repository.load_config(name)
