"""`surfexp collect`: an axis of your own surfaces, each read once, for experiments on collections."""

from __future__ import annotations

import argparse
import re
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

import yaml
from rich.console import Console
from rich.progress import track

from surfexp.commands.parser import Parser
from surfexp.workflow import registry
from surfexp.workflow.errors import UserError

PATTERNS = ("*.off", "*.obj", "*.ply", "*.stl", "*.gii", "*.vert", "*.mat")
GROUP = r"(?P<class>[^/\d]*[^/\d_. -])[^/]*$"
EXAMPLES = """\
examples:
  surfexp collect tosca --surface tosca --to tosca
  surfexp run experiment=tosca_classification axes=tosca
  surfexp collect subjects --pattern '*/surf/?h.pial' --group '(?P<owner>[^/]+)/surf/(?P<class>.h)' --to people

The axis is conf/axes/NAME.yaml in the working folder. Each member has a class, which classifiers tell apart, and a group, the
owner, on which they never train when they judge it. Without an owner in the regular expression each file is one of its own."""


def command(name: str, arguments: list[str]) -> int:
    """Read every surface below a folder and write those that can be read as an axis; list the others with the reason."""
    parser = Parser(
        f"surfexp {name}",
        description=command.__doc__,
        epilog=EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("folder", type=Path)
    parser.add_argument("--pattern", action="append", help=f"of paths below the folder; default: {' '.join(PATTERNS)}")
    parser.add_argument(
        "--group", default=GROUP, help="regular expression with (?P<class>...), (?P<owner>...), (?P<detail>...)"
    )
    parser.add_argument("--surface", default="file", help="plugin that reads a path; tosca repairs what is defective")
    parser.add_argument(
        "--axis", default="shapes", help="name of the axis that the experiment asks for; default: shapes"
    )
    parser.add_argument("--to", help="name of the collection; default: the folder's")
    parser.add_argument("--force", action="store_true", help="replace a collection of that name")
    given = parser.parse_args(arguments)
    target = Path("conf", "axes", f"{given.to or given.folder.resolve().name}.yaml")
    if target.exists() and not given.force:
        raise UserError(f"{target} exists; --force replaces it, --to chooses another name")
    files = _files(given.folder, given.pattern or PATTERNS)
    readable, refused = _read(files, given.surface)
    members = _members(given.folder, readable, given.group, given.surface)
    counts = Counter(str(member["class"]) for member in members.values())
    _report(f"{len(members)} of {len(files)} files are members", counts, refused)
    if len(members) < 2:
        raise UserError(f"{given.folder}: {len(members)} surfaces can be read, a collection needs at least 2")
    target.parent.mkdir(parents=True, exist_ok=True)
    left_out = "".join(f"# left out: {file.name}: {reason}\n" for file, reason in refused.items())
    target.write_text(left_out + yaml.safe_dump({given.axis: members}, sort_keys=False, allow_unicode=True, width=1000))
    print(f"written: {target}; use it with axes={target.stem}")
    return 0


def _files(folder: Path, patterns: Sequence[str]) -> list[Path]:
    if not folder.is_dir():
        raise UserError(f"folder {str(folder)!r} does not exist")
    found = {file.resolve() for pattern in patterns for file in folder.rglob(pattern) if file.is_file()}
    if not found:
        raise UserError(f"no file in {str(folder)!r} is called {' or '.join(patterns)}; set --pattern")
    return sorted(found, key=lambda file: [int(x) if x.isdigit() else x for x in re.split(r"(\d+)", str(file))])


def _read(files: Sequence[Path], plugin: str) -> tuple[list[Path], dict[Path, str]]:
    """Read each file as a run will; return the good ones, and the others with one line why."""
    registry.open_catalogue(Path.cwd())
    method = registry.plugin("surface", plugin)
    if "path" not in method.options.model_fields:
        raise UserError(f"surface {plugin!r} reads no path; choose file or tosca")
    readable, refused = [], {}
    terminal = Console(stderr=True)
    for file in track(files, "reading", console=terminal, transient=True, disable=not terminal.is_terminal):
        try:
            method.function(method.options(**{"path": file}))
            readable.append(file)
        except (ValueError, OSError) as error:
            refused[file] = " ".join(str(error).split())
    return readable, refused


def _members(folder: Path, files: Sequence[Path], group: str, plugin: str) -> dict[str, dict[str, object]]:
    try:
        pattern = re.compile(group)
    except re.error as error:
        raise UserError(f"--group {group!r} is no regular expression: {error}") from None
    members: dict[str, dict[str, object]] = {}
    for file in files:
        place = file.relative_to(folder.resolve()).with_suffix("").as_posix()
        found = pattern.search(place) or pattern.search(file.relative_to(folder.resolve()).as_posix())
        named = found.groupdict() if found else {}
        if not named.get("class"):
            raise UserError(f"--group {group!r} finds no class in {place!r}; write (?P<class>...) around it")
        owner = named.get("owner") or file.stem
        label = " ".join(filter(None, [named["class"], owner, named.get("detail")]))
        if label in members:
            raise UserError(f"two files are called {label!r}; tell them apart by (?P<owner>...) or (?P<detail>...)")
        members[label] = {"class": named["class"], "group": owner, "surface": {"name": plugin, "path": str(file)}}
    return members


def _report(heading: str, counts: Counter[str], refused: dict[Path, str]) -> None:
    classes = ", ".join(f"{name} {count}" for name, count in counts.items())
    print(f"{heading}: {classes or 'none'}")
    for file, reason in refused.items():
        print(f"left out: {file.name}: {reason}")
