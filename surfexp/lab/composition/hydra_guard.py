"""What a configuration file may not ask of Hydra: an experiment is data, and Hydra would run what it names."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from surfexp.lab.errors import UserError

PLUGINS = ("hydra._internal.core_plugins.", "hydra_plugins.", "optuna.samplers.", "optuna.distributions.")
# settings by which Hydra imports, calls, or changes the process, and where it writes: what they are without a file
FIXED: dict[str, Any] = {
    "callbacks": None,
    "searchpath": None,
    "job.env_set": None,
    "job.chdir": None,
    "run.dir": "outputs/${now:%Y-%m-%d}/${now:%H-%M-%S}",
    "sweep.dir": "${results}/plans",
    "sweep.subdir": ".",
} | {
    f"{log}.{part}": None for log in ("job_logging", "hydra_logging") for part in ("handlers", "formatters", "filters")
}


def refuse_code(hydra: Mapping[str, Any]) -> None:
    """Refuse a `hydra` section that makes Hydra run anything but its own plugins and Optuna, or write elsewhere.

    Parameters
    ----------
    hydra : mapping
        The section as composed from files, interpolations unresolved, without what the command line says of it.

    Raises
    ------
    UserError
        Naming the setting and what to do.
    """
    for name, expected in FIXED.items():
        found: Any = hydra
        for part in name.split("."):
            found = (found or {}).get(part)
        if (found or None) != expected:
            raise _refused(name, found)
    for path, target in _targets(hydra, ""):
        if not str(target).startswith(PLUGINS):
            raise _refused(path, target)


def _targets(value: Any, path: str) -> Iterator[tuple[str, Any]]:
    for key, item in value.items() if isinstance(value, Mapping) else ():
        here = f"{path}.{key}".lstrip(".")
        if key == "_target_":
            yield here, item
        for part in item if isinstance(item, list) else [item]:
            yield from _targets(part, here)


def _refused(name: str, value: Any) -> UserError:
    return UserError(
        f"a configuration file sets hydra.{name} to {str(value)[:80]!r}, by which code could run: remove it from the file"
    )
