"""What Hydra loads of ours: the launcher that plans a whole batch, and the folders where configurations are searched."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from hydra.core.config_search_path import ConfigSearchPath, SearchPathQuery
from hydra.core.config_store import ConfigStore
from hydra.core.utils import JobReturn, JobStatus
from hydra.plugins.launcher import Launcher
from hydra.plugins.search_path_plugin import SearchPathPlugin
from omegaconf import DictConfig

from surfexp.lab.composition.job import check_chosen, leaves_of, objective_of, plain
from surfexp.lab.composition.overrides import request_of
from surfexp.lab.digests import file_digest
from surfexp.lab.plan.plan import Plan
from surfexp.lab.plan.resolution import make_plan
from surfexp.lab.registry.catalogue import open_catalogue
from surfexp.lab.registry.folders import package_configurations, package_folder


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
            check_chosen(composed, self.loader.repository)
            jobs.append(leaves_of(plain(composed), overrides, request))
        plan = make_plan(leaf for leaves in jobs for leaf in leaves)
        type(self).action(plan)
        values = [objective_of(make_plan(leaves)) if plan.settings.objective else None for leaves in jobs]
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
