"""Several experiments in one command, `experiment=FIRST,SECOND`: one after the other, each with its own pages."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence

from surfexp.commands.error_line import tell
from surfexp.commands.terminal import echo
from surfexp.extras import MissingExtra
from surfexp.lab.errors import StageFailure, UserError

# the worst that happened is what the command ends with
WORST_FIRST = 1, 2, 3
# as Hydra's grammar has a list of values
CHOICE = re.compile(r"choice\((.*)\)")


def apart(arguments: Sequence[str]) -> list[list[str]]:
    """Return the arguments of each experiment that a list of names asks for; what is no such list stays as it is."""
    for place, text in enumerate(arguments):
        key, _, value = text.partition("=")
        listed = CHOICE.fullmatch(value.strip())
        names = [name.strip() for name in (listed[1] if listed else value).split(",")]
        if key == "experiment" and len(names) > 1 and all(map(_can_be_a_name, names)):
            return [
                [*arguments[:place], f"experiment={name}", *arguments[place + 1 :]] for name in dict.fromkeys(names)
            ]
    return [list(arguments)]


def _can_be_a_name(text: str) -> bool:
    from surfexp.lab.experiment.configuration import NAME

    return re.fullmatch(NAME, text) is not None


def each(run: Callable[[list[str]], int], requests: list[list[str]], check: Callable[[list[str]], None]) -> int:
    """Run all requests, also after one that failed; return the worst exit code.

    What is wrong in any of them is told before the first begins; the others run.
    """
    if len(requests) == 1:
        return run(requests[0])
    codes = {place: tell(error) for place, arguments in enumerate(requests) if (error := _mistake(check, arguments))}
    for place, arguments in enumerate(requests):
        if place in codes:
            continue
        try:
            codes[place] = run(arguments)
        except (UserError, StageFailure, MissingExtra) as error:
            codes[place] = tell(error)
    failed = [arguments for place, arguments in enumerate(requests) if codes[place] in (1, 2)]
    if failed:
        names = ", ".join(text.partition("=")[2] for arguments in failed for text in arguments if "experiment=" in text)
        echo(f"surfexp: {len(failed)} of {len(requests)} experiments did not end: {names}", err=True)
    return next((code for code in WORST_FIRST if code in codes.values()), 0)


def _mistake(check: Callable[[list[str]], None], arguments: list[str]) -> UserError | MissingExtra | None:
    try:
        check(arguments)
    except (UserError, MissingExtra) as error:
        return error
    return None
