"""What an experiment's file says, read without composing it: its words, and the methods that it names."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from pathlib import Path
from typing import Any

from surfexp.lab.errors import unknown
from surfexp.lab.experiment.hydra_flags import parted
from surfexp.lab.experiment.lines import with_line
from surfexp.lab.experiment.yaml_files import read_yaml
from surfexp.lab.registry.folders import experiments


def read_experiment(name: str) -> dict[str, Any]:
    """Return the contents of an experiment's file, its short forms written out.

    Raises
    ------
    UserError
        If there is no such experiment, or as `read_yaml` and `written_out`.
    """
    from surfexp.lab.experiment.written_out import written_out

    files = experiments()
    if name not in files:
        raise unknown("experiment", name, files)
    return written_out(read_yaml(files[name]))


def check_files(arguments: Iterable[str]) -> None:
    """Read the files of the experiments that a request names, so that a mistake in one is told with its line.

    Parameters
    ----------
    arguments : iterable of str
        As of `surfexp run`: experiment=NAME, or several names with commas.

    Raises
    ------
    UserError
        As `read_yaml`.
    """
    for file in _files(arguments):
        read_yaml(file)


def located(message: str, arguments: Sequence[str]) -> str:
    """Return an error with the line of the experiment's file in which the thing stands that it names.

    Parameters
    ----------
    message : str
    arguments : sequence of str
        As of `surfexp run`; what one of them says itself is not looked for in a file.
    """
    for file in _files(arguments):
        own = [text for text in parted(arguments).overrides if text.partition("=")[0].lstrip("+") != "experiment"]
        if not own:
            return with_line(message, file)
    return message


def _files(arguments: Iterable[str]) -> list[Path]:
    words = parted(arguments)
    files = experiments(words.config_dir)
    arguments = words.overrides
    values = [text.partition("=")[2] for text in arguments if text.partition("=")[0].lstrip("+") == "experiment"]
    names = [name.strip() for value in values for name in value.split(",")]
    return [files[name] for name in names if name in files]


def methods_named(document: Any, kinds: Collection[str]) -> dict[str, list[str]]:
    """Return the plugins that a file names, by stage kind, in order of appearance."""
    found: dict[str, dict[str, None]] = {}
    _collect(document, {kind: kind for kind in kinds} | {"figures": "figure"}, found)
    return {kind: list(names) for kind, names in found.items()}


def _collect(part: Any, kinds: dict[str, str], found: dict[str, dict[str, None]]) -> None:
    if isinstance(part, dict):
        for key, value in part.items():
            if key == "claims":  # cites figures by number
                continue
            if key in kinds:
                for name in _names(value):
                    found.setdefault(kinds[key], {})[name] = None
            _collect(value, kinds, found)
    elif isinstance(part, list):
        for item in part:
            _collect(item, kinds, found)


def _names(value: Any) -> list[str]:
    entries = value if isinstance(value, list) else [value]
    names = [entry.get("name") if isinstance(entry, dict) else entry for entry in entries]
    return [name for name in names if isinstance(name, str)]
