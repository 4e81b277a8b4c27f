"""`surfexp completion`: what a shell completes behind `surfexp`, by click's protocol.

The shell runs `surfexp` with what is typed in environment variables and reads candidates. Whoever waits is in the middle of a
line: nothing numerical is imported, and whatever goes wrong, no candidate is the answer and nothing is said.
"""

from __future__ import annotations

import contextlib
import io
import os
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

import click
from click.shell_completion import (
    BashComplete,
    CompletionItem,
    FishComplete,
    ShellComplete,
    ZshComplete,
    split_arg_string,
)

from surfexp.commands.click_command import run_click, shown

VARIABLE = "_SURFEXP_COMPLETE"
WORD_BREAKS = "=:"
if TYPE_CHECKING:
    Items = list[CompletionItem[str]]

BASH = """\
%(complete_func)s() {
    local IFS=$'\\n' response completion type value
    response=$(env COMP_LINE="${COMP_LINE:0:$COMP_POINT}" COMP_WORDBREAKS="$COMP_WORDBREAKS" \\
        %(complete_var)s=bash_complete "$1" 2>/dev/null)
    for completion in $response; do
        IFS=',' read -r type value <<< "$completion"
        if [[ $type == dir ]]; then
            COMPREPLY=()
            compopt -o dirnames
        elif [[ $type == file ]]; then
            COMPREPLY=()
            compopt -o default
        elif [[ $type == plain ]]; then
            [[ $value == *[=./] ]] && compopt -o nospace
            COMPREPLY+=("$value")
        fi
    done
    return 0
}

complete -o nosort -F %(complete_func)s %(prog_name)s
"""


class _WithFiles(ShellComplete):
    """Files, where a command knows nothing better: most arguments are some."""

    def get_completions(self, args: list[str], incomplete: str) -> Items:
        """Return what click finds, or the order to complete a file."""
        file = CompletionItem(incomplete, type="file")
        return super().get_completions(args, incomplete) or ([file] if args and incomplete[:1] != "-" else [])


class Bash(_WithFiles, BashComplete):
    """Bash cuts words at = and :, and replaces what stands behind the last of them: experiment=NAME is three of its words."""

    source_template = BASH

    def get_completion_args(self) -> tuple[list[str], str]:
        """Return the words before the cursor and the one at it, cut at spaces alone."""
        line = os.environ["COMP_LINE"]
        words = split_arg_string(line)[1:]
        incomplete = "" if line[-1:].isspace() or not words else words.pop()
        breaks = [mark for mark in WORD_BREAKS if mark in os.environ.get("COMP_WORDBREAKS", WORD_BREAKS)]
        self.kept = max((incomplete.rfind(mark) + 1 for mark in breaks), default=0)
        return words, incomplete

    def format_completion(self, item: CompletionItem[str]) -> str:
        """Return kind and value, without what bash keeps."""
        return f"{item.type},{item.value[self.kept :]}"


class Zsh(_WithFiles, ZshComplete):
    """As click has it."""


class Fish(_WithFiles, FishComplete):
    """As click has it."""


SHELLS: dict[str, type[ShellComplete]] = {"bash": Bash, "zsh": Zsh, "fish": Fish}


class _Commands(click.Group):
    """All commands by name; a module is imported when its command is completed, and only if it is made with click."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(_modules())

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        module, _ = _modules().get(cmd_name, ("", ""))
        return (module and _of_click(module, cmd_name)) or _stand_in(cmd_name)

    def shell_complete(self, ctx: click.Context, incomplete: str) -> Items:
        if incomplete.startswith("-"):
            return click.Command.shell_complete(self, ctx, incomplete)
        named = _modules().items()
        return [CompletionItem(name, help=help) for name, (_, help) in named if name.startswith(incomplete)]


def _modules() -> dict[str, tuple[str, str]]:
    """Module and help of every command by name."""
    from surfexp.commands.all_commands import COMMANDS

    return COMMANDS


def _of_click(module: str, name: str) -> click.Command | None:
    """The command of a module that is made with click; other modules are not imported."""
    found = find_spec(f"surfexp.commands.{module}")
    if found is None or found.origin is None or "@click.command" not in Path(found.origin).read_text(encoding="utf-8"):
        return None
    members = vars(import_module(f"surfexp.commands.{module}")).values()
    return next((item for item in members if isinstance(item, click.Command) and item.name == name), None)


def _stand_in(name: str) -> click.Command:
    """A command that takes any arguments, for those that are not made with click."""

    def complete(ctx: click.Context, parameter: click.Parameter, incomplete: str) -> list[str]:
        from surfexp.commands import choices  # needs packages of the laboratory

        return choices.arguments(name, list(ctx.params.get("arguments") or ()), incomplete)

    taken = click.Argument(["arguments"], nargs=-1, type=click.UNPROCESSED, shell_complete=complete)
    return click.Command(name, params=[taken], context_settings={"ignore_unknown_options": True})


def _root() -> click.Group:
    options = [click.Option([name], is_flag=True) for name in ("--debug", "--version")]
    return _Commands("surfexp", params=list(options))


def answer(instruction: str) -> int:
    """Print the candidates for what the environment says is typed; nothing, and no error, where that fails."""
    shell = SHELLS.get(instruction.partition("_")[0])
    with contextlib.suppress(BaseException), contextlib.redirect_stderr(io.StringIO()):
        if shell is not None:
            click.echo(shell(_root(), {}, "surfexp", VARIABLE).complete())
    return 0


@click.command(**shown("completion", 'bash   # in ~/.bashrc: eval "$(surfexp completion bash)"', "fish | source"))
@click.argument("shell", type=click.Choice(list(SHELLS)))
def completion(shell: str) -> None:
    """Print what a shell has to read once: commands, options, experiments, plugins and files are completed then.

    In ~/.zshrc: eval "$(surfexp completion zsh)", after compinit. Fish keeps it in ~/.config/fish/completions/surfexp.fish.
    """
    click.echo(SHELLS[shell](_root(), {}, "surfexp", VARIABLE).source())


def command(_: str, arguments: list[str]) -> int:
    """Run the command."""
    return run_click(completion, arguments)
