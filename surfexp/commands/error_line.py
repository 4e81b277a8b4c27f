"""An error as one line that fits a terminal: long values and long lists of choices are cut, and it is said."""

from __future__ import annotations

import os
import re
import sys
import traceback

from surfexp.lab.errors import StageFailure

# with "surfexp: " before it a line has at most 300
LONGEST_WORD, LONGEST_LINE = 80, 290
# the names alone: what a message says after them is its reason and stays
CHOICES = re.compile(r"((?:choose from|one of): )([^\s,;:()]+(?:, [^\s,;:()]+)+)")


def tell(error: Exception) -> int:
    """Print an expected error on stderr, a line for each of its lines, and return its exit code."""
    if os.environ.get("SURFEXP_DEBUG"):
        traceback.print_exc()
    for line in str(error).splitlines():
        print(f"surfexp: {error_line(line)}", file=sys.stderr)
    return 1 if isinstance(error, StageFailure) else 2


def error_line(text: str) -> str:
    """Return a line with the middle of long words and the end of a long list of choices left out."""
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
