"""Hydra's flags among the words of a request, told apart without Hydra, whose import takes a second."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

from surfexp.lab.errors import UserError, unknown

ANYTHING: tuple[str, ...] = ()
SHORT = {
    "--help": "-h",
    "--cfg": "-c",
    "--package": "-p",
    "--run": "-r",
    "--multirun": "-m",
    "--shell-completion": "-sc",
    "--config-path": "-cp",
    "--config-name": "-cn",
    "--config-dir": "-cd",
    "--info": "-i",
}
ALONE = ("--help", "--hydra-help", "--version", "--resolve", "--run", "--multirun", "--shell-completion")
# flags with a value, and what it can be
WITH_VALUE: dict[str, tuple[str, ...]] = {
    "--cfg": ("job", "hydra", "all"),
    "--package": ANYTHING,
    "--config-path": ANYTHING,
    "--config-name": ANYTHING,
    "--config-dir": ANYTHING,
    "--experimental-rerun": ANYTHING,
    "--info": ("all", "config", "defaults", "defaults-tree", "plugins", "searchpath"),
}
FLAGS = {flag: flag for flag in (*ALONE, *WITH_VALUE)} | {short: flag for flag, short in SHORT.items()}
# Hydra does one of them at a time
MODES = ("--run", "--multirun", "--cfg", "--info", "--shell-completion")
ANSWERED_BY_HYDRA = frozenset(["--info", "--hydra-help", "--version", "--shell-completion", "--experimental-rerun"])


@dataclass(frozen=True)
class Words:
    """What was typed behind `surfexp run`.

    Attributes
    ----------
    flags : mapping of str to str
        Values of the flags by their long names, "" where one has none.
    typed : tuple of str
        The flags and their values as they were typed.
    overrides : tuple of str
        The other words.
    """

    flags: Mapping[str, str]
    typed: tuple[str, ...]
    overrides: tuple[str, ...]

    @property
    def config_dir(self) -> Path | None:
        """Folder of `--config-dir`."""
        return Path(self.flags["--config-dir"]) if "--config-dir" in self.flags else None


def parted(words: Iterable[str]) -> Words:
    """Part Hydra's flags from the overrides.

    Raises
    ------
    UserError
        If a flag is unknown, lacks its value or has one that it cannot have, or two exclude each other.
    """
    flags: dict[str, str] = {}
    typed: list[str] = []
    overrides: list[str] = []
    rest = list(words)
    while rest:
        word = rest.pop(0)
        if not word.startswith("-"):
            overrides.append(word)
            continue
        name, given, value = word.partition("=")
        if name not in FLAGS:
            raise unknown("option", name, FLAGS)
        flag = FLAGS[name]
        typed.append(word)
        if flag in WITH_VALUE:
            if not given and rest and _is_value(flag, rest[0]):
                value = rest.pop(0)
                typed.append(value)
            _check_value(name, flag, value)
        elif given:
            raise UserError(f"{word}: {name} has no value")
        flags[flag] = value
    _check_together(flags)
    return Words(flags, tuple(typed), tuple(overrides))


def _is_value(flag: str, word: str) -> bool:
    """Whether a word belongs to the flag before it; that of --info may be left out."""
    return not word.startswith("-") and (flag != "--info" or "=" not in word)


def _check_value(name: str, flag: str, value: str) -> None:
    choices = WITH_VALUE[flag]
    if not value and flag != "--info":
        raise UserError(f"{name} needs a value{': ' if choices else ''}{', '.join(choices)}")
    if value and choices and value not in choices:
        raise unknown(f"value of {name}", value, choices)
    if flag == "--config-dir" and not Path(value).is_dir():
        raise UserError(f"{name} {value}: no such folder")


def _check_together(flags: Mapping[str, str]) -> None:
    asked = [flag for flag in MODES if flag in flags]
    if len(asked) > 1:
        raise UserError(f"{' and '.join(asked)} exclude each other: give one of them")
    for flag in ("--resolve", "--package"):
        if flag in flags and "--cfg" not in flags:
            raise UserError(f"{flag} says how --cfg shows a configuration: give --cfg job, hydra or all too")
