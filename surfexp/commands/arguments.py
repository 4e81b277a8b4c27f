"""The arguments of `surfexp run` and `surfexp plan`: what they can set, and names that nothing has, before Hydra is asked."""

from __future__ import annotations

import re
from pathlib import Path

from surfexp.lab.errors import UserError, unknown
from surfexp.lab.experiment.configuration import Settings
from surfexp.lab.experiment.experiment_files import methods_named
from surfexp.lab.experiment.hydra_flags import Words, parted
from surfexp.lab.experiment.written_out import written_out
from surfexp.lab.experiment.yaml_files import read_yaml
from surfexp.lab.registry.catalogue import Catalogue, catalogue
from surfexp.lab.registry.folders import configurations, experiments

DEFAULT = "quickstart"


def choices_of_configuration() -> dict[str, list[tuple[str, str]]]:
    """Settings with their meaning, and kinds with their plugins, by heading."""
    known = catalogue(Path.cwd())
    return {
        "Settings": [(name, str(field.description)) for name, field in Settings.model_fields.items()],
        "Kinds and plugins": [(kind, ", ".join(sorted(known.names(kind)))) for kind in known.kinds],
    }


def check_arguments(arguments: list[str]) -> None:
    """Refuse an experiment, a plugin, an option, a setting or a flag that does not exist, naming the nearest one.

    It is done before Hydra is asked, whose import takes a second.
    """
    known = catalogue(Path.cwd())
    words = parted(arguments)
    for argument in words.overrides:
        key, given, value = argument.partition("=")
        head, _, option = key.lstrip("+~").partition(".")
        if head.partition("/")[0] == "hydra":
            continue
        if not given and not key.startswith("~"):
            raise UserError(f"{argument!r} sets nothing: write KEY=VALUE, +KEY=VALUE or ~KEY")
        if head not in (*known.kinds, *Settings.model_fields):
            raise unknown("configuration key", head, [*Settings.model_fields, *known.kinds])
        if head in known.kinds and option:
            _check_option(known, head, option, words)
        elif (head in known.kinds or head == "experiment") and given:
            found = experiments(words.config_dir)
            names = list(found) if head == "experiment" else [*known.names(head), *_presets(head, words.config_dir)]
            # what Hydra's grammar does not take apart is a name, or several
            for name in map(str.strip, (re.fullmatch(r"[^][(){}'\"$*?]*", value) and value.split(",")) or ()):
                if name not in names and name != "null":
                    broken = next((f" ({text})" for file, text in known.broken.items() if Path(file).stem == name), "")
                    raise UserError(f"{unknown(head, name, names)}{broken}")


def _check_option(known: Catalogue, kind: str, option: str, words: Words) -> None:
    """Refuse an option that no plugin of a kind has, naming those of the plugins that are chosen."""
    name = option.partition(".")[0]
    options = {of: {row[0] for row in item.options} for of, item in known.plugins.items()}
    if name in {"inputs", "name"}.union(*(rows for (of, _), rows in options.items() if of == kind)):
        return
    chosen = [plugin for plugin in _chosen(known, kind, words) if (kind, plugin) in options]
    thing = f"option of {'/'.join([kind, *chosen]) if len(chosen) == 1 else kind}"
    taken = set().union(
        *(rows for (of, plugin), rows in options.items() if of == kind and plugin in (chosen or [plugin]))
    )
    if taken:
        raise unknown(thing, name, taken)
    others = sorted({f"{of}.{name}" for (of, _), rows in options.items() if name in rows})
    elsewhere = f"; did you mean {' or '.join(others)}?" if others else ""
    raise UserError(f"unknown {thing} {name!r}: it has no options{elsewhere}")


def _chosen(known: Catalogue, kind: str, words: Words) -> list[str]:
    """The plugins of a kind that the command line names, else those of the experiment."""
    given = dict(text.lstrip("+").partition("=")[::2] for text in words.overrides)
    if kind in given:
        return [name.strip() for name in given[kind].split(",")]
    files = experiments(words.config_dir)
    names = [name.strip() for name in given.get("experiment", DEFAULT).split(",")]
    found = [methods_named(written_out(read_yaml(files[name])), known.kinds) for name in names if name in files]
    return [plugin for methods in found for plugin in methods.get(kind, [])]


def _presets(kind: str, config_dir: Path | None) -> list[str]:
    """Names of the configurations of a kind in all folders of configuration files."""
    return [file.stem for folder in configurations(config_dir) for file in (folder / kind).glob("*.yaml")]
