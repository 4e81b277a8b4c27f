"""One parser, one style: help, an unknown option and a missing argument of every command."""

from __future__ import annotations

import re

import click
import pytest

from surfexp.commands.all_commands import COMMANDS, surfexp
from surfexp.commands.command_line import main

WITHOUT_ARGUMENTS = {
    "run", "plan", "init", "list", "table", "report", "open", "ui", "clean", "verify", "schema", "doctor"
}  # fmt: skip


def command_named(name: str) -> click.Command:
    found = surfexp.get_command(click.Context(surfexp), name)
    assert found is not None
    return found


def one_line(capsys: pytest.CaptureFixture[str]) -> str:
    said = capsys.readouterr()
    assert said.out == "" and said.err.count("\n") == 1 and len(said.err) <= 300, said
    return said.err


@pytest.mark.parametrize("name", COMMANDS)
def test_help_has_one_style(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([name, "--help"]) == 0
    said = capsys.readouterr().out
    assert said.startswith(f"Usage: surfexp {name} ") and COMMANDS[name].summary in " ".join(said.split())
    examples = said.partition("Examples:")[2]
    assert f"surfexp {name}" in examples, "no example"
    assert main([name, "-h"]) == 0 and capsys.readouterr().out == said
    assert main(["help", name]) == 0 and capsys.readouterr().out == said


@pytest.mark.parametrize("name", COMMANDS)
def test_what_stands_in_the_list_of_commands_is_the_first_line_of_their_help(name: str) -> None:
    assert (command_named(name).help or "").partition("\n")[0] == COMMANDS[name].summary


@pytest.mark.parametrize("name", COMMANDS)
def test_every_option_says_what_it_is(name: str) -> None:
    for parameter in command_named(name).params:
        assert not isinstance(parameter, click.Option) or parameter.help, parameter.name


@pytest.mark.parametrize("name", COMMANDS)
def test_an_unknown_option_is_one_line_with_the_nearest(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([name, "--resluts"]) == 2
    assert "unknown option '--resluts'; " in one_line(capsys)


@pytest.mark.parametrize("name", sorted(COMMANDS.keys() - WITHOUT_ARGUMENTS))
def test_a_missing_argument_is_one_line_with_the_way_out(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([name]) == 2
    assert re.match(rf"surfexp: missing argument '.*; surfexp {name} --help", one_line(capsys))


def test_the_list_of_commands_holds_all_in_sections_and_the_exit_codes(capsys: pytest.CaptureFixture[str]) -> None:
    assert main([]) == 0
    said = capsys.readouterr().out
    assert main(["--help"]) == 0 and capsys.readouterr().out == said
    assert all(re.search(rf"^  {name} +\S", said, re.MULTILINE) for name in COMMANDS)
    assert "130" in said and max(map(len, said.splitlines())) <= 120


@pytest.mark.parametrize("arguments", [["mesh"], ["mesh", "check", "a.ply"], ["mesh", "repair", "--help"]])
def test_the_former_name_of_check_names_its_successor(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(arguments) == 2
    line = one_line(capsys)
    assert "surfexp check" in line and "surfexp repair" in line


def test_values_that_are_no_choice_are_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    for arguments in (["modes", "a.ply", "-k", "x", "--to", "b.npz"], ["fetch", "nosuch"], ["ui", "--port", "y"]):
        assert main(arguments) == 2
        assert f"surfexp {arguments[0]} --help" in one_line(capsys)
