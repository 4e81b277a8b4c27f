"""What shells complete: click's protocol driven as they drive it, and a real bash at a terminal."""

from __future__ import annotations

import os
import pty
import select
import shutil
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from surfexp.commands import choices
from surfexp.commands.all_commands import COMMANDS
from surfexp.commands.command_line import main
from surfexp.lab.registry.catalogue import Catalogue, Described
from surfexp.lab.user_cache import Memory

HEAVY = {"numpy", "scipy", "numba", "hydra", "pydantic", "snakemake", "mlflow", "rich"}
LIMIT = 600
Shell = Callable[..., list[str]]


def described(kind: str, name: str, *options: tuple[str, str]) -> Described:
    return Described(kind, name, "", "", {}, {}, [[option, "", domain, ""] for option, domain in options], {})


PLUGINS = [
    described("solver", "primal_dual", ("tolerance", "float"), ("acceleration", "bool")),
    described("solver", "split_bregman", ("tolerance", "float"), ("inner", "int")),
    described("surface", "fsaverage5", ("hemisphere", "one of ['left', 'right']")),
    described("surface", "file", ("path", "Path")),
]
KNOWN = Catalogue(
    {(item.kind, item.name): item for item in PLUGINS}, {"surface": ("", True), "solver": ("", True)}, {}, frozenset()
)


@pytest.fixture
def shell(working_folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Shell:
    """What is printed for a line in a shell, with a small catalogue."""
    monkeypatch.setattr(choices, "_remembered", lambda: KNOWN)
    monkeypatch.setattr(sys, "argv", ["surfexp"])
    (working_folder / "results" / "plans").mkdir(parents=True)
    (working_folder / "results" / "plans" / "own_trial-0123456789.json").write_text("{}")

    def complete(line: str, name: str = "bash") -> list[str]:
        if name == "bash":  # cuts words at = as well
            line = line.replace("=", " = ").replace("=  ", "= ") if not line.endswith("=") else line.replace("=", " =")
        words = line.split(" ")
        typed = {"COMP_WORDS": line, "COMP_CWORD": str(len(words) - 1)}
        if name == "fish":
            typed["COMP_CWORD"] = words[-1]
        for variable, value in {**typed, "_SURFEXP_COMPLETE": f"{name}_complete"}.items():
            monkeypatch.setenv(variable, value)
        assert main() == 0
        printed = capsys.readouterr()
        assert printed.err == ""
        return printed.out.splitlines()

    return complete


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("surfexp mod", ["plain,modes"]),
        ("surfexp --ver", ["plain,--version"]),
        ("surfexp modes --tol", ["plain,--tolerance"]),
        ("surfexp modes lh.wh", ["file,lh.wh"]),
        ("surfexp modes a.ply --hemisphere ", ["plain,left", "plain,right"]),
        ("surfexp --debug modes a.ply --to ", ["file,"]),
        ("surfexp completion ", ["plain,bash", "plain,zsh", "plain,fish"]),
        ("surfexp run experiment=quick", ["plain,quickstart"]),
        ("surfexp run experim", None),
        ("surfexp run s", ["plain,surface=", "plain,solver="]),
        ("surfexp run sol", ["plain,solver=primal_dual", "plain,solver=split_bregman"]),
        ("surfexp plan solver=sp", ["plain,split_bregman"]),
        ("surfexp run solver=primal_dual,sp", ["plain,primal_dual,split_bregman"]),
        ("surfexp run solver=split_bregman solver.", ["plain,solver.tolerance=", "plain,solver.inner="]),
        ("surfexp run solver.acc", ["plain,solver.acceleration=true", "plain,solver.acceleration=false"]),
        ("surfexp run surface.hemisphere=r", ["plain,right"]),
        ("surfexp run surface=file surface.pa", ["plain,surface.path="]),
        ("surfexp run surface.path=me", ["file,me"]),
        ("surfexp list so", ["plain,solver"]),
        ("surfexp list exp", ["plain,experiment"]),
        ("surfexp new k", ["plain,kind"]),
        ("surfexp info sur", ["plain,surface/file", "plain,surface/fsaverage5", "plain,surface_flows"]),
        ("surfexp info rof", ["plain,rof_cup"]),
        ("surfexp cite rof", ["plain,rof_cup"]),
        ("surfexp info solver/s", ["plain,solver/split_bregman"]),
        ("surfexp table own", ["plain,own_trial"]),
        ("surfexp export ow", ["plain,own_trial"]),
        ("surfexp export own_trial --kind so", ["plain,solver"]),
        ("surfexp export own_trial --kind surface --al", ["plain,--all"]),
        ("surfexp repair me", ["file,me"]),
        ("surfexp run experiment=", None),
        ("surfexp fetch to", ["plain,tosca"]),
        ("surfexp nonsense x", [""]),
        ("surfexp nonsen", [""]),
    ],
)
def test_what_can_stand_there_is_offered(shell: Shell, line: str, expected: list[str] | None) -> None:
    found = shell(line)
    assert (
        found == expected if expected is not None else {"plain,experiment=quickstart", "plain,quickstart"} & set(found)
    )


def test_other_shells_get_whole_words_and_help(shell: Shell) -> None:
    assert shell("surfexp run experiment=quick", "fish") == ["plain,experiment=quickstart"]
    assert shell("surfexp run experiment=quick", "zsh") == ["plain", "experiment=quickstart", "_"]
    assert shell("surfexp mod", "zsh") == ["plain", "modes", COMMANDS["modes"].summary]
    assert shell("surfexp mod", "nosuch") == []


