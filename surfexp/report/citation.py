"""What to cite for the methods and data that an experiment used."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from importlib.resources import files

ALWAYS = "always"


@dataclass(frozen=True)
class Reference:
    """An entry of the bibliography.

    Parameters
    ----------
    key : str
    used_by : tuple of str
        Plugins as KIND/NAME, or "always".
    bibtex : str
    """

    key: str
    used_by: tuple[str, ...]
    bibtex: str


@cache
def references() -> tuple[Reference, ...]:
    """Return the bibliography, in the order of its file."""
    import yaml

    text = files("surfexp.report").joinpath("references.yaml").read_text(encoding="utf-8")
    return tuple(Reference(key, tuple(entry["for"]), entry["bibtex"]) for key, entry in yaml.safe_load(text).items())


def cited(plugins: Iterable[str]) -> list[Reference]:
    """Return what to cite for plugins, given as KIND/NAME; the source of the methods comes first."""
    used = {ALWAYS, *plugins}
    return [reference for reference in references() if used & set(reference.used_by)]


def bibliography(plugins: Iterable[str], version: str) -> str:
    """Return BibTeX of this program and of what to cite for plugins, given as KIND/NAME."""
    software = (
        "@software{surfexp,\n"
        "  author = {{The surfexp developers}},\n"
        "  title = {surfexp: reproducible experiments in intrinsic surface processing},\n"
        f"  version = {{{version}}},\n"
        "}\n"
    )
    return "\n".join([software, *(reference.bibtex for reference in cited(plugins))])
