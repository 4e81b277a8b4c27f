"""An error as one line that fits a terminal: long values and long lists of choices are cut, and it is said."""

from __future__ import annotations

import re

LONGEST_WORD, LONGEST_LINE = 80, 300
CHOICES = "choose from: "


def error_line(text: str) -> str:
    """Return a line with the middle of long words and the end of a long list of choices left out."""
    line = re.sub(rf"[^\s:;,]{{{LONGEST_WORD + 1},}}", _shortened, text)
    head, mark, choices = line.partition(CHOICES)
    if len(line) <= LONGEST_LINE or not mark:
        return line
    names = choices.split(", ")
    kept = len(names)
    while kept > 1 and len(head) + len(CHOICES) + len(", ".join(names[:kept])) > LONGEST_LINE - len(", 1,000 more"):
        kept -= 1
    return f"{head}{CHOICES}{', '.join(names[:kept])}, {len(names) - kept:,} more"


def _shortened(found: re.Match[str]) -> str:
    word = found.group()
    if "/" in word or "\\" in word:  # where a file is has to be seen whole
        return word
    return f"{word[:20]}...{word[-10:]} ({len(word):,} characters)"
