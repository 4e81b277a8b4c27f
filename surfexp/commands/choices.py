"""What can stand where on the command line, from files and the remembered catalogue: a shell that completes cannot wait."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

import click
from click.shell_completion import CompletionItem

if TYPE_CHECKING:
    from surfexp.lab.registry.catalogue import Catalogue


def finished(ctx: click.Context, parameter: click.Parameter, incomplete: str) -> list[str]:
    """Experiments that were planned in the results folder."""
    plans = (Path("results") / "plans").glob("*.json")
    return _beginning(sorted({file.stem.rpartition("-")[0] for file in plans}), incomplete)


def experiment(ctx: click.Context, parameter: click.Parameter, incomplete: str) -> list[str]:
    """Experiments."""
    return _beginning(_experiments(), incomplete)


def kind(ctx: click.Context, parameter: click.Parameter, incomplete: str) -> list[str]:
    """Stage kinds."""
    return _beginning(_plugins(), incomplete)


def kind_or_experiment(ctx: click.Context, parameter: click.Parameter, incomplete: str) -> list[str]:
    """Stage kinds, and the word for all experiments."""
    return _beginning([*_plugins(), "experiment"], incomplete)


def new_kind(ctx: click.Context, parameter: click.Parameter, incomplete: str) -> list[str]:
    """What `surfexp new` writes."""
    return _beginning(["experiment", "kind", *_plugins()], incomplete)


def plugin_or_experiment(ctx: click.Context, parameter: click.Parameter, incomplete: str) -> list[str]:
    """KIND/NAME, or an experiment that begins so."""
    return [*_of_plugins(incomplete), *(_beginning(_experiments(), incomplete) if incomplete else [])]


def setting(ctx: click.Context, parameter: click.Parameter, incomplete: str) -> list[str] | list[CompletionItem[str]]:
    """experiment=NAME, KIND=PLUGIN, KIND.OPTION=VALUE; a file where nothing is known.

    Bash cuts words at = and asks for what stands behind it alone.
    """
    words = _whole(ctx.params.get("arguments") or ())
    if words and (cut := re.fullmatch(r"([^=~-][^=]*)=?", words[-1])):
        prefix = f"{cut[1]}="
        found = [text.removeprefix(prefix) for text in _settings(words[:-1], prefix + incomplete)]
    else:
        found = _settings(words, incomplete)
    return found or [CompletionItem(incomplete, type="file")]


def _whole(words: Iterable[str]) -> list[str]:
    """Words that were cut at =, in one piece again."""
    whole: list[str] = []
    for word in words:
        if word == "=" or (whole and whole[-1].endswith("=")):
            whole[-1:] = ["".join([*whole[-1:], word])]
        else:
            whole.append(word)
    return whole


def _experiments() -> list[str]:
    from surfexp.lab.registry.folders import experiments

    return sorted(experiments())


def _remembered() -> Catalogue | None:
    from surfexp.lab.registry.catalogue import remembered

    return remembered(Path.cwd())


def _of_plugins(incomplete: str) -> list[str]:
    """KIND/NAME: kinds first, the plugins of one when it is clear which."""
    plugins = {f"{kind}/": [f"{kind}/{name}" for name in names] for kind, names in _plugins().items()}
    kind, slash, _ = incomplete.partition("/")
    return _beginning(plugins.get(f"{kind}/", []), incomplete) if slash else _one_or_all(plugins, incomplete)


def _settings(before: list[str], incomplete: str) -> list[str]:
    """Candidates for experiment=NAME, KIND=PLUGIN and KIND.OPTION=VALUE; of a comma list, for its last member."""
    key, given, value = incomplete.partition("=")
    if not given:
        return _keys(before, incomplete)
    head, comma, last = value.rpartition(",")
    return [f"{key}={head}{comma}{one}" for one in _beginning(_values(before, key), last)]


def _keys(before: list[str], incomplete: str) -> list[str]:
    """Keys that begin so, and where there is one alone its values, so that no shell ends the word behind a key."""
    kind, dot, _ = incomplete.partition(".")
    keys = [f"{kind}.{option}" for option in _options(before, kind)] if dot else ["experiment", *_plugins()]
    return _one_or_all({f"{key}=": [f"{key}={one}" for one in _values(before, key)] for key in keys}, incomplete)


def _one_or_all(choices: dict[str, list[str]], incomplete: str) -> list[str]:
    fitting = _beginning(choices, incomplete)
    return choices[fitting[0]] or fitting if len(fitting) == 1 else fitting


def _values(before: list[str], key: str) -> list[str]:
    kind, dot, option = key.partition(".")
    if key == "experiment":
        return _experiments()
    return _options(before, kind).get(option, []) if dot else _plugins().get(kind, [])


def _plugins() -> dict[str, list[str]]:
    """Names of plugins by kind; of their files, as nearly all are called, while nobody has asked for the catalogue itself."""
    known = _remembered()
    if known is not None:
        return {kind: sorted(known.names(kind)) for kind in known.kinds}
    from surfexp.lab.registry.folders import plugin_files

    found: dict[str, list[str]] = {}
    for file in plugin_files(Path.cwd()):
        found.setdefault(file.parent.name, []).append(file.stem)
    return found


def _options(before: list[str], kind: str) -> dict[str, list[str]]:
    """Options of a kind with the values that they can only have: of the plugins that were chosen, else of all."""
    known = _remembered()
    chosen = [word.partition("=")[2].split(",") for word in before if word.startswith(f"{kind}=")]
    names = chosen[-1] if chosen else known.names(kind) if known else []
    return _rows(known, kind, names) if known else {}


def _rows(known: Catalogue, kind: str, names: list[str]) -> dict[str, list[str]]:
    plugins = [known.plugins[kind, name] for name in names if (kind, name) in known.plugins]
    return {row[0]: _listed(row[2]) for plugin in plugins for row in plugin.options}


def _listed(domain: str) -> list[str]:
    """The values that a domain lists: "one of ['left', 'right']", "bool"."""
    if domain == "bool":
        return ["true", "false"]
    found = re.match(r"one of (\[.*?\])", domain)
    return [str(value) for value in ast.literal_eval(found[1])] if found else []


def _beginning(names: Iterable[str], incomplete: str) -> list[str]:
    return [name for name in names if name.startswith(incomplete)]
