"""Names that no shell, file system or page likes, for folders and experiments: right, or refused in one line."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from audits.torture.case import HUNG, REFUSED, RIGHT, WRONG, Ended, clear
from audits.torture.laboratory import run, working_folder

NAMES = (
    "plain", "with space", "two  spaces", " leading", "trailing ", "quote'", 'double"', "back`tick`", "$(touch X)",
    "$HOME",
    "${HOME}", "a;touch X", "a&touch X", "a|touch X", "a>X", "a<X", "star*", "what?", "[a]", "{a}", "{a,b}", "!x", "#x",
    "~", "~root", "-n", "--help", "a\\b", "a\nb", "a\tb", "ünïcödé", "日本語", "\u202egnp", "a:b", "a=b", "a,b",
    "%s%n",
    "x" * 200, "..", "a/../b", "con", ".hidden",
)  # fmt: skip


def names(every: int = 1) -> Iterator[Ended]:
    """A results folder of each name, or of one of so many; nothing may appear anywhere else."""
    for name in NAMES[::every]:
        with working_folder() as folder:
            before = _all(folder)
            done = run(folder, "run", "experiment=small", f"results={_quoted(name)}")
            stray = [path for path in _all(folder) - before if not _expected(path, name)]
            yield _judged(name, folder, done.code, done.error, stray)


def _quoted(name: str) -> str:
    """As Hydra wants to have any text; a backslash means itself but before a quote."""
    return "'" + name.replace("'", "\\'") + "'" if name != "plain" else name


def _judged(name: str, folder: Path, code: int | None, error: str, stray: list[str]) -> Ended:
    label = ascii(name)
    if code is None:
        return Ended("name", label, HUNG, "the run did not end")
    if stray:
        return Ended("name", label, WRONG, f"left {stray[:3]}")
    if code == 0:
        there = ((folder / name).resolve() / "small" / "report.html").exists()
        return Ended("name", label, RIGHT if there else WRONG, "" if there else "the report is not in the folder")
    wrong = f"exit {code}: {error[-200:]}" if code != 2 else clear(error.strip())
    return Ended("name", label, WRONG if wrong else REFUSED, wrong or error.strip())


def _all(folder: Path) -> set[str]:
    return {entry.name for entry in folder.iterdir()}


def _expected(entry: str, name: str) -> bool:
    return entry in (".snakemake", Path(name).parts[0] if Path(name).parts else "", *Path(name).parts)
