"""Every run and plan that README and docs show can be planned as pasted; every link leads somewhere."""

from __future__ import annotations

import ast
import re
import shlex
from pathlib import Path

import pytest
import yaml

import surfexp as sx
from surfexp.commands.command_line import main
from surfexp.commands.plain_snakemake import words_of

ROOT = Path(__file__).resolve().parents[2]
PAGES = (ROOT / "README.md", ROOT / "docs" / "guide.md")
DOCUMENTED = (ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md")))
STARTS = re.compile(r"(surfexp run |surfexp plan |snakemake .*--config )")
# of a folder that `surfexp collect` wrote, of a plugin that the page shows, a search, a cluster: seen elsewhere
ELSEWHERE = ("datasets", "scaled", "hydra/sweeper", "profile=")
LINES = {
    line.partition("  #")[0].strip()
    for page in DOCUMENTED
    for line in page.read_text(encoding="utf-8").replace("\\\n", "").splitlines()
    if STARTS.match(line) and not any(word in line for word in ELSEWHERE)
}
MODULE_CONFIG = re.compile(r"^ +config:\n +(\{.*\})$", re.MULTILINE)


@pytest.fixture
def files(working_folder: Path) -> None:
    ball = sx.shape("icosphere", levels=3)
    sx.write("brain.ply", ball)
    import nibabel

    nibabel.freesurfer.write_geometry("lh.white", ball.mesh.vertices, ball.mesh.faces)
    nibabel.freesurfer.write_morph_data("lh.curv", ball.mesh.vertices[:, 2])
    nibabel.freesurfer.write_morph_data("lh.sulc", ball.mesh.vertices[:, 0])
    Path("lh.cortex.label").write_text("#!ascii label\n2\n0 0 0 1 0\n1 0 0 1 0\n", encoding="utf-8")


@pytest.mark.slow
@pytest.mark.parametrize("line", sorted(LINES))
def test_it_can_be_planned(line: str, files: None, capsys: pytest.CaptureFixture[str]) -> None:
    words = shlex.split(STARTS.sub("", line, count=1))
    if line.startswith("snakemake"):  # which reads the values as YAML
        pairs = (word.partition("=") for word in words)
        words = list(words_of({name: yaml.safe_load(value) for name, _, value in pairs}))
    assert main(["plan", *words]) == 0, capsys.readouterr().err


def test_the_module_of_the_page_on_snakemake_can_be_planned(
    working_folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (shown,) = MODULE_CONFIG.findall((ROOT / "docs" / "snakemake.md").read_text(encoding="utf-8"))
    assert main(["plan", *words_of(ast.literal_eval(shown))]) == 0, capsys.readouterr().err


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_to_files(page: Path) -> None:
    """Generated pages, which only the site has, aside."""
    links = re.findall(r"\]\(([^)#:]+)\)", page.read_text(encoding="utf-8"))
    assert links and not [link for link in links if "generated/" not in link and not (page.parent / link).exists()]


def test_the_readme_is_read_to_its_end() -> None:
    assert len(PAGES[0].read_text(encoding="utf-8").split()) <= 420
