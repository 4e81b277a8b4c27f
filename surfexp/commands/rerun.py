"""`surfexp rerun`: a bundle run again, and whether the same came out."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from surfexp.commands.click_command import FileCommand, shown
from surfexp.commands.terminal import echo

LINES = 10


@click.command(**shown("rerun", "quickstart.crate.zip", "theirs.crate.zip --to again --trust", cls=FileCommand))
@click.argument("bundle", type=click.Path(path_type=Path, dir_okay=False))
@click.option(
    "--to", "folder", type=click.Path(path_type=Path, file_okay=False), help="new folder; default: beside BUNDLE"
)
@click.option("--trust", is_flag=True, help="run the code that the bundle brings, without a question")
def rerun(bundle: Path, folder: Path | None, trust: bool) -> int:
    """Run a bundle again and compare the results.

    BUNDLE is of surfexp export --bundle. It is checked whole and unpacked into a new folder, where all is computed
    again. Code that it brings runs only after a question, or with --trust.

    A row is the same where its digest is; else it is within certificates where what both results prove can be true of
    one exact number; else, where nothing is proved, within rounding up to a relative 1e-9. The exit code is 0 for all
    of these, 1 where a row or a verdict differs, and 2 where the bundle is refused. The folder keeps rerun.json.
    """
    from surfexp.commands.bundling.rerun_bundle import run_again

    def trusted(code: list[str]) -> bool:
        if trust or not sys.stdin.isatty():
            return trust
        return click.confirm(f"{bundle} brings code: {', '.join(code)}. Run it?", default=False)

    name = bundle.name.removesuffix(".zip").removesuffix(".crate")
    place = folder or bundle.with_name(f"{name}-rerun")
    found = run_again(bundle, place, trusted)
    for package, (before, now) in found["versions"].items():
        echo(f"version    {package} {now.replace('unknown', 'not installed')}, before {before}")
    others = [row for row in found["rows"] if row["state"] != "same"]
    others.sort(key=lambda row: row["state"] != "differs")
    for row in others[:LINES]:
        echo(f"{row['state']:<10} {row['stage']} {row['key'][:8]}: {row['reason']}")
    if len(others) > LINES:
        echo(f"           and {len(others) - LINES} more: rerun.json")
    changed = [(claim, before, now) for claim, before, now in found["verdicts"] if before != now]
    for claim, before, now in changed:
        echo(f"verdict    {now}, before {before}: {claim}")
    counts = ", ".join(f"{number} {state}" for state, number in found["counts"].items())
    kept = (
        f"; {len(found['verdicts']) - len(changed)} of {len(found['verdicts'])} verdicts the same"
        if found["verdicts"]
        else ""
    )
    echo(f"{len(found['rows'])} rows: {counts}{kept}; see {place / 'rerun.json'}")
    return 1 if changed or "differs" in found["counts"] else 0
