"""`surfexp completion`: what a shell completes behind `surfexp`, by click."""

from __future__ import annotations

import contextlib
import io

import click

from surfexp.commands.click_command import shown

VARIABLE = "_SURFEXP_COMPLETE"


def answer(instruction: str) -> int:
    """Print what the shell asked for in the environment; whoever waits is in the middle of a line, so no error is said."""
    from click.shell_completion import shell_complete

    from surfexp.commands.all_commands import surfexp

    with contextlib.suppress(BaseException), contextlib.redirect_stderr(io.StringIO()):
        shell_complete(surfexp, {}, "surfexp", VARIABLE, instruction)
    return 0


@click.command(**shown("completion", 'bash   # in ~/.bashrc: eval "$(surfexp completion bash)"', "fish | source"))
@click.argument("shell", type=click.Choice(["bash", "zsh", "fish"]))
def completion(shell: str) -> None:
    """Print the shell code that completes commands, options and names.

    In ~/.zshrc: eval "$(surfexp completion zsh)", after compinit. Fish keeps it in
    ~/.config/fish/completions/surfexp.fish.
    """
    from click.shell_completion import get_completion_class

    from surfexp.commands.all_commands import surfexp

    known = get_completion_class(shell)
    if known is not None:
        click.echo(known(surfexp, {}, "surfexp", VARIABLE).source())
