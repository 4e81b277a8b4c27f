"""What every click command shares: examples below its help, and one line for every mistake."""

from __future__ import annotations

from typing import Any

import click


def shown(name: str, *arguments: str) -> dict[str, Any]:
    """Arguments of `click.command`: its name, and one example below its help for each string of arguments."""
    lines = "\n\n".join(f"surfexp {name} {one}" for one in arguments)
    return {"name": name, "epilog": f"Examples:\n\n{lines}"}


def run_click(command: click.Command, arguments: list[str]) -> int:
    """Run a command; whatever is wrong with its arguments or files is the user's mistake, in one line."""
    from surfexp.lab.errors import UserError

    try:
        code = command.main(arguments, prog_name=f"surfexp {command.name}", standalone_mode=False)
    except click.Abort:
        raise KeyboardInterrupt from None
    except click.ClickException as error:
        raise UserError(" ".join(error.format_message().split())) from error
    except ValueError as error:
        raise UserError(str(error)) from error
    return code if isinstance(code, int) else 0
