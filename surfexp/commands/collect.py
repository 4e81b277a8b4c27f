"""`surfexp collect`: an axis of your own surfaces, each read once, for experiments on collections."""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Mapping
from pathlib import Path

import yaml
from rich.console import Console
from rich.progress import track

from surfexp.commands.parser import Parser
from surfexp.lab.errors import UserError
from surfexp.lab.experiment.collections import (
    AXIS,
    CLASS_OF_NAME,
    PATTERNS,
    Member,
    collection_of_files,
    name_of_collection,
    unused_columns,
)
from surfexp.lab.registry import registry
from surfexp.lab.registry.catalogue import open_catalogue

EXAMPLES = """\
examples:
  surfexp collect tosca --surface tosca --to tosca
  surfexp run experiment=tosca_classification axes=tosca
  surfexp collect people.csv                     # columns path, class, group
  surfexp collect subjects --pattern '*/surf/?h.pial' --group '(?P<owner>[^/]+)/surf/(?P<class>.h)' --to people

The axis is conf/axes/NAME.yaml in the working folder. Each member has a class, which classifiers tell apart, and a group, the
owner, on which they never train when they judge it. Without an owner in the regular expression each file is one of its own.
A table has the column path, from its own folder, and if wanted class, group, level, label and surface.OPTION. A folder, table
or pattern can stand behind axes= as it is; then nothing is read beforehand, and what cannot be read stops the run."""


def command(name: str, arguments: list[str]) -> int:
    """Read every surface below a folder and write those that can be read as an axis; list the others with the reason."""
    parser = Parser(
        f"surfexp {name}",
        description=command.__doc__,
        epilog=EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("source", type=Path, help="folder, table (.csv, .tsv), or pattern such as 'shapes/*.off'")
    parser.add_argument("--pattern", action="append", help=f"of paths below the folder; default: {' '.join(PATTERNS)}")
    parser.add_argument(
        "--group", default=CLASS_OF_NAME, help="regular expression with (?P<class>...), (?P<owner>...), (?P<detail>...)"
    )
    parser.add_argument("--surface", default="file", help="plugin that reads a path; tosca repairs what is defective")
    parser.add_argument("--axis", default=AXIS, help="name of the axis that the experiment asks for; default: shapes")
    parser.add_argument("--to", help="name of the collection; default: that of the folder or table")
    parser.add_argument("--force", action="store_true", help="replace a collection of that name")
    given = parser.parse_args(arguments)
    name = given.to or name_of_collection(given.source)
    target = Path("conf", "axes", f"{name}.yaml")
    if target.exists() and not given.force:
        raise UserError(f"{target} exists; --force replaces it, --to chooses another name")
    known = collection_of_files(given.source, given.pattern or PATTERNS, given.group, given.surface)
    members, refused = _readable(known, given.surface)
    if given.source.is_file() and (unused := unused_columns(given.source)):
        print(f"columns that say nothing here: {', '.join(unused)}")
    counts = Counter(str(member.get("class", "no class")) for member in members.values())
    _report(f"{len(members)} of {len(known)} files are members", counts, refused)
    if len(members) < 2:
        raise UserError(f"{given.source}: {len(members)} surfaces can be read, a collection needs at least 2")
    target.parent.mkdir(parents=True, exist_ok=True)
    left_out = "".join(f"# left out: {file.name}: {reason}\n" for file, reason in refused.items())
    target.write_text(left_out + yaml.safe_dump({given.axis: members}, sort_keys=False, allow_unicode=True, width=1000))
    print(f"written: {target}; use it with axes={target.stem}")
    return 0


def _readable(members: Mapping[str, Member], plugin: str) -> tuple[dict[str, Member], dict[Path, str]]:
    """Read each surface as a run will; return the members that are good, and the other files with one line why."""
    open_catalogue(Path.cwd())
    method = registry.plugin("surface", plugin)
    if "path" not in method.options.model_fields:
        raise UserError(f"surface {plugin!r} reads no path; choose file or tosca")
    readable, refused = {}, {}
    terminal = Console(stderr=True)
    shown = track(members.items(), "reading", console=terminal, transient=True, disable=not terminal.is_terminal)
    for label, member in shown:
        options = {key: value for key, value in member["surface"].items() if key != "name"}
        try:
            method.function(method.options(**options))
            readable[label] = member
        except (ValueError, OSError) as error:
            refused[Path(options["path"])] = " ".join(str(error).split())
    return readable, refused


def _report(heading: str, counts: Counter[str], refused: dict[Path, str]) -> None:
    classes = ", ".join(f"{name} {count}" for name, count in counts.items())
    print(f"{heading}: {classes or 'none'}")
    for file, reason in refused.items():
        print(f"left out: {file.name}: {reason}")
