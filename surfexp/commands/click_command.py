"""What every command shares: one style of help, examples below it, and one line for every mistake."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from surfexp.lab.errors import UserError, unknown

results_option = click.option(
    "--results", type=click.Path(path_type=Path, file_okay=False), default="results", help="results folder"
)


class FileCommand(click.Command):
    """A command on files of the user: a value that is refused is their mistake, told in one line."""

    def invoke(self, ctx: click.Context) -> Any:
        """See click."""
        try:
            return super().invoke(ctx)
        except ValueError as error:
            raise UserError(str(error)) from error


def shown(name: str, *arguments: str, cls: type[click.Command] = FileCommand) -> dict[str, Any]:
    """Arguments of `click.command`: its name, and one example below its help for each string of arguments."""
    lines = "\n".join(f"surfexp {name} {one}".rstrip() for one in arguments)
    return {"name": name, "cls": cls, "epilog": f"\b\nExamples:\n{lines}"}


def mistake(error: click.ClickException) -> UserError:
    """Return a mistake in the arguments as every other one: one line that names the way out."""
    context = getattr(error, "ctx", None)
    if isinstance(error, click.NoSuchOption) and context is not None:
        options = [name for parameter in context.command.get_params(context) for name in parameter.opts]
        return unknown("option", error.option_name, [name for name in options if name.startswith("-")])
    said = " ".join(error.format_message().split()).rstrip(".")
    way_out = f"; {context.command_path} --help explains it" if context is not None else ""
    return UserError(f"{said[:1].lower()}{said[1:]}{way_out}")
