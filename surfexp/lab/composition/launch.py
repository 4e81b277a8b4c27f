"""From the command line or Snakemake's configuration to one plan: Hydra composes, its launcher plans a whole batch."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Callable, Mapping, Sequence
from importlib.metadata import entry_points
from pathlib import Path
from typing import Any

from hydra.core.config_search_path import ConfigSearchPath
from hydra.core.config_store import ConfigStore
from hydra.core.override_parser.overrides_parser import OverridesParser
from hydra.core.utils import JobReturn, JobStatus
from hydra.plugins.launcher import Launcher
from hydra.plugins.search_path_plugin import SearchPathPlugin
from omegaconf import DictConfig, OmegaConf

from surfexp.lab.composition.hydra_guard import refuse_code
from surfexp.lab.digests import file_digest
from surfexp.lab.errors import UserError
from surfexp.lab.experiment.configuration import Settings, expand
from surfexp.lab.experiment.own_data import collection, with_collections, without_foreign_words
from surfexp.lab.experiment.written_out import named, written_out
from surfexp.lab.plan.outcome import outcome
from surfexp.lab.plan.plan import Plan
from surfexp.lab.plan.remembered_plans import place, remembered
from surfexp.lab.plan.resolution import make_plan
from surfexp.lab.registry import registry
from surfexp.lab.registry.catalogue import open_catalogue
from surfexp.lab.registry.folders import package_folder
from surfexp.lab.store.kinds import KINDS

SETTABLE = set(Settings.model_fields) - {"experiment", "results", "variants", "grid", "axes"}


class PlanLauncher(Launcher):
    """Hydra launcher that takes the whole batch of a sweep and makes one plan of it."""

    action: Callable[[Plan], Any] = staticmethod(lambda plan: None)

    def setup(self, *, hydra_context: Any, task_function: Any, config: DictConfig) -> None:
        """Keep Hydra's loader and the composed configuration."""
        self.loader, self.config = hydra_context.config_loader, config

    def launch(self, job_overrides: Sequence[Sequence[str]], initial_job_idx: int) -> list[JobReturn]:
        """Expand every job's variants, plan them together, act, and hand the objective back to the sweeper."""
        file_digest.cache_clear()  # a file may have been replaced since the last batch
        jobs = []
        for overrides in job_overrides:
            stages, collections, rest = split_overrides(overrides, self.loader.repository)
            composed = _plain(self.loader.load_sweep_config(self.config, rest))
            jobs.append(_leaves(composed, overrides, stages, collections))
        plan = make_plan(leaf for leaves in jobs for leaf in leaves)
        type(self).action(plan)
        values = [_objective(make_plan(leaves)) if plan.settings.objective else None for leaves in jobs]
        return [
            JobReturn(overrides, status=JobStatus.COMPLETED, _return_value=value)
            for overrides, value in zip(job_overrides, values, strict=True)
        ]


class ConfigurationFolders(SearchPathPlugin):
    """Adds `conf/` of the working folder and of installed plugin packages to Hydra's search path."""

    def manipulate_search_path(self, search_path: ConfigSearchPath) -> None:
        """See Hydra."""
        if Path("conf").is_dir() and Path("conf").resolve() != package_folder("surfexp.conf"):
            search_path.append("working folder", f"file://{Path('conf').resolve()}")
        for point in entry_points(group="surfexp.plugins"):
            search_path.append(point.name, f"pkg://{point.module.split('.')[0]}.conf")


def prepare_hydra() -> None:
    """Publish all plugins and their defaults to Hydra; register the launcher and the search path."""
    from hydra.core.plugins import Plugins

    configurations = ConfigStore.instance()
    for (kind, name), method in open_catalogue(Path.cwd()).plugins.items():
        configurations.store(group=kind, name=name, node={"name": name, **method.defaults}, provider="surfexp")
    sys.modules["hydra_plugins.surfexp"] = sys.modules[__name__]  # Hydra instantiates plugins of that package only.
    for extension in (PlanLauncher, ConfigurationFolders):
        extension.__module__ = "hydra_plugins.surfexp"
        Plugins.instance().register(extension)
    target = {"_target_": "hydra_plugins.surfexp.PlanLauncher"}
    configurations.store(group="hydra/launcher", name="surfexp", node=target, provider="surfexp")


def launch(arguments: Sequence[str], action: Callable[[Plan], Any]) -> None:
    """Compose what the command line says and act on its plan; a sweep is Hydra's, in one batch or several."""
    prepare_hydra()
    ours = re.compile(rf"({'|'.join(KINDS)}|resources)\.[^=]*=|({'|'.join(SETTABLE)})=|axes\.[^=]+=")
    # a collection takes the place of an experiment's own, where Hydra would refuse it or join the two
    arguments = [re.sub(r"^axes=", "axes._=", text) for text in arguments]
    arguments = [f"++{text}" if ours.match(text) else text for text in arguments]  # their names are checked later
    known = str(OmegaConf.load(package_folder("surfexp.conf") / "config.yaml").defaults)
    new = {kind for kind in KINDS if f"'{kind}':" not in known}  # of these Hydra asks for a +
    arguments = [f"+{text}" if text.partition("=")[0] in new else text for text in arguments]
    if (plan := _plan_without_sweep(arguments)) is not None:
        action(plan)
        return
    import hydra

    PlanLauncher.action = staticmethod(action)
    os.environ["HYDRA_FULL_ERROR"] = "1"
    asks = {"--hydra-help", "--info", "-i", "--cfg", "-c"} & set(arguments)
    sys.argv = ["surfexp run", *([] if asks else ["--multirun"]), *arguments]
    folder = str(package_folder("surfexp.conf"))
    hydra.main(version_base="1.3", config_path=folder, config_name="config")(lambda configuration: None)()


