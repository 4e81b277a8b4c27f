"""`surfexp new`: a plugin file to start from, with its test; a stage kind with its first method; or an experiment."""

from __future__ import annotations

import keyword
import re
from collections.abc import Mapping
from importlib.resources import files
from pathlib import Path

from surfexp.commands.parser import Parser
from surfexp.lab.errors import UserError, unknown
from surfexp.lab.experiment.configuration import NAME
from surfexp.lab.registry import registry
from surfexp.lab.registry.folders import experiments
from surfexp.lab.registry.loading import load_all
from surfexp.lab.store.kinds import KINDS

INPUTS = {"surface": (), "image": ("surface",), "operator": ("surface",), "model": (), "figure": ("surface", "solver")}
ROLES = {"solver": "solution"}


def command(name: str, arguments: list[str]) -> int:
    """Write `plugins/KIND/NAME.py` and `tests/test_KIND_NAME.py` in the working folder; a kind is one plugin file too."""
    parser = Parser(
        f"surfexp {name}",
        description=__doc__,
        epilog="examples: surfexp new solver my_method, surfexp new kind thickness, surfexp new experiment noise",
    )
    parser.add_argument(
        "kind", help=f"experiment; kind, for a stage kind with its first method; or one of: {', '.join(KINDS)}"
    )
    parser.add_argument("name", help="the field's word for the method, e.g. split_bregman")
    given = parser.parse_args(arguments)
    if given.kind == "experiment":
        return _new_experiment(given.name)
    load_all(Path.cwd())
    if given.kind != "kind" and given.kind not in KINDS:
        raise unknown("stage kind", given.kind, ["experiment", "kind", *KINDS])
    if not given.name.isidentifier() or keyword.iskeyword(given.name):
        raise UserError(f"plugin name {given.name!r}: letters, digits and underscores, e.g. {'my_method'!r}")
    if (given.kind, given.name) in registry.PLUGINS:
        raise UserError(f"{given.kind}/{given.name} exists: {registry.PLUGINS[given.kind, given.name].file}")
    if given.kind == "kind" and given.name in KINDS:
        raise UserError(f"stage kind {given.name!r} exists: {KINDS[given.name].path}")
    plugin, test = Path("plugins", given.kind, f"{given.name}.py"), Path("tests", f"test_{given.kind}_{given.name}.py")
    if given.kind == "kind":
        plugin = Path("plugins", given.name, "height.py")
    for file in (plugin, test):
        if file.exists():
            raise UserError(f"{file} exists; choose another name")
    for file, text in zip((plugin, test), _texts(given.kind, given.name, plugin), strict=True):
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
        print(f"written: {file}")
    if given.kind == "solver":
        print("try it:  surfexp new experiment trial")
        print(f"         surfexp run experiment=trial operator=fem solver={given.name},newton")
    print(f"test it: python -m pytest {test}")
    return 0


def _new_experiment(name: str) -> int:
    """Write `conf/experiment/NAME.yaml`, which can be run as it is."""
    if not re.fullmatch(NAME, name):
        raise UserError(f"experiment name {name!r}: letters, digits, underscores, points and dashes, e.g. {'noise'!r}")
    if name in (known := experiments()):
        raise UserError(f"experiment {name!r} exists: {known[name]}")
    file = Path("conf", "experiment", f"{name}.yaml")
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(
        _filled("experiment", {"name": name, "title": name.replace("_", " ").capitalize()}), encoding="utf-8"
    )
    print(f"written: {file}")
    print(f"try it:  surfexp run experiment={name}")
    return 0


def _texts(kind: str, name: str, path: Path) -> tuple[str, str]:
    """The plugin file and its test."""
    title, camel = name.replace("_", " ").capitalize(), name.title().replace("_", "")
    values = {"kind": kind, "name": name, "path": path.as_posix(), "title": title, "model": camel}
    if kind == "kind":
        return _filled("kind", values | {"result": camel}), _filled("kind_test", values)
    if kind == "solver":
        return _filled("solver", values), _filled("solver_test", values)
    roles = INPUTS.get(kind, ("surface",))
    classes = sorted({KINDS[one].result for one in (*roles, kind)}, key=lambda item: item.__module__)
    signature = [f"    {ROLES.get(one, one)}: {KINDS[one].result.__name__},\n" for one in roles]
    values |= {
        "imports": "\n".join(f"from {item.__module__} import {item.__name__}" for item in classes),
        "parameters": "".join(["    *,\n", *signature] if signature else []),
        "result": KINDS[kind].result.__name__,
    }
    return _filled("plugin", values), _filled("plugin_test", values)


def _filled(template: str, values: Mapping[str, str]) -> str:
    """A file of `templates`, which works before a line of it is changed, with its names filled in."""
    text = files("surfexp.commands").joinpath("templates", f"{template}.txt").read_text(encoding="utf-8")
    return text.format_map(values)
