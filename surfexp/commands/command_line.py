"""The `surfexp` command: takes its subcommand off and hands the rest to Hydra, or to a small function of its own."""

from __future__ import annotations

import os
import sys
import threading
import traceback
from collections.abc import Callable, Sequence
from importlib import import_module
from pathlib import Path

from surfexp import __version__
from surfexp.commands import processes
from surfexp.commands.all_commands import COMMANDS
from surfexp.commands.error_line import error_line, tell
from surfexp.extras import MissingExtra, missing_line, missing_module
from surfexp.lab.errors import StageFailure, UserError, unknown


def usage() -> str:
    """The help text of `surfexp --help`."""
    lines = [f"  {name:11} {text}" for name, (_, text) in COMMANDS.items()]
    return "\n".join(
        [
            "usage: surfexp COMMAND [ARGUMENTS]   (surfexp COMMAND --help explains one)",
            "",
            "Experiments in intrinsic surface processing, planned once, computed once, compared fairly.",
            "",
            *lines,
            "",
            "--version shows the version, --debug the traceback of an error.",
            "Exit codes: 2 a mistake in the request, 1 a failed stage, 3 a result that did not converge, 130 interrupted.",
        ]
    )


def main(arguments: Sequence[str] | None = None) -> int:
    """Entry point; returns the exit code."""
    if arguments is None and (instruction := os.environ.get("_SURFEXP_COMPLETE")):
        from surfexp.commands.completion import answer

        return answer(instruction)
    given = list(sys.argv[1:] if arguments is None else arguments)
    if "--debug" in given:
        given.remove("--debug")
        os.environ["SURFEXP_DEBUG"] = "1"
    if not given or given[0] in ("--help", "-h", "help"):
        print(usage())
        return 0
    if given[0] in ("--version", "-V"):
        print(f"surfexp {__version__}")
        return 0
    if threading.current_thread() is threading.main_thread():
        processes.end_on_signals()
    try:
        if given[0] not in COMMANDS:
            raise unknown("command", given[0], COMMANDS)
        module = import_module(f"surfexp.commands.{COMMANDS[given[0]][0]}")
        command: Callable[[str, list[str]], int | None] = module.command
        return command(given[0], given[1:]) or 0
    except KeyboardInterrupt:
        print(processes.INTERRUPTED, file=sys.stderr)
        return 130
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        return 0
    except (UserError, StageFailure, MissingExtra, OSError) as error:
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
