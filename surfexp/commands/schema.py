"""`surfexp schema`: what an editor needs to complete and check the files of experiments."""

from __future__ import annotations

import json
from pathlib import Path

import click

from surfexp.commands.click_command import shown
from surfexp.commands.terminal import echo


@click.command(**shown("schema", "", "--to conf/experiment.json", cls=click.Command))
@click.option("--to", "target", type=click.Path(path_type=Path), help="file; printed if not given")
def schema(target: Path | None) -> None:
    """Write the JSON schema with which an editor completes experiments.

    It holds the plugins of the folder you work in.
    """
    from surfexp.io.replacing import replacing
    from surfexp.lab.experiment.schema import schema_of
    from surfexp.lab.registry import registry
    from surfexp.lab.registry.loading import load_all

    load_all(Path.cwd())
    text = json.dumps(schema_of(registry.PLUGINS), indent=1)
    if target is None:
        echo(text)
        return
    target.parent.mkdir(parents=True, exist_ok=True)
    with replacing(target) as temporary:
        temporary.write_text(text + "\n", encoding="utf-8")
    echo(f"written: {target}; an editor finds it by a first line in the experiment's file:")
    echo(f"# yaml-language-server: $schema={target.resolve().as_uri()}")
