"""Names and words of others on a terminal: control codes are shown as text, the program's own pass."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pytest
from rich.table import Table

import surfexp as sx
from surfexp.commands.command_line import main
from surfexp.commands.console import Console
from surfexp.commands.terminal import plain_text

NASTY = "a\x1b[2J\x07\x9b31mb"


@pytest.mark.parametrize(
    ("said", "shown"),
    [
        ("lh.white", "lh.white"),
        ("3 mm² ± 1\n\tü\n", "3 mm² ± 1\n\tü\n"),
        ("\rmodes: 10 \x1b[K", "\rmodes: 10 \x1b[K"),
        ("a\rb", "a\\rb"),
        ("a\r\nb", "a\r\nb"),
        ("\x1b]0;title\x07", "\\x1b]0;title\\x07"),
        ("\x1b[31mred", "\\x1b[31mred"),
        ("\u202egnp.exe", "\\u202egnp.exe"),
    ],
)
def test_codes_of_others_are_written_out(said: str, shown: str) -> None:
    assert plain_text(said) == shown


@pytest.mark.parametrize(
    "words",
    [
        ["check", f"{NASTY}.ply", f"bad{NASTY}.ply"],
        ["convert", f"{NASTY}.ply", f"{NASTY}.off"],
        ["repair", f"{NASTY}.ply", "--to", f"{NASTY}.obj"],
        ["curvature", f"{NASTY}.ply", "--to", f"{NASTY}.npz"],
        ["fingerprint", "folder", "-k", "3", "--to", f"{NASTY}.csv"],
        ["collect", "folder"],
        ["doctor", "--results", NASTY],
        ["modes", f"{NASTY}.ply", "--to", f"{NASTY}.none"],
    ],
    ids=lambda words: words[0],
)
def test_no_command_prints_the_codes_of_a_name(
    working_folder: Path, words: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    ball = sx.shape("icosphere", levels=1).mesh
    Path("folder").mkdir()
    for name in (f"{NASTY}.ply", f"folder/{NASTY}.ply"):
        sx.write(name, (ball.vertices, np.r_[ball.faces, ball.faces[:2]] if words[0] == "repair" else ball.faces))
    for name in (f"bad{NASTY}.ply", f"folder/bad{NASTY}.ply"):
        Path(name).write_text("none")
    main(words)
    said = capsys.readouterr()
    assert not {"\x1b", "\x07", "\x9b"} & set(said.out + said.err)
    assert "\\x07" in said.out + said.err


def test_a_table_keeps_its_own_codes_alone() -> None:
    stream = io.StringIO()
    table = Table("name", title=NASTY)
    table.add_row(f"[bold]{NASTY}[/bold]")
    Console(file=stream, force_terminal=True, color_system="standard").print(table)
    said = stream.getvalue()
    assert "\x1b[1m" in said and "\x1b[2J" not in said and "\x07" not in said and "\\x1b[2J" in said
