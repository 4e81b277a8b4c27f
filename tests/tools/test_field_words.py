"""Pages, help texts, errors and public docstrings use the field's words, by the list in docs/contributing.md."""

from __future__ import annotations

import ast
import importlib
import inspect
import re
from pathlib import Path

import click
import pytest

from surfexp.commands.all_commands import surfexp
from surfexp.face import FACE

ROOT = Path(__file__).resolve().parents[2]
LIST = ROOT / "docs" / "contributing.md"
MADE = {"reproduction.md", "claim_faults.md", "mutation.md"}  # of statements in experiments and lines of code
COMMITTED = ROOT / "docs" / "protocols"  # before the runs that they are about
PAGES = [
    page
    for page in [*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md"), *(ROOT / "examples").rglob("*.md")]
    if page.name not in MADE and not {"generated", "reproduction"} & set(page.parts) and COMMITTED not in page.parents
]


def terms(page: str) -> dict[str, str]:
    """The words of the list, and what to write instead."""
    table = page.partition("| instead of | write |\n|---|---|\n")[2].partition("\n\n")[0]
    rows = [[cell.strip() for cell in row.strip("|").split("|")] for row in table.splitlines()]
    return {word.strip(): instead for words, instead in rows for word in words.split(",")}


def refused(text: str, words: dict[str, str]) -> dict[str, str]:
    """The words of the list that a text has; code, quoted names, links and pictures aside."""
    prose = re.sub(r"```.*?```|`[^`]*`|'\w+'|\]\([^)]*\)", " ", text, flags=re.DOTALL)
    prose = " ".join(prose.split())
    return {
        word: instead for word, instead in words.items() if re.search(rf"\b{word}(s|d|ed)?\b", prose, re.IGNORECASE)
    }


TERMS = terms(LIST.read_text(encoding="utf-8"))


def commands(group: click.Command, name: str) -> dict[str, click.Command]:
    found = {name: group}
    if isinstance(group, click.Group):
        context = click.Context(group)
        for inner in group.list_commands(context):
            command = group.get_command(context, inner)
            assert command is not None
            found |= commands(command, f"{name} {inner}")
    return found


COMMANDS = commands(surfexp, "surfexp")


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_a_page_uses_the_words_of_the_field(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    if page == LIST:
        text = re.sub(r"^\| instead of .*?\n\n", "", text, flags=re.DOTALL | re.MULTILINE)
    assert not refused(text, TERMS)


@pytest.mark.parametrize("name", COMMANDS)
def test_a_help_text_uses_the_words_of_the_field(name: str) -> None:
    command = COMMANDS[name]
    texts = [
        command.help or "",
        command.epilog or "",
        *(getattr(option, "help", "") or "" for option in command.params),
    ]
    assert not refused("\n".join(texts), TERMS)


@pytest.mark.parametrize("name", sorted(FACE))
def test_a_public_docstring_uses_the_words_of_the_field(name: str) -> None:
    public = getattr(importlib.import_module(FACE[name]), name)
    members = (
        [value for key, value in vars(public).items() if not key.startswith("_")] if inspect.isclass(public) else []
    )
    assert not refused("\n".join(inspect.getdoc(value) or "" for value in [public, *members]), TERMS)


@pytest.mark.parametrize("folder", ["surfexp", "plugins", "snakemake_executor_plugin_surfexp"])
def test_an_error_uses_the_words_of_the_field(folder: str) -> None:
    found = {}
    for file in (ROOT / folder).rglob("*.py"):
        for node in (node for node in ast.walk(ast.parse(file.read_bytes())) if isinstance(node, ast.Raise)):
            parts = [part.value for part in ast.walk(node) if isinstance(part, ast.Constant)]
            if wrong := refused("".join(part for part in parts if isinstance(part, str)), TERMS):
                found[f"{file.relative_to(ROOT)}:{node.lineno}"] = wrong
    assert not found


def test_a_word_of_the_list_is_seen_and_code_is_not() -> None:
    assert refused("The rims of a\n surface, seen\nagain.", TERMS) == {
        "rim": "boundary, interlevel set",
        "seen again": "retest",
    }
    assert not refused("`rim` [page](rim.md)\n```\nthe rim\n```\ntrimmed", TERMS)


def test_there_are_pages_words_and_commands() -> None:
    assert len(PAGES) > 40 and len(TERMS) > 30 and len(COMMANDS) > 30