def _plan_without_sweep(overrides: list[str]) -> Plan | None:
    """The plan of one job, composed once; None where Hydra is asked for more than that: a sweep, a sweeper, help.

    What files say of Hydra itself is checked in any case, before Hydra acts on it.
    """
    from hydra import compose, initialize_config_dir
    from hydra.core.global_hydra import GlobalHydra

    words = [text for text in overrides if not text.startswith("-")]
    parsed = OverridesParser.create().parse_overrides(words)
    beyond = [item.is_sweep_override() or item.key_or_group.startswith("hydra") for item in parsed]
    single = [text for text, more in zip(words, beyond, strict=True) if not more]
    with initialize_config_dir(str(package_folder("surfexp.conf")), version_base="1.3"):
        loader: Any = GlobalHydra.instance().config_loader()
        stages, collections, rest = split_overrides(single, loader.repository)
        composed = compose("config", overrides=rest, return_hydra_config=True)
    of_hydra: Any = OmegaConf.to_container(composed.hydra, resolve=False)
    refuse_code(of_hydra)
    sweeper = composed.hydra.sweeper
    if len(single) < len(overrides) or sweeper.get("params") or not sweeper._target_.endswith(".BasicSweeper"):
        return None
    return make_plan(_leaves(_plain(composed), overrides, stages, collections))


def plan_for_snakemake(config: Mapping[str, Any]) -> tuple[Path, Plan]:
    """The plan composed from Snakemake's `--config experiment=NAME ...`, and its file."""
    arguments = [f"{key}={value}" for key, value in config.items()]
    if (plan := remembered(place(arguments))) is None:
        prepare_hydra()
        plan = _plan_without_sweep(arguments)
    if plan is None:
        raise UserError("Snakemake runs one configuration; a sweep is run by surfexp run")
    return plan.write(Path(plan.settings.results).resolve()), plan


def _leaves(
    composed: dict[str, Any], overrides: Sequence[str], stages: Mapping[str, Any], collections: Mapping[str, Any]
) -> list[dict[str, Any]]:
    composed = written_out(composed, stages)
    composed["axes"] = with_collections(composed.get("axes") or {}, collections)
    return expand(without_foreign_words(composed, overrides), stages)


def split_overrides(
    overrides: Sequence[str], repository: Any
) -> tuple[dict[str, Any], dict[str, dict[str, Any]], list[str]]:
    """Part what the command line says of stages, which wins over variants and grids, from the rest, which Hydra composes.

    Returns the stage overrides in order, a plugin or preset as its configuration under the kind, an option as its value
    under the dotted name; the collections of `axes=NAME` under "" and of `axes.AXIS=NAME` under AXIS; and the other
    overrides as they are.
    """
    stages: dict[str, Any] = {}
    collections: dict[str, dict[str, Any]] = {}
    rest = []
    for text, override in zip(overrides, OverridesParser.create().parse_overrides(list(overrides)), strict=True):
        key = override.key_or_group
        if re.fullmatch(r"axes(\.[^.]+)?", key) and isinstance(override.value(), str):
            collections["" if key == "axes._" else key[5:]] = collection(str(override.value()), repository)
        elif key.partition(".")[0] not in (*KINDS, *SETTABLE):
            rest.append(text)
        elif "." in key or key in SETTABLE:
            stages[key] = override.value()
        else:
            found = repository.load_config(f"{key}/{override.value()}")
            if found is None:
                raise registry.unknown_plugin(key, key, str(override.value()))
            stages[key] = _plain(found.config)
    return stages, collections, rest


def _plain(composed: DictConfig) -> dict[str, Any]:
    ours = OmegaConf.masked_copy(composed, [str(key) for key in composed if key != "hydra"])
    configuration: Any = OmegaConf.to_container(ours, resolve=True, throw_on_missing=False)
    return named(configuration, OmegaConf.select(composed, "hydra.runtime.choices.experiment"))


def _objective(plan: Plan) -> float:
    name, results = plan.settings.objective, Path(plan.settings.results)
    metrics = [outcome(results, plan.nodes[leaf.key]).metrics for leaf in plan.leaves]
    if any(name not in found for found in metrics):
        raise UserError(f"objective {name!r} is no metric of {plan.settings.target}")
    return sum(found[str(name)] for found in metrics) / len(metrics)
