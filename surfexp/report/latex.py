"""A table as LaTeX with booktabs: numbers in mathematics, units and good directions in the head, the best in bold."""

from __future__ import annotations

import re
from collections.abc import Sequence

from surfexp.records.comparison import Comparison
from surfexp.records.table import Row
from surfexp.records.written_numbers import format_number, short_name
from surfexp.report.repeats import Repeats, repeats_of
from surfexp.report.words import word

SPECIAL = {character: f"\\{character}" for character in "&%$#_{}"} | {
    "\\": r"\textbackslash{}",
    "~": r"\textasciitilde{}",
    "^": r"\textasciicircum{}",
    "<": "$<$",
    ">": "$>$",
    "|": "$|$",
    "\u202f": r"\,",
    "–": "--",
    "—": "---",
    "−": "$-$",
    "∓": r"$\mp$",
    "±": r"$\pm$",
    "√": r"$\surd$",
    "∞": r"$\infty$",
    "≤": r"$\leq$",
    "≥": r"$\geq$",
    "×": r"$\times$",
    "·": r"$\cdot$",
    "²": "$^2$",
    "³": "$^3$",
    "°": r"$^\circ$",
    "₀": "$_0$",
    "₁": "$_1$",
    "₂": "$_2$",
}
GREEK = {
    "α": "alpha",
    "β": "beta",
    "γ": "gamma",
    "δ": "delta",
    "ε": "varepsilon",
    "θ": "theta",
    "λ": "lambda",
    "μ": "mu",
    "π": "pi",
    "σ": "sigma",
    "τ": "tau",
    "φ": "varphi",
    "χ": "chi",
    "ψ": "psi",
    "Δ": "Delta",
    "Φ": "Phi",
    "Ω": "Omega",
}
ARROWS = {"lower": r" $\downarrow$", "higher": r" $\uparrow$", "": ""}
WORDS = SPECIAL | {letter: f"$\\{name}$" for letter, name in GREEK.items()}


def latex_table(group: Comparison, label: str, command: str) -> str:
    r"""Return a table environment; it needs \usepackage{booktabs} and nothing else.

    Parameters
    ----------
    group : Comparison
    label : str
        Of the table, after "tab:".
    command : str
        What computes it again, for a comment at its head.
    """
    repeats = repeats_of(group)
    names, metrics = repeats.columns if repeats else group.varying, group.metric_names
    state = not repeats and any(row.state for row in group.rows)
    head = [escape(short_name(name)) for name in names]
    head += [_heading(group, name) for name in metrics] + (["state"] if state else []) + (["$n$"] if repeats else [])
    rows = _repeated_cells(repeats) if repeats else [_cells(group, row, state) for row in group.rows]
    columns = "l" * len(names) + "r" * (len(metrics) + bool(repeats)) + ("l" if state else "")
    lines = [
        f"% {' '.join(command.split())}",
        r"\begin{table}",
        r"  \centering",
        f"  \\caption{{{escape(_sentence(group))}}}",
        f"  \\label{{tab:{re.sub(r'[^A-Za-z0-9-]+', '-', label).strip('-')}}}",
        f"  \\begin{{tabular}}{{{columns}}}",
        r"    \toprule",
        f"    {_row(head)}",
        r"    \midrule",
        *(f"    {_row(cells)}" for cells in rows),
        r"    \bottomrule",
        r"  \end{tabular}",
        r"\end{table}",
    ]
    return "\n".join(lines) + "\n"


def escape(text: str) -> str:
    """Return a text as LaTeX shows it: specials escaped, Greek letters and signs as mathematics, others as they are."""
    return "".join(WORDS.get(character, character) for character in " ".join(text.split()))


def number(value: float | None) -> str:
    """Return a number as the tables show it, in mathematics, with a power of ten where there is one."""
    text = format_number(value)
    if text == "–":
        return "--"
    return f"${_power(text)}$"


def _power(text: str) -> str:
    """The inside of a formula for a number as tables show it."""
    mantissa, _, exponent = text.replace("\u202f", r"\,").replace("−", "-").replace("∞", r"\infty").partition("e")
    return f"{mantissa}\\times 10^{{{exponent}}}" if exponent else mantissa


def _sentence(group: Comparison) -> str:
    said = [group.title, group.caption.strip().rstrip(".")]
    if repeats := repeats_of(group):
        said.append(f"Mean ± standard deviation over {', '.join(short_name(name) for name in repeats.seeds)}")
    words = [text for text in said if text]
    return ". ".join(words) + ("." if len(words) > 1 else "")


def _heading(group: Comparison, name: str) -> str:
    meaning = group.meaning(name)
    unit = f" ({escape(meaning.unit)})" if meaning.unit else ""
    return escape(name.replace("_", " ")) + unit + ARROWS[meaning.better]


def _cells(group: Comparison, row: Row, state: bool) -> list[str]:
    cells = [escape(word(row.parameters.get(name, "–"))) for name in group.varying]
    for name in group.metric_names:
        text = number(row.number(name))
        cells.append(f"\\boldmath{text}" if group.is_best(row, name) else text)
    return cells + ([row.state] if state else [])


def _repeated_cells(repeats: Repeats) -> list[list[str]]:
    found = []
    for row in repeats.rows:
        cells = [escape(word(row.parameters.get(name, "–"))) for name in repeats.columns]
        for name in repeats.metrics:
            value, _, fewer = row.shown(name).partition(" (")
            parts = [_power(text) for text in value.split(" ± ")]
            cells.append("--" if value == "–" else "$" + r" \pm ".join(parts) + "$" + (fewer and f" ({fewer}"))
        found.append([*cells, f"${row.solved}$" if row.solved == row.count else f"${row.solved}$ of ${row.count}$"])
    return found


def _row(cells: Sequence[str]) -> str:
    return " & ".join(cells) + r" \\"
