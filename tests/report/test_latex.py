"""Tables as LaTeX: every cell there, specials harmless, the best in bold; compiled where LaTeX is installed."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from surfexp.contract.metric import Metric
from surfexp.lab.plan.plan import Leaf
from surfexp.records.comparison import Comparison
from surfexp.records.table import Row
from surfexp.report.latex import WORDS, escape, latex_table, number

DECLARED = {"rmse": Metric("root of the mean squared error", "mm", "lower"), "psnr": Metric("", "dB", "higher")}


def comparison() -> Comparison:
    leaf = Leaf("key", "configuration", {"target": "solver"})
    numbers = [(9.4512e-5, 23.0), (3607872.0, 25.5), (0.0, 0.0)]
    rows = [
        Row(
            leaf,
            {"surface.name": name, "solver.name": "newton", "solver.exact": exact},
            {} if failure else {"rmse": rmse, "psnr": psnr, "converged": 1.0},
            1.0,
            failure=failure,
        )
        for name, exact, (rmse, psnr), failure in zip(
            ("split_bregman", r"50% & $x_1$ \{#}~^", "λ <= 2"),
            (True, False, True),
            numbers,
            ("", "", "no"),
            strict=True,
        )
    ]
    return Comparison("Noise & more", "Error in mm, λ ≤ 2.", rows, ["rmse", "psnr"], DECLARED)


def test_every_cell_is_there_with_units_directions_and_the_best_in_bold() -> None:
    text = latex_table(comparison(), "rof cup/1", "surfexp run experiment=rof_cup")
    lines = text.splitlines()
    head = next(line for line in lines if "rmse" in line)
    assert r"rmse (mm) $\downarrow$" in head and r"psnr (dB) $\uparrow$" in head
    body = lines[lines.index(r"    \midrule") + 1 : lines.index(r"    \bottomrule")]
    assert len(body) == 3 and all(len(re.findall(r"(?<!\\)&", line)) == 4 for line in [head, *body])
    assert body[0].startswith(r"    split\_bregman & yes & ")
    assert r"$9.5\times 10^{-5}$" in body[0] and r"\boldmath$25.5$" in body[1] and r"$3\,607\,872$" in body[1]
    assert body[2].endswith(r"& -- & -- & failed \\") and r"\label{tab:rof-cup-1}" in text
    assert text.startswith("% surfexp run experiment=rof_cup\n")


@given(st.text(alphabet=[*WORDS, *"abc 1"], max_size=30))
def test_no_special_character_is_left(text: str) -> None:
    shown = re.sub(r"\\[a-zA-Z]+(\{\})?|\\[&%$#_{},]|\$[^$]*\$", "", escape(text))
    assert not set(shown) & set("&%$#_{}\\~^<>|") and shown.isascii()


def test_numbers_are_mathematics() -> None:
    assert number(float("inf")) == r"$\infty$" and number(float("-inf")) == r"$-\infty$" and number(None) == "--"
    assert number(1.5e8) == r"$150\,000\,000$" or number(1.5e8) == r"$1.5\times 10^{8}$"


@pytest.mark.skipif(shutil.which("pdflatex") is None, reason="needs pdflatex (texlive-latex-base)")
def test_the_table_compiles_with_booktabs_alone(tmp_path: Path) -> None:
    table = latex_table(comparison(), "one", "surfexp run")
    document = "\n".join(
        [r"\documentclass{article}", r"\usepackage{booktabs}", r"\begin{document}", table, r"\end{document}"]
    )
    (tmp_path / "table.tex").write_text(document, encoding="utf-8")
    command = ["pdflatex", "-interaction=nonstopmode", "-halt-on-error", "table.tex"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout[-2000:]
    assert "Overfull" not in done.stdout or (tmp_path / "table.pdf").exists()


def test_seconds_that_were_asked_for_are_a_column() -> None:
    leaf = Leaf("key", "configuration", {"target": "solver"})
    rows = [Row(leaf, {"solver.name": name}, {"gap": 1.0}, seconds) for name, seconds in (("a", 0.25), ("b", None))]
    text = latex_table(Comparison("Clocks", "", rows, ["seconds", "gap"]), "t", "surfexp run")
    assert r"solver & seconds (s) & gap \\" in text and r"a & $0.25$ & $1$ \\" in text and r"b & -- & $1$ \\" in text


def test_a_command_of_several_lines_stays_a_comment() -> None:
    text = latex_table(comparison(), "t", "surfexp run title='two\n\\input{secret}'")
    assert text.startswith("% surfexp run title='two \\input{secret}'\n\\begin{table}")
