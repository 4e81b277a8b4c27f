"""The kind of machine that a stage ran on: seconds of two kinds are not comparable."""

from __future__ import annotations

import os
import platform
import re
from contextlib import suppress
from functools import cache
from pathlib import Path


@cache
def machine() -> str:
    """Return the kind of processor and the number of cores; nothing that names the machine.

    Examples
    --------
    >>> machine().endswith(" cores")
    True
    """
    text = ""
    with suppress(OSError):
        text = Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace")
    kinds = re.findall(r"^model name\s*: (.*)$", text, re.MULTILINE)
    return f"{kinds[0] if kinds else platform.machine()}, {os.cpu_count()} cores"
