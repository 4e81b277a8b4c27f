"""`surfexp collect`: a dataset of your own surfaces, each read once, for experiments."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from surfexp.commands.click_command import shown
from surfexp.commands.terminal import echo
from surfexp.lab.errors import UserError

if TYPE_CHECKING:
    from surfexp.lab.experiment.dataset_files import Item

EXAMPLES = (
    "tosca --surface tosca --to tosca   # then: surfexp run experiment=tosca_classification datasets=tosca",
    "subjects.csv                          # columns path, class, group",
    "subjects --pattern '*/surf/?h.pial' --group '(?P<owner>[^/]+)/surf/(?P<class>.h)' --to cohort",
)


@click.command(**shown("collect", *EXAMPLES, cls=click.Command))
@click.argument("source", type=click.Path(path_type=Path))
@click.option(
    "--pattern", "patterns", multiple=True, help="of paths below the folder, repeatable; every mesh if not given"
)
@click.option("--group", help="regular expression with (?P<class>...), (?P<owner>...), (?P<detail>...)")
@click.option("--surface", default="file", help="plugin that reads a path; tosca repairs what is defective")
@click.option("--dataset", default="shapes", help="name of the dataset that the experiment asks for")
@click.option("--to", "name", help="name of the file; that of the folder or table if not given")
@click.option("--force", is_flag=True, help="replace a file of that name")
def collect(
    source: Path,
    patterns: tuple[str, ...],
    group: str | None,
    surface: str,
    dataset: str,
    name: str | None,
    force: bool,
) -> None:
    """Read your own surfaces as a dataset for experiments.

    SOURCE is a folder, a table (.csv, .tsv), or a pattern such as 'shapes/*.off'. What can be read is written as
    conf/datasets/NAME.yaml in the working folder; the other files are listed with the reason.

    Each item has a class, which classifiers tell apart, and a group, the owner, on which they never train when they
    judge it. Without an owner in the regular expression each file is one of its own. A table has the column path, from
    its own folder, and if wanted class, group, level, label and surface.OPTION. A folder, table or pattern can stand
    behind datasets= as it is; then nothing is read beforehand, and what cannot be read stops the run.
    """
    import yaml

    from surfexp.io.replacing import replacing
    from surfexp.lab.experiment.dataset_files import (
        CLASS_OF_NAME,
        PATTERNS,
        items_of_files,
        name_of_dataset,
        unused_columns,
    )

    target = Path("conf", "datasets", f"{(name or name_of_dataset(source)).removesuffix('.yaml')}.yaml")
    if target.exists() and not force:
        raise UserError(f"{target} exists; --force replaces it, --to chooses another name")
    known = items_of_files(source, list(patterns) or PATTERNS, group or CLASS_OF_NAME, surface)
    items, refused = _readable(known, surface)
    if source.is_file() and (unused := unused_columns(source)):
        echo(f"columns that say nothing here: {', '.join(unused)}")
    counts = Counter(str(item.get("class", "no class")) for item in items)
    _report(f"{len(items)} of {len(known)} files are items", counts, refused)
    if len(items) < 2:
        raise UserError(f"{source}: {len(items)} surfaces can be read, a dataset needs at least 2")
    target.parent.mkdir(parents=True, exist_ok=True)
    left_out = "".join(f"# left out: {file.name}: {reason}\n" for file, reason in refused.items())
    listed = yaml.safe_dump({dataset: items}, sort_keys=False, allow_unicode=True, width=1000)
    with replacing(target) as temporary:
        temporary.write_text(left_out + listed, encoding="utf-8")
    echo(f"written: {target}; use it with datasets={target.stem}")


def _readable(items: Sequence[Item], plugin: str) -> tuple[list[Item], dict[Path, str]]:
    """Read each surface as a run will; return the items that are good, and the other files with one line why."""
    from rich.progress import track

    from surfexp.commands.console import Console
    from surfexp.lab.registry import registry
    from surfexp.lab.registry.catalogue import open_catalogue

    open_catalogue(Path.cwd())
    method = registry.plugin("surface", plugin)
    if "path" not in method.options.model_fields:
        raise UserError(f"surface {plugin!r} reads no path; choose file or tosca")
    readable, refused = [], {}
    terminal = Console(stderr=True)
    shown = track(items, "reading", console=terminal, transient=True, disable=not terminal.is_terminal)
    for item in shown:
        options = {key: value for key, value in item["surface"].items() if key != "name"}
        try:
            method(options)
            readable.append(item)
        except (ValueError, OSError) as error:
            refused[Path(options["path"])] = " ".join(str(error).split())
    return readable, refused


def _report(heading: str, counts: Counter[str], refused: dict[Path, str]) -> None:
    classes = ", ".join(f"{name} {count}" for name, count in counts.items())
    echo(f"{heading}: {classes or 'none'}")
    for file, reason in refused.items():
        echo(f"left out: {file.name}: {reason}")
