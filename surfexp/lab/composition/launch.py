"""From the command line or Snakemake's configuration to one plan: Hydra composes, its launcher plans a whole batch."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from hydra.core.config_search_path import ConfigSearchPath, SearchPathQuery
from hydra.core.config_store import ConfigStore
from hydra.core.override_parser.types import Override, ValueType
from hydra.core.utils import JobReturn, JobStatus
from hydra.errors import HydraException
from hydra.plugins.launcher import Launcher
from hydra.plugins.search_path_plugin import SearchPathPlugin
from omegaconf import DictConfig, OmegaConf

from surfexp.lab.composition.hydra_guard import refuse_code
from surfexp.lab.composition.overrides import SETTABLE, Request, parsed, request_of
from surfexp.lab.composition.overrides import without as without_removed
from surfexp.lab.composition.shown import shown
from surfexp.lab.digests import file_digest
from surfexp.lab.errors import UserError
from surfexp.lab.experiment.configuration import expand
from surfexp.lab.experiment.hydra_files import check_one_file
from surfexp.lab.experiment.hydra_flags import ANSWERED_BY_HYDRA, Words, parted
from surfexp.lab.experiment.interpolation import resolved
from surfexp.lab.experiment.own_data import with_datasets, without_foreign_words
from surfexp.lab.experiment.written_out import named, written_out
from surfexp.lab.plan.outcome import outcome
from surfexp.lab.plan.plan import Plan
from surfexp.lab.plan.resolution import make_plan
from surfexp.lab.registry.catalogue import open_catalogue
from surfexp.lab.registry.folders import package_configurations, package_folder
from surfexp.lab.store.kinds import KINDS


class PlanLauncher(Launcher):
    """Hydra launcher that takes the whole batch of a sweep and makes one plan of it."""

    action: Callable[[Plan], Any] = staticmethod(lambda plan: None)
    # removals of what experiments say, which Hydra would look for before it composes a job
    removed: Sequence[str] = ()

    def setup(self, *, hydra_context: Any, task_function: Any, config: DictConfig) -> None:
        """Keep Hydra's loader and the composed configuration."""
        self.loader, self.config = hydra_context.config_loader, config

    def launch(self, job_overrides: Sequence[Sequence[str]], initial_job_idx: int) -> list[JobReturn]:
        """Expand every job's variants, plan them together, act, and hand the objective back to the sweeper."""
        file_digest.cache_clear()  # a file may have been replaced since the last batch
        jobs = []
        for overrides in job_overrides:
            request = request_of([*overrides, *self.removed], self.loader.repository)
            composed = self.loader.load_sweep_config(self.config, request.rest)
            _check_chosen(composed, self.loader.repository)
            jobs.append(_leaves(_plain(composed), overrides, request))
        plan = make_plan(leaf for leaves in jobs for leaf in leaves)
        type(self).action(plan)
        values = [_objective(make_plan(leaves)) if plan.settings.objective else None for leaves in jobs]
        return [
            JobReturn(overrides, status=JobStatus.COMPLETED, _return_value=value)
            for overrides, value in zip(job_overrides, values, strict=True)
        ]


class ConfigurationFolders(SearchPathPlugin):
    """Adds `conf/` of the working folder, of plugin packages and of `--config-dir` to Hydra's search path."""

    given: Path | None = None

    def manipulate_search_path(self, search_path: ConfigSearchPath) -> None:
        """See Hydra."""
        if Path("conf").is_dir() and Path("conf").resolve() != package_folder("surfexp.conf"):
            search_path.append("working folder", f"file://{Path('conf').resolve()}")
        for folder in package_configurations():
            search_path.append(folder.parent.name, f"file://{folder}")
        known = {element.provider for element in search_path.get_path()}
        if self.given is not None and "command-line" not in known:  # where Hydra has not done so itself
            search_path.prepend("command-line", f"file://{self.given.resolve()}", SearchPathQuery(provider="schema"))


