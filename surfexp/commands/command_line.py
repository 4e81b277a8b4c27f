"""The `surfexp` command: its exit codes, and one line for whatever goes wrong."""

from __future__ import annotations

import os
import sys
import threading
import traceback
from collections.abc import Sequence
from pathlib import Path

import click

from surfexp.commands import processes
from surfexp.commands.all_commands import surfexp
from surfexp.commands.click_command import mistake
from surfexp.commands.error_line import error_line, tell
from surfexp.extras import MissingExtra, missing_line, missing_module
from surfexp.lab.errors import StageFailure, UserError


def main(arguments: Sequence[str] | None = None) -> int:
    """Entry point; returns the exit code."""
    if arguments is None and (instruction := os.environ.get("_SURFEXP_COMPLETE")):
        from surfexp.commands.completion import answer

        return answer(instruction)
    given = list(sys.argv[1:] if arguments is None else arguments)
    if "--debug" in given:
        given.remove("--debug")
        os.environ["SURFEXP_DEBUG"] = "1"
    if given[:1] == ["help"]:
        given = [*given[1:], "--help"]
    if threading.current_thread() is threading.main_thread():
        processes.end_on_signals()
    try:
        with surfexp.make_context("surfexp", list(given)) as context:
            return surfexp.invoke(context) or 0
    except click.exceptions.Exit as ended:
        return ended.exit_code
    except click.ClickException as error:
        return tell(mistake(error))
    except (KeyboardInterrupt, click.Abort):
        print(processes.interrupted(), file=sys.stderr)
        return 130
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        return 0
    except (UserError, StageFailure, MissingExtra, OSError, MemoryError) as error:
        return tell(error)
    except Exception as error:
        if isinstance(error, ImportError) and (missing := missing_module(error)):
            print(f"surfexp: {missing_line(given[0], [missing])}", file=sys.stderr)
            return 2
        if os.environ.get("SURFEXP_DEBUG"):
            raise
        where = traceback.extract_tb(error.__traceback__)[-1]
        place = f"{Path(where.filename).name}:{where.lineno}"
        what = error_line(f"unexpected {type(error).__name__} in {place}: {error}")
        print(f"surfexp: {what}; --debug shows more", file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main())
