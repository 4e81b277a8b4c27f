"""`surfexp new`: a plugin file to start from, with its test."""

from __future__ import annotations

import argparse
import keyword
from pathlib import Path

from surfexp.workflow import registry
from surfexp.workflow.errors import UserError, unknown
from surfexp.workflow.kinds import KINDS

INPUTS = {"surface": (), "image": ("surface",), "operator": ("surface",), "model": (), "figure": ("surface", "solver")}
ROLES = {"solver": "solution"}

PLUGIN = '''"""{title}."""

from pydantic import Field

{imports}
from surfexp.workflow.registry import Options, register


class {model}(Options):
    strength: float = Field(1.0, gt=0, description="say what it is, with its unit")


@register("{kind}", "{name}")
def {name}(options: {model}{parameters}) -> {result}:
    """{title}: one sentence that `surfexp list {kind}` will show."""
    raise NotImplementedError("{kind}/{name} computes nothing yet: edit {path}")
'''

TEST = '''"""Test of {kind}/{name}: replace it by an identity or an exact solution."""

from pathlib import Path

from surfexp.workflow import registry


def test_{name}_is_registered_with_documented_options() -> None:
    registry.load_file(Path({path!r}))
    options = registry.plugin("{kind}", "{name}").options
    assert all(field.description for field in options.model_fields.values())
'''


def command(name: str, arguments: list[str]) -> int:
    """Write `plugins/KIND/NAME.py` and `tests/test_KIND_NAME.py` in the working folder."""
    parser = argparse.ArgumentParser(
        f"surfexp {name}", description=__doc__, epilog="example: surfexp new solver my_method"
    )
    parser.add_argument("kind", help=f"one of: {', '.join(KINDS)}")
    parser.add_argument("name", help="the field's word for the method, e.g. split_bregman")
    given = parser.parse_args(arguments)
    registry.load_all(Path.cwd())
    if given.kind not in KINDS:
        raise unknown("stage kind", given.kind, KINDS)
    if not given.name.isidentifier() or keyword.iskeyword(given.name):
        raise UserError(f"plugin name {given.name!r}: letters, digits and underscores, e.g. {'my_method'!r}")
    if (given.kind, given.name) in registry.PLUGINS:
        raise UserError(f"{given.kind}/{given.name} exists: {registry.PLUGINS[given.kind, given.name].file}")
    plugin, test = Path("plugins", given.kind, f"{given.name}.py"), Path("tests", f"test_{given.kind}_{given.name}.py")
    for file in (plugin, test):
        if file.exists():
            raise UserError(f"{file} exists; choose another name")
    plugin.parent.mkdir(parents=True, exist_ok=True)
    test.parent.mkdir(parents=True, exist_ok=True)
    roles = INPUTS.get(given.kind, ("image", "operator", "model") if given.kind == "solver" else ("surface",))
    classes = sorted({KINDS[kind].result for kind in (*roles, given.kind)}, key=lambda item: item.__module__)
    signature = "".join(f", {ROLES.get(kind, kind)}: {KINDS[kind].result.__name__}" for kind in roles)
    values = {
        "kind": given.kind,
        "name": given.name,
        "path": str(plugin),
        "title": given.name.replace("_", " ").capitalize(),
        "model": given.name.title().replace("_", ""),
        "imports": "\n".join(f"from {item.__module__} import {item.__name__}" for item in classes),
        "parameters": f", *{signature}" if signature else "",
        "result": KINDS[given.kind].result.__name__,
    }
    plugin.write_text(PLUGIN.format(**values))
    test.write_text(TEST.format(**values))
    print(f"written: {plugin}\nwritten: {test}")
    return 0