def prepare_hydra() -> None:
    """Publish all plugins and their defaults to Hydra; register the launcher and the search path."""
    from hydra.core.plugins import Plugins

    configurations = ConfigStore.instance()
    # it hands out copies of what it holds, so that Hydra, which copies it whole for each group, need not
    ConfigStore.__deepcopy__ = lambda store, memo: store  # type: ignore[attr-defined]
    for (kind, name), method in open_catalogue(Path.cwd()).plugins.items():
        configurations.store(group=kind, name=name, node={"name": name, **method.defaults}, provider="surfexp")
    sys.modules["hydra_plugins.surfexp"] = sys.modules[__name__]  # Hydra instantiates plugins of that package only.
    for extension in (PlanLauncher, ConfigurationFolders):
        extension.__module__ = "hydra_plugins.surfexp"
        Plugins.instance().register(extension)
    target = {"_target_": "hydra_plugins.surfexp.PlanLauncher"}
    configurations.store(group="hydra/launcher", name="surfexp", node=target, provider="surfexp")


def launch(arguments: Sequence[str], action: Callable[[Plan], Any]) -> None:
    """Compose what the command line says and act on its plan, or show what a flag of Hydra asks for.

    A sweep is Hydra's, in one batch or several. What a request says of stages is taken out of it before Hydra composes,
    since it wins over variants and grids.
    """
    words = parted(arguments)
    prepare_hydra()
    ConfigurationFolders.given = words.config_dir
    parsed(words.overrides)  # what cannot be read is told as it was typed
    overrides = _as_hydra_wants(words.overrides)
    if "--cfg" in words.flags:
        print(_configuration(overrides, words), end="")
        return
    if (plan := _plan_without_sweep(overrides, words)) is not None:
        action(plan)
        return
    import hydra

    PlanLauncher.action = staticmethod(action)
    read = zip(overrides, parsed(overrides), strict=True)
    PlanLauncher.removed = [text for text, item in read if item.is_delete() and not _of_hydra(item)]
    overrides = [text for text in overrides if text not in PlanLauncher.removed]
    os.environ["HYDRA_FULL_ERROR"] = "1"
    own_mode = {"--run", "--multirun", *ANSWERED_BY_HYDRA} & words.flags.keys()
    sys.argv = ["surfexp run", *([] if own_mode else ["--multirun"]), *words.typed, *overrides]

    def job(configuration: DictConfig) -> float | None:
        """Plan and do one job of a launcher that takes each by itself."""
        from hydra.core.hydra_config import HydraConfig

        overrides = [*(str(text) for text in HydraConfig.get().overrides.task), *PlanLauncher.removed]
        composed, request = _composed(overrides, words)
        plan = make_plan(_leaves(_plain(composed), overrides, request))
        action(plan)
        return _objective(plan) if plan.settings.objective else None

    try:
        hydra.main(version_base="1.3", config_path=_folder(words), config_name="config")(job)()
    except HydraException as error:
        if intervals := [item.input_line for item in parsed(overrides) if item.value_type == ValueType.INTERVAL_SWEEP]:
            way_out = "only a search takes an interval: add hydra/sweeper=optuna objective=METRIC, or give values"
            raise UserError(f"{intervals[0]}: {way_out}") from error
        raise
    except SystemExit as ended:  # after --hydra-help and --version
        if ended.code:
            raise


def _as_hydra_wants(overrides: Sequence[str]) -> list[str]:
    """Add the + that Hydra asks for where an experiment sets what the first composition does not have."""
    ours = re.compile(rf"({'|'.join(KINDS)}|resources)\.[^=]*=|({'|'.join(SETTABLE)})=|datasets\.[^=]+=")
    # a dataset takes the place of an experiment's own, where Hydra would refuse it or join the two
    words = [re.sub(r"^datasets=", "datasets._=", text) for text in overrides]
    words = [f"++{text}" if ours.match(text) else text for text in words]  # their names are checked later
    known = str(OmegaConf.load(package_folder("surfexp.conf") / "config.yaml").defaults)
    new = {kind for kind in KINDS if f"'{kind}':" not in known}
    return [f"+{text}" if text.partition("=")[0] in new else text for text in words]


