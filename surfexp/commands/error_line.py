"""An error as one line that fits a terminal: long values and long lists of choices are cut, and it is said."""

from __future__ import annotations

import errno
import os
import re
import sys
import traceback

from surfexp.lab.errors import StageFailure

# with "surfexp: " before it a line has at most 300
LONGEST_WORD, LONGEST_LINE = 80, 290
# the names alone: what a message says after them is its reason and stays
CHOICES = re.compile(r"((?:choose from|one of): )([^\s,;:()]+(?:, [^\s,;:()]+)+)")
# a full disk, a quota, a limit of the size of files
FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)


def tell(error: Exception) -> int:
    """Print an expected error on stderr, a line for each of its lines, and return its exit code."""
    if os.environ.get("SURFEXP_DEBUG"):
        traceback.print_exc()
    lack = lacking(error)
    for line in (lack or _said(error)).splitlines():
        print(f"surfexp: {error_line(line)}", file=sys.stderr)
    return 1 if lack or isinstance(error, StageFailure) else 2


def _said(error: Exception) -> str:
    """What an error says; of one of the system the file and the reason, without its number."""
    if not (isinstance(error, OSError) and error.strerror and error.filename):
        return str(error)
    # a file is written in a folder of its own beside its place
    place, written, _ = str(error.filename).partition("/.writing-")
    return f"{place}{' cannot be written to' if written else ''}: {error.strerror.lower()}"


def lacking(error: BaseException) -> str:
    """Say what the machine has too little of, room for a file or memory; nothing where it is not to blame."""
    if isinstance(error, MemoryError) or (isinstance(error, OSError) and error.errno == errno.ENOMEM):
        said = next(iter(str(error).splitlines()), "")
        way_out = "raise the limit" if "ulimit" in said else "take a smaller mesh, or a machine with more"
        return f"too little memory{f' ({said})' if said else ''}: {way_out}"
    if isinstance(error, OSError) and error.errno in FULL:
        what = error.filename or "what is printed"
        return f"{what} cannot be written ({error.strerror}): free some space, then the same command again"
    return ""


def error_line(text: str) -> str:
    """Return a line with the middle of long words and the end of a long list of choices left out; control codes are shown."""
    text = "".join(sign if sign.isprintable() else ascii(sign)[1:-1] for sign in text)
    line = re.sub(rf"[^\s:;,]{{{LONGEST_WORD + 1},}}", _shortened, text)
    over = len(line) - LONGEST_LINE
    return CHOICES.sub(lambda found: found[1] + _first_names(found[2], over), line) if over > 0 else line


def _first_names(choices: str, over: int) -> str:
    names = choices.split(", ")
    kept = len(names)
    while kept > 1 and len(", ".join(names[:kept])) > len(choices) - over - len(", 1,000 more"):
        kept -= 1
    return f"{', '.join(names[:kept])}, {len(names) - kept:,} more"


def _shortened(found: re.Match[str]) -> str:
    word = found.group()
    if "/" in word or "\\" in word:  # where a file is has to be seen whole
        return word
    return f"{word[:20]}...{word[-10:]} ({len(word):,} characters)"
