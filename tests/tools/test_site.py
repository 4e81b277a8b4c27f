"""The site builds without a warning, has every public name, and reads from disk without another host."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from surfexp.face import FACE

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"


def test_the_page_of_the_api_has_every_public_name() -> None:
    listed = re.findall(r"^   (\w+)$", (DOCS / "api.md").read_text(encoding="utf-8"), re.MULTILINE)
    assert sorted(listed) == sorted(FACE)


def test_every_page_of_a_method_is_in_the_table_of_contents_and_has_its_parts() -> None:
    pages = {page.stem: page.read_text(encoding="utf-8") for page in (DOCS / "methods").glob("*.md")}
    contents = pages.pop("index")
    for name, text in pages.items():
        assert f"\n{name}\n" in contents
        for part in ("## The idea", "## When to use it", "## Cost and certificate", "## Example", "## Sources"):
            assert part in text, f"{name} lacks {part}"


@pytest.mark.slow
def test_the_site_builds_and_asks_no_other_host(tmp_path: Path) -> None:
    for package in ("furo", "myst_parser", "sphinx_gallery", "latex2mathml"):
        pytest.importorskip(package, reason="needs pip install 'surfexp[site]'")
    command = [sys.executable, "-m", "sphinx", "-b", "html", "--fail-on-warning", "-D", "plot_gallery=0"]
    environment = {**os.environ, "PYTHONPATH": str(DOCS)}
    done = subprocess.run(
        [*command, str(DOCS), str(tmp_path)], env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr[-2000:]
    loads = re.compile(r"<(?:script|img|link|iframe)[^>]*(?:src|href)=\"(?:https?:)?//[^\"]*\"")
    for page in tmp_path.rglob("*.html"):
        assert not loads.findall(page.read_text(encoding="utf-8")), page.name
    assert (tmp_path / "searchindex.js").stat().st_size > 0
