"""The licences of what the lock installs, and who needs those that ask for the source of what is passed on (GPL, AGPL)."""

from __future__ import annotations

import re
import sys
import tomllib
from collections.abc import Iterator
from functools import cache
from importlib.metadata import Distribution, PackageNotFoundError, distribution
from pathlib import Path

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

ROOT = Path(__file__).resolve().parents[1]
STRONG = re.compile(r"\bA?GPL|GNU (Affero )?General Public", re.IGNORECASE)
# strong copyleft that the metadata state, and why it does not reach a user
EXPLAINED = {"docutils": "public domain and BSD; GPL for an Emacs mode that its wheel does not hold"}
# strong copyleft that a wheel holds and its metadata do not state: a file of it, what marks it there, what it is
HELD = {
    "libigl": ("igl/copyleft/cgal/*.so", b"cgal", "igl.copyleft (CGAL, TetGen), GPL and AGPL, which is never imported"),
}


def main(lock: str = "requirements.lock") -> int:
    """Print what is wrong, a line each, and one line on the whole."""
    users, locked = needed_by(), list(installed(ROOT / lock))
    lines = [f"{name}: no licence in its metadata, and no file of it" for name, found in locked if not licence(found)]
    for name, found in locked:
        if is_strong(stated := licence(found)) and name not in EXPLAINED:
            wanted = ", ".join(sorted(users.get(name, {"dev"})))
            lines.append(f"{name} {found.version}: {stated!r}, wanted by {wanted}; choose one without strong copyleft")
    for name, (pattern, mark, what) in HELD.items():
        if not any(mark in path.read_bytes() for path in held(name, pattern)):
            lines.append(f"{name}: {what} is no longer in its wheel; delete its line here and in docs/security.md")
    explained = {name: what for name, (_, _, what) in HELD.items()} | EXPLAINED
    told = [f"{name} ({', '.join(sorted(users.get(name, {'dev'})))}): {why}" for name, why in explained.items()]
    print("\n".join([*lines, *told, f"licences ({len(locked)}): {len(lines)} refused"]))
    return int(bool(lines))


def installed(lock: Path) -> Iterator[tuple[str, Distribution]]:
    """Names and metadata of what a lock installs on this platform; PackageNotFoundError where one is missing."""
    for line in lock.read_text(encoding="utf-8").splitlines():
        if line[:1].isalnum():
            wanted = Requirement(line.rstrip("\\ "))
            if wanted.marker is None or wanted.marker.evaluate():
                yield canonicalize_name(wanted.name), distribution(wanted.name)


def licence(found: Distribution) -> str:
    """The licence that the metadata state, in one line: expression, classifiers, field; else a file's first words."""
    data = found.metadata
    if data.get("License-Expression"):
        return data["License-Expression"]
    classes = [item.split(" :: ")[-1] for item in data.get_all("Classifier") or [] if item.startswith("License ::")]
    field = (data.get("License") or "").strip().split("\n")[0].replace("UNKNOWN", "")
    if stated := "; ".join([*(item for item in classes if not item.endswith(("approved", "Approved"))), field]).strip(
        "; "
    ):
        return stated
    texts = [path for path in found.files or [] if re.match(r"(?i)licen[cs]e|copying", path.name)]
    return " ".join(texts[0].read_text(encoding="utf-8").split()[:12]) if texts else ""


def is_strong(stated: str) -> bool:
    """Whether every choice that a licence leaves asks for the source of what is passed on with it."""
    return all(STRONG.search(choice) and " WITH " not in choice for choice in re.split(r" OR ", stated))


def needed_by() -> dict[str, set[str]]:
    """For each distribution, who of `core` and the extras of pyproject.toml brings it."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    found: dict[str, set[str]] = {}
    for user, wanted in {"core": project["dependencies"], **project["optional-dependencies"]}.items():
        waiting, seen = [Requirement(text) for text in wanted], set[str]()
        while waiting:
            one = waiting.pop()
            key = f"{canonicalize_name(one.name)}[{','.join(sorted(one.extras))}]"
            if key in seen:
                continue
            seen.add(key)
            found.setdefault(canonicalize_name(one.name), set()).add(user)
            if one.name == "surfexp":
                waiting += [
                    Requirement(text) for extra in one.extras for text in project["optional-dependencies"][extra]
                ]
            else:
                waiting += [each for each in _requires(one.name) if _applies(each, one.extras or {""})]
    return found


def _applies(wanted: Requirement, extras: set[str]) -> bool:
    return wanted.marker is None or any(wanted.marker.evaluate({"extra": extra}) for extra in extras)


@cache
def _requires(name: str) -> list[Requirement]:
    try:
        return [Requirement(text) for text in distribution(name).requires or []]
    except PackageNotFoundError:  # an extra that is not installed here
        return []


def held(name: str, pattern: str) -> list[Path]:
    """Files of a distribution whose paths match a pattern."""
    return [Path(str(path.locate())) for path in distribution(name).files or [] if path.match(pattern)]


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
