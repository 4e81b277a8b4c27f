"""`surfexp new`: a plugin file to start from, with its test; a stage kind with its first method; or an experiment."""

from __future__ import annotations

import keyword
import re
from collections.abc import Mapping
from importlib.resources import files
from pathlib import Path

import click

from surfexp.commands import choices
from surfexp.commands.click_command import shown
from surfexp.commands.terminal import echo
from surfexp.lab.errors import UserError, unknown

# kinds of which a method is written that computes something, with an exact solution as its test
WHOLE = ("solver", "operator", "signature", "distance", "classifier", "figure")
INPUTS = {"surface": (), "image": ("surface",), "model": ()}
TRY = {
    "operator": "experiment=eigenfunction_gallery operator={} 'figures=[]'",
    "signature": "experiment=eigenfunction_gallery target=signature signature={} 'columns=[]' 'figures=[]' ~claims",
    "distance": "experiment=embedding_invariance distance={}",
    "classifier": "experiment=pose_classification classifier={}",
    "figure": "experiment=rof_cup 'figures=[{}]'",
}


@click.command(**shown("new", "solver my_method", "kind thickness", "experiment noise", cls=click.Command))
@click.argument("kind", shell_complete=choices.new_kind)
@click.argument("name")
def new(kind: str, name: str) -> None:
    """Write a first plugin with its test, or a first experiment.

    KIND is a stage kind (surfexp list), for a plugin of that kind; the word kind, for a stage kind with its first method;
    or the word experiment. NAME is the field's word for the method, such as split_bregman. The files are
    plugins/KIND/NAME.py and tests/test_KIND_NAME.py, or conf/experiment/NAME.yaml, in the working folder.
    """
    from surfexp.lab.registry import registry
    from surfexp.lab.registry.loading import load_all
    from surfexp.lab.store.kinds import KINDS

    if kind == "experiment":
        _new_experiment(name)
        return
    load_all(Path.cwd())
    if kind != "kind" and kind not in KINDS:
        raise unknown("stage kind", kind, ["experiment", "kind", *KINDS])
    if not name.isidentifier() or keyword.iskeyword(name):
        raise UserError(f"plugin name {name!r}: letters, digits and underscores, e.g. {'my_method'!r}")
    if (kind, name) in registry.PLUGINS:
        raise UserError(f"{kind}/{name} exists: {registry.PLUGINS[kind, name].file}")
    if kind == "kind" and name in KINDS:
        raise UserError(f"stage kind {name!r} exists: {KINDS[name].path}")
    plugin, test = Path("plugins", kind, f"{name}.py"), Path("tests", f"test_{kind}_{name}.py")
    if kind == "kind":
        plugin = Path("plugins", name, "height.py")
    for file in (plugin, test):
        if file.exists():
            raise UserError(f"{file} exists; choose another name")
    for file, text in zip((plugin, test), _texts(kind, name, plugin), strict=True):
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
        echo(f"written: {file}")
    if kind == "solver":
        echo("try it:  surfexp new experiment trial")
        echo(f"         surfexp run experiment=trial operator=fem solver={name},newton")
    elif kind in TRY:
        echo(f"try it:  surfexp run {TRY[kind].format(name)}")
    echo(f"test it: python -m pytest {test}")


def _new_experiment(name: str) -> None:
    """Write `conf/experiment/NAME.yaml`, which can be run as it is."""
    from surfexp.lab.experiment.configuration import NAME
    from surfexp.lab.registry.folders import experiments

    if not re.fullmatch(NAME, name):
        raise UserError(f"experiment name {name!r}: letters, digits, underscores, points and dashes, e.g. {'noise'!r}")
    if name in (known := experiments()):
        raise UserError(f"experiment {name!r} exists: {known[name]}")
    file = Path("conf", "experiment", f"{name}.yaml")
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(
        _filled("experiment", {"name": name, "title": name.replace("_", " ").capitalize()}), encoding="utf-8"
    )
    echo(f"written: {file}")
    echo(f"try it:  surfexp run experiment={name}")


def _texts(kind: str, name: str, path: Path) -> tuple[str, str]:
    """The plugin file and its test."""
    from surfexp.lab.store.kinds import KINDS

    title, camel = name.replace("_", " ").capitalize(), name.title().replace("_", "")
    values = {"kind": kind, "name": name, "path": path.as_posix(), "title": title, "model": camel}
    if kind == "kind":
        return _filled("kind", values | {"result": camel}), _filled("kind_test", values)
    if kind in WHOLE:
        return _filled(kind, values), _filled(f"{kind}_test", values)
    roles = INPUTS.get(kind, ("surface",))
    imports = {(KINDS[one].result.__module__, KINDS[one].result.__name__) for one in (*roles, kind)}
    imports.add(("surfexp.lab.registry.registry", "register"))
    signature = [f"    {one}: {KINDS[one].result.__name__},\n" for one in roles]
    values |= {
        "imports": "\n".join(f"from {module} import {item}" for module, item in sorted(imports)),
        "parameters": "".join(signature),
        "result": KINDS[kind].result.__name__,
    }
    return _filled("plugin", values), _filled("plugin_test", values)


def _filled(template: str, values: Mapping[str, str]) -> str:
    """A file of `templates`, which works before a line of it is changed, with its names filled in."""
    text = files("surfexp.commands").joinpath("templates", f"{template}.txt").read_text(encoding="utf-8")
    return text.format_map(values)
