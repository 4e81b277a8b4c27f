"""The arguments of `surfexp run` and `surfexp plan`: what they can set, and names that nothing has, before Hydra is asked."""

from __future__ import annotations

import re
from pathlib import Path

from surfexp.lab.errors import UserError, unknown
from surfexp.lab.experiment.configuration import Settings
from surfexp.lab.registry.catalogue import Catalogue, catalogue
from surfexp.lab.registry.folders import experiments, installed_packages, package_folder

# Hydra's own parser takes a second to import, and answers a wrong one with its whole usage.
FLAGS = frozenset(
    [
        "--help",
        "-h",
        "--hydra-help",
        "--version",
        "--cfg",
        "-c",
        "--resolve",
        "--package",
        "-p",
        "--run",
        "-r",
        "--multirun",
        "-m",
        "--shell-completion",
        "-sc",
        "--config-path",
        "-cp",
        "--config-name",
        "-cn",
        "--config-dir",
        "-cd",
        "--experimental-rerun",
        "--info",
        "-i",
    ]
)


def choices_of_configuration() -> dict[str, list[tuple[str, str]]]:
    """Settings with their meaning, and kinds with their plugins, by heading."""
    known = catalogue(Path.cwd())
    return {
        "Settings": [(name, str(field.description)) for name, field in Settings.model_fields.items()],
        "Kinds and plugins": [(kind, ", ".join(sorted(known.names(kind)))) for kind in known.kinds],
    }


def check_arguments(arguments: list[str]) -> None:
    """Refuse an experiment, a plugin, an option or a setting that does not exist, naming the nearest one."""
    known = catalogue(Path.cwd())
    for argument in arguments:
        key, given, value = argument.partition("=")
        head, _, option = key.lstrip("+~").partition(".")
        if key.startswith("--") and key not in FLAGS:
            raise unknown("option", key, sorted(FLAGS))
        if not given or argument.startswith("-") or head.startswith("hydra"):
            continue
        if head not in (*known.kinds, *Settings.model_fields):
            raise unknown("configuration key", head, [*Settings.model_fields, *known.kinds])
        if head in known.kinds and option:
            _check_option(known, head, option)
        elif head in known.kinds or head == "experiment":
            names = list(experiments()) if head == "experiment" else [*known.names(head), *_presets(head)]
            # what Hydra's grammar does not take apart is a name, or several
            for name in map(str.strip, (re.fullmatch(r"[^][(){}'\"$*?]*", value) and value.split(",")) or ()):
                if name not in names and name != "null":
                    broken = next((f" ({text})" for file, text in known.broken.items() if Path(file).stem == name), "")
                    raise UserError(f"{unknown(head, name, names)}{broken}")


def _check_option(known: Catalogue, kind: str, option: str) -> None:
    names = {row[0] for (of, _), item in known.plugins.items() if of == kind for row in item.options}
    if option.partition(".")[0] not in names | {"inputs", "name"}:
        raise unknown(f"option of {kind}", option, names)


def _presets(kind: str) -> list[str]:
    """Names of the configurations of a kind in `conf/` of the package, of plugin packages and of the working folder."""
    folders = [package_folder("surfexp.conf"), Path("conf")]
    folders += [package_folder(name).parent / "conf" for name in installed_packages()]
    return [file.stem for folder in folders for file in (folder / kind).glob("*.yaml")]