def test_without_a_catalogue_plugins_go_by_their_files(shell: Shell, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(choices, "_remembered", lambda: None)
    assert "plain,split_bregman" in shell("surfexp run solver=s")
    assert shell("surfexp run solver.tol") == ["file,solver.tol"]


def test_nothing_is_said_when_it_fails(shell: Shell, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*arguments: object) -> list[str]:
        print("lost", file=sys.stderr)
        raise SystemExit("planted")

    monkeypatch.setattr(choices, "_settings", fail)
    assert shell("surfexp run s") == []
    assert shell("surfexp 'ru") == ["plain,run"], "an open quote is no failure"


def test_nothing_heavy_is_imported_for_any_command(tmp_path: Path) -> None:
    program = f"""
import os, sys
from surfexp.commands.all_commands import COMMANDS
from surfexp.commands.completion import answer
for name in COMMANDS:
    for line in (f"surfexp {{name}} ", f"surfexp {{name}} --", f"surfexp {{name}} so"):
        os.environ["COMP_WORDS"], os.environ["COMP_CWORD"] = line, str(len(line.split(" ")) - 1)
        answer("bash_complete")
heavy = {HEAVY} & {{name.split(".")[0] for name in sys.modules}}
assert not heavy, heavy
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    for name in ("--tolerance", "--largest-component", "solver=", "--matrix-market", "experiment=bases_race"):
        assert f"plain,{name}" in done.stdout or name.startswith("experiment=")


def test_commands_are_completed_without_the_laboratory(tmp_path: Path) -> None:
    program = "import sys; sys.modules['platformdirs'] = None; from surfexp.commands.command_line import main; main()"
    for line, expected in (("surfexp mod", "plain,modes\n"), ("surfexp run sol", "")):
        typed = {"COMP_WORDS": line, "COMP_CWORD": str(len(line.split(" ")) - 1), "_SURFEXP_COMPLETE": "bash_complete"}
        command = [sys.executable, "-c", program]
        done = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path, env={**os.environ, **typed})
        assert (done.returncode, done.stderr, done.stdout) == (0, "", expected)


def test_the_scripts_are_those_of_the_shells(capsys: pytest.CaptureFixture[str]) -> None:
    for name, word in (("bash", "complete -o nosort"), ("zsh", "compdef"), ("fish", "commandline")):
        assert main(["completion", name]) == 0
        said = capsys.readouterr().out
        assert word in said and "_SURFEXP_COMPLETE" in said
    assert main(["completion", "tcsh"]) == 2 and "tcsh" in capsys.readouterr().err
    assert main(["completion", "--help"]) == 0 and capsys.readouterr().out.count("surfexp completion ") >= 3


def test_the_memory_of_the_catalogue_keeps_its_latest_states(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("surfexp.lab.user_cache.user_cache", lambda part: tmp_path / part)
    monkeypatch.setattr("surfexp.lab.user_cache.atexit.register", lambda function: function)
    for number in range(5):
        memory = Memory("states", 3)
        memory.put(f"state {number}", number)
        memory.save()
    read = Memory("states", 3)
    assert [read.get(f"state {number}") for number in range(5)] == [None, None, 2, 3, 4]


@pytest.mark.skipif(shutil.which("bash") is None, reason="needs bash")
def test_bash_completes_at_a_terminal(working_folder: Path) -> None:
    program = working_folder / "bin" / "surfexp"
    program.parent.mkdir()
    program.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m surfexp.commands.command_line "$@"\n')
    program.chmod(0o755)
    (working_folder / "mesh_of_mine.ply").touch()
    child, descriptor = pty.fork()
    if child == 0:
        os.environ |= {"PATH": f"{program.parent}:{os.environ['PATH']}", "TERM": "dumb", "PS1": "ready> "}
        os.execvp("bash", ["bash", "--norc", "--noprofile", "-i"])  # noqa: S606, a constant command in a child
    terminal = Terminal(descriptor)
    try:
        terminal.expect("ready> ")
        terminal.type('eval "$(surfexp completion bash)"; echo lo""aded\n')
        terminal.expect("loaded")
        for typed, completed in (
            ("surfexp run experiment=quickst", "experiment=quickstart "),
            ("surfexp run surface.path=mesh_of", "surface.path=mesh_of_mine.ply "),
            ("surfexp fingerp", "surfexp fingerprint "),
        ):
            terminal.expect("ready> ")
            terminal.type(f"{typed}\t")
            terminal.expect(completed)
            terminal.type("\x15\n")
    finally:
        terminal.type("\x15exit\n")
        os.close(descriptor)
        os.waitpid(child, 0)


class Terminal:
    """What a person at a terminal types and sees."""

    def __init__(self, descriptor: int) -> None:
        self.descriptor, self.shown = descriptor, ""

    def type(self, text: str) -> None:
        os.write(self.descriptor, text.encode())

    def expect(self, text: str) -> None:
        """Read on until a text is there, and go behind it."""
        end = time.monotonic() + LIMIT
        while text not in self.shown:
            assert time.monotonic() < end, f"{text!r} is not in {self.shown!r}"
            if select.select([self.descriptor], [], [], 1.0)[0]:
                self.shown += os.read(self.descriptor, 4096).decode(errors="replace")
                assert "Traceback" not in self.shown and "command not found" not in self.shown, self.shown
        self.shown = self.shown.partition(text)[2]
