"""What the docstrings lack of all that `import surfexp` offers, and of the classes that it hands out, by numpydoc's rules."""

from __future__ import annotations

import inspect
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from numpydoc.validate import validate

import surfexp

# a summary; known sections in their order; every parameter with its type, in order, and no other; what is returned
CHECKS = {"GL06", "GL07", "GL08", "SS01", "SS02", "SS03", "PR01", "PR02", "PR03", "PR04", "PR10", "RT01", "YD01"}
# asked of the names of the face alone
EXAMPLES = {"EX01"}
ROOT = Path(__file__).resolve().parents[1]


def main() -> int:
    """Print one line for everything that is missing."""
    offered = [getattr(surfexp, name) for name in surfexp.__all__ if not name.startswith("__")]
    checks = {name_of(one): CHECKS | EXAMPLES for one in offered}
    for kind in handed_out(offered):
        names = [name_of(kind), *(f"{name_of(kind)}.{name}" for name in members(kind))]
        checks |= {name: CHECKS for name in names if name not in checks}
    lines = []
    for name, asked in checks.items():
        report = validate(name)
        place = f"{Path(report['file']).relative_to(ROOT)}:{report['file_line']}"
        lines += [f"{place}: {name}: {code} {message}" for code, message in report["errors"] if code in asked]
    print("\n".join([*lines, f"public names ({len(checks)}): {len(lines)} errors in docstrings"]))
    return int(bool(lines))


def handed_out(offered: list[Any]) -> dict[type, None]:
    """Classes of this project among those offered, in what functions return, and in the fields and properties of such classes."""
    waiting, found = list(offered), dict[type, None]()
    while waiting:
        one = waiting.pop()
        if not inspect.isclass(one):
            waiting += named_in(one, "return")
        elif one not in found:
            found[one] = None
            waiting += members(one).values()
            waiting += [kind for field in inspect.get_annotations(one) for kind in named_in(one, field)]
    return found


def named_in(owner: Any, annotated: str) -> Iterator[type]:
    """Classes of this project that an annotation names."""
    if annotated.startswith("_"):
        return
    known = vars(sys.modules[owner.__module__])
    for word in re.findall(r"\w+", str(inspect.get_annotations(owner).get(annotated, ""))):
        if inspect.isclass(known.get(word)) and is_ours(known[word]):
            yield known[word]


def members(kind: type) -> dict[str, Any]:
    """Functions behind the public methods and properties of a class that are written in this project."""
    found = {}
    for name, member in inspect.getmembers_static(kind):
        inner = [getattr(member, part) for part in ("fget", "func", "__func__") if hasattr(member, part)]
        function = (inner or [member])[0]
        if not name.startswith("_") and inspect.isfunction(function) and is_ours(function):
            found[name] = function
    return found


def is_ours(one: Any) -> bool:
    return str(one.__module__).startswith("surfexp.")


def name_of(one: Any) -> str:
    return f"{one.__module__}.{one.__qualname__}"


if __name__ == "__main__":
    sys.exit(main())