def _folder(words: Words) -> str:
    given = words.flags.get("--config-path")
    return str(Path(given).resolve() if given else package_folder("surfexp.conf"))


def _composed(overrides: Sequence[str], words: Words) -> tuple[DictConfig, Request]:
    """What Hydra, which is initialised, composes of one job, with its own section, and what is left for the planner."""
    from hydra import compose
    from hydra.core.global_hydra import GlobalHydra

    loader: Any = GlobalHydra.instance().config_loader()
    request = request_of(overrides, loader.repository)
    name = words.flags.get("--config-name", "config")
    composed = compose(name, overrides=request.rest, return_hydra_config=True)
    _check_chosen(composed, loader.repository)
    return composed, request


def _check_chosen(composed: DictConfig, repository: Any) -> None:
    for group, name in composed.hydra.runtime.choices.items():
        check_one_file(f"{group}/{name}", repository)


def _checked(overrides: Sequence[str], words: Words) -> tuple[DictConfig, Request]:
    """Compose one job without what the command line says of Hydra itself: what files say of it is refused where it is code."""
    composed, request = _composed(overrides, words)
    of_hydra: Any = OmegaConf.to_container(composed.hydra, resolve=False)
    refuse_code(of_hydra)
    return composed, request


def _plan_without_sweep(overrides: Sequence[str], words: Words) -> Plan | None:
    """The plan of one job, composed once; None where Hydra is asked for more than that: a sweep, a sweeper, a launcher."""
    from hydra import initialize_config_dir

    beyond = [item.is_sweep_override() or _of_hydra(item) for item in parsed(overrides)]
    single = [text for text, more in zip(overrides, beyond, strict=True) if not more]
    with initialize_config_dir(_folder(words), version_base="1.3"):
        composed, request = _checked(single, words)
    sweeper, launcher = composed.hydra.sweeper, str(composed.hydra.launcher._target_)
    usual = sweeper._target_.endswith(".BasicSweeper") and launcher.endswith(f".{PlanLauncher.__name__}")
    if any(beyond) or words.flags.keys() & {"--run", *ANSWERED_BY_HYDRA} or sweeper.get("params") or not usual:
        return None
    return make_plan(_leaves(_plain(composed), overrides, request))


def _configuration(overrides: Sequence[str], words: Words) -> str:
    """What `--cfg` asks for."""
    from hydra import initialize_config_dir

    read = list(zip(overrides, parsed(overrides), strict=True))
    if sweeping := [text.lstrip("+") for text, item in read if item.is_sweep_override()]:
        raise UserError(f"{sweeping[0]}: --cfg shows one job; give one value")
    with initialize_config_dir(_folder(words), version_base="1.3"):
        _checked([text for text, item in read if not _of_hydra(item)], words)
        composed, request = _composed(overrides, words)
    return shown(composed, request, words.flags)


def _of_hydra(override: Override) -> bool:
    return override.key_or_group.replace("/", ".").partition(".")[0] == "hydra"


def _leaves(composed: dict[str, Any], overrides: Sequence[str], request: Request) -> list[dict[str, Any]]:
    composed = without_removed(composed, request, dotted=False)
    if request.datasets:
        composed["datasets"] = with_datasets(composed.get("datasets") or {}, request.datasets)
    composed = without_removed(written_out(composed, request.stages), request, dotted=True)
    return expand(without_foreign_words(composed, overrides), request.stages)


def _plain(composed: DictConfig) -> dict[str, Any]:
    ours = OmegaConf.masked_copy(composed, [str(key) for key in composed if key != "hydra"])
    configuration = resolved(ours)
    return named(configuration, OmegaConf.select(composed, "hydra.runtime.choices.experiment"))


def _objective(plan: Plan) -> float:
    name, results = plan.settings.objective, Path(plan.settings.results)
    metrics = [outcome(results, plan.nodes[leaf.key]).metrics for leaf in plan.leaves]
    if any(name not in found for found in metrics):
        raise UserError(f"objective {name!r} is no metric of {plan.settings.target}")
    return sum(found[str(name)] for found in metrics) / len(metrics)
