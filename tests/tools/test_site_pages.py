"""The site names every plugin, experiment and study, answers by question, and has the words that people search for."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest

import surfexp as sx
from surfexp.commands.all_commands import SECTIONS
from surfexp.lab.registry.catalogue import catalogue
from surfexp.lab.registry.folders import experiments

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
SEARCHED = ("FWHM", "medial wall", "ZoomOut", "TFCE", "GPU", "BrainPrint", "spin test", "surrogate")


@pytest.fixture(scope="module")
def pages(tmp_path_factory: pytest.TempPathFactory) -> Path:
    sys.path.insert(0, str(DOCS))
    try:
        from docs_registry import write_registry  # type: ignore[import-not-found]
    finally:
        sys.path.remove(str(DOCS))
    folder: Path = tmp_path_factory.mktemp("generated")
    write_registry(folder)
    return folder


@pytest.mark.slow
def test_every_plugin_has_a_section_with_its_options_and_users(pages: Path) -> None:
    for (kind, name), one in catalogue(ROOT).plugins.items():
        text = (pages / "plugins" / f"{kind}.md").read_text()
        _, _, section = text.partition(f"(plugin-{kind}-{name})=\n## {name}\n")
        section = section.partition("\n(plugin-")[0]
        assert section, f"{kind}/{name}"
        assert all(f"| `{option}` |" in section for option, *_ in one.options)
    solver = (pages / "plugins" / "solver.md").read_text().partition("## primal_dual\n")[2].partition("\n(plugin-")[0]
    assert "[quickstart](../experiments/quickstart.md)" in solver


@pytest.mark.slow
def test_every_experiment_has_a_page_with_its_question_methods_and_claims(pages: Path) -> None:
    index = (pages / "experiments" / "index.md").read_text()
    for name in experiments():
        text = (pages / "experiments" / f"{name}.md").read_text()
        assert f"surfexp run experiment={name}" in text and f"[{name}]({name}.md)" in index
        for kind, plugin in re.findall(r"#plugin-([a-z_]+)-([\w]+)\)", text):
            assert (kind, plugin) in catalogue(ROOT).plugins
    assert "- Chambolle's method" in (pages / "experiments" / "rof_cup.md").read_text()


@pytest.mark.slow
def test_every_study_has_a_page_with_its_programs(pages: Path) -> None:
    for file in ROOT.glob("studies/*/README.md"):
        text = (pages / "studies" / f"{file.parent.name}.md").read_text()
        assert all(program.name in text for program in (file.parent / "examples").glob("*.py"))
        for link in re.findall(r"\]\((\.\./\.\./[^)#]+)\)", text):
            assert (DOCS / link.removeprefix("../../")).is_file(), link


def test_every_study_has_an_example_in_the_gallery() -> None:
    studies = [file.parent for file in ROOT.glob("studies/*/__init__.py")]
    assert len(studies) >= 17
    for study in studies:
        named = re.findall(
            r"^- Example: \[.+\?\]\(\.\./\.\./examples/(\w+)\.py\)$", (study / "README.md").read_text(), re.M
        )
        assert len(named) == 1 and (ROOT / "examples" / f"{named[0]}.py").is_file(), study.name


def test_answers_by_question_name_what_there_is() -> None:
    text = (DOCS / "questions.md").read_text()
    functions = set(re.findall(r"`sx\.(\w+)\(", text))
    commands = set(re.findall(r"`surfexp ([\w-]+)", text))
    known = {name for section in SECTIONS.values() for name in section}
    assert len(functions) > 15 and all(hasattr(sx, name) for name in functions)
    assert len(commands) > 12 and commands <= known
    # every task of the face is the answer to some question
    tasks = {name for name in sx.__all__ if name[0].islower()} - {
        "ldlt",
        "eigsh",
        "load",
        "run",
        "shape",
        "denoise_path",
    }
    assert tasks <= functions


@pytest.mark.parametrize("word", SEARCHED)
def test_what_people_search_for_is_on_a_page(word: str) -> None:
    texts = [file.read_text(encoding="utf-8").lower() for file in DOCS.glob("*.md")]
    assert any(word.lower() in text for text in texts)
