"""`surfexp schema`: what an editor needs to complete and check the files of experiments."""

from __future__ import annotations

import json
from pathlib import Path

from surfexp.commands.parser import Parser
from surfexp.lab.registry.loading import load_all


def command(name: str, arguments: list[str]) -> int:
    """Write the JSON schema of experiments, with the plugins of this folder."""
    parser = Parser(
        f"surfexp {name}",
        description=__doc__,
        epilog="examples: surfexp schema, surfexp schema --to conf/experiment.json",
    )
    parser.add_argument("--to", type=Path, help="file; default: print it")
    given = parser.parse_args(arguments)
    from surfexp.lab.experiment.schema import schema_of
    from surfexp.lab.registry import registry

    load_all(Path.cwd())
    text = json.dumps(schema_of(registry.PLUGINS), indent=1)
    if given.to is None:
        print(text)
        return 0
    given.to.parent.mkdir(parents=True, exist_ok=True)
    given.to.write_text(text + "\n", encoding="utf-8")
    print(f"written: {given.to}; an editor finds it by a first line in the experiment's file:")
    print(f"# yaml-language-server: $schema={given.to.resolve().as_uri()}")
    return 0
