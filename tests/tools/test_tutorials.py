"""The tutorials are run as they stand: files written, commands and Python run in order, what they print compared."""

from __future__ import annotations

import contextlib
import io
import os
import re
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
import yaml

from surfexp.lab.experiment.former_spelling import present

DOCS = Path(__file__).resolve().parents[2] / "docs"
TUTORIALS = sorted(path for path in (DOCS / "tutorials").glob("*.md") if path.stem != "index")
RUN = [*TUTORIALS, DOCS / "index.md"]
FENCE = re.compile(r"^```(?:\{code-block\} )?(\w+)\n(?::caption: (\S+)\n\n?)?(.*?)^```$", re.MULTILINE | re.DOTALL)


@dataclass(frozen=True)
class Block:
    """A fenced block of a page: its language, the file that it is, its text."""

    language: str
    file: str
    text: str


def blocks(page: Path) -> list[Block]:
    return [Block(*found) for found in FENCE.findall(page.read_text(encoding="utf-8"))]


def missing(expected: str, printed: str) -> list[str]:
    """Lines of an expected output that no printed line matches; an ellipsis stands for anything."""
    lines = printed.splitlines()
    wanted = [line for line in expected.splitlines() if line.strip("… ")]
    patterns = [".*".join(map(re.escape, line.split("…"))) for line in wanted]
    found = [any(re.fullmatch(pattern, said) for said in lines) for pattern in patterns]
    return [line for line, is_there in zip(wanted, found, strict=True) if not is_there]


def commands(text: str) -> Iterator[tuple[str, str]]:
    """The commands of a console block, each with the lines that it should print."""
    for part in re.split(r"^\$ ", text, flags=re.MULTILINE)[1:]:
        command, _, expected = part.replace("\\\n", " ").partition("\n")
        yield command, expected


def run(page: Path) -> Iterator[str]:
    """Run a page in the working folder and give what went otherwise than it says."""
    names: dict[str, Any] = {"__name__": "__main__"}
    environment = {
        **os.environ,
        "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}",
        "COLUMNS": "200",
    }
    printed = ""
    for block in blocks(page):
        if block.file:
            file = Path(block.file)
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(block.text, encoding="utf-8")
        elif block.language == "python":
            stream = io.StringIO()
            with contextlib.redirect_stdout(stream):
                exec(compile(block.text, page.name, "exec"), names)  # noqa: S102, the project's own tutorials
            printed = stream.getvalue()
        elif block.language == "text":
            yield from missing(block.text, printed)
        elif block.language == "console":
            for command, expected in commands(block.text):
                if command.startswith("pip "):
                    continue
                done = subprocess.run(  # noqa: S602, lines of the project's own tutorials are for a shell
                    command, shell=True, env=environment, capture_output=True, text=True, check=False
                )
                if done.returncode:
                    yield f"{command}: exit {done.returncode}: {done.stderr[-300:]}"
                yield from (f"{command}: {line}" for line in missing(expected, done.stdout + done.stderr))


@pytest.mark.slow
@pytest.mark.parametrize("page", RUN, ids=lambda page: page.stem)
def test_every_line_of_a_tutorial_does_what_the_page_says(page: Path, working_folder: Path) -> None:
    assert list(run(page)) == []


@pytest.mark.parametrize("page", RUN, ids=lambda page: page.stem)
def test_experiments_of_a_page_have_the_present_spelling(page: Path) -> None:
    """In every run of the tests, where the pages themselves take minutes."""
    experiments = [block.text for block in blocks(page) if block.file.startswith("conf/experiment/")]
    documents = [yaml.safe_load(text) for text in experiments]
    assert [present(document) for document in documents] == documents


def test_pages_have_blocks_and_their_files_are_told_from_commands() -> None:
    assert {path.stem for path in TUTORIALS} >= {"my_cortex", "my_shapes", "experiment", "solver", "operator"}
    found = blocks(DOCS / "tutorials" / "experiment.md")
    assert found[0].file == "conf/experiment/noise_and_error.yaml" and found[0].text.startswith("title: ")
    assert [command for block in found if block.language == "console" for command, _ in commands(block.text)]


def test_what_is_not_printed_is_named() -> None:
    assert missing("a … c\nnine\n…\n", "a big c\nten") == ["nine"]
    assert missing("…shape_dna…", "| shape_dna | 1 |\n") == []
    assert list(commands("$ one \\\n  more\nsaid\n$ two\n")) == [("one    more", "said\n"), ("two", "")]
