"""What `--cfg` shows: the configuration of one job, with what the command line says of stages in it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from omegaconf import DictConfig, OmegaConf

from surfexp.lab.composition.overrides import Request, without
from surfexp.lab.errors import UserError
from surfexp.lab.experiment.configuration import assign
from surfexp.lab.experiment.own_data import with_datasets
from surfexp.lab.experiment.written_out import named, written_out


def shown(composed: DictConfig, request: Request, flags: Mapping[str, str]) -> str:
    """Return a configuration as YAML.

    Parameters
    ----------
    composed : DictConfig
        By Hydra, with its own section.
    request : Request
        What is not in it, since Hydra does not compose it.
    flags : mapping of str to str
        `--cfg` with job, hydra or all; `--package` and `--resolve` where they are given.

    Raises
    ------
    UserError
        If there is no such package.
    """
    whole: Any = OmegaConf.to_container(composed, resolve=False)
    of_hydra = whole.pop("hydra")
    job = named(whole, OmegaConf.select(composed, "hydra.runtime.choices.experiment"))
    job = without(job, request, dotted=False)
    if request.datasets:
        job["datasets"] = with_datasets(job.get("datasets") or {}, request.datasets)
    if any("." in name for name in (*request.stages, *request.removed)):  # an option has one place in the long form
        job = without(written_out(job, request.stages), request, dotted=True)
    for name, value in sorted(request.stages.items(), key=lambda item: "." in item[0]):
        job = assign(job, name, value) if "." in name else {**job, name: value}
    configuration: Any = OmegaConf.create({**job, "hydra": of_hydra})
    if "--resolve" in flags:
        OmegaConf.resolve(configuration)
    parts = {"job": list(job), "hydra": ["hydra"], "all": [*job, "hydra"]}[flags["--cfg"]]
    configuration = OmegaConf.masked_copy(configuration, parts)
    if (package := flags.get("--package")) is None:
        return OmegaConf.to_yaml(configuration)
    part = OmegaConf.select(configuration, package)
    if part is None:
        raise UserError(f"--package {package}: the configuration has no {package}")
    return f"# @package {package}\n{OmegaConf.to_yaml(part) if OmegaConf.is_config(part) else part}"
