"""From the command line or Snakemake's configuration to one plan: Hydra composes, its launcher plans a whole batch."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from hydra.core.override_parser.types import ValueType
from hydra.errors import HydraException
from omegaconf import DictConfig, OmegaConf

from surfexp.lab.composition.hydra_plugins import ConfigurationFolders, PlanLauncher, prepare_hydra
from surfexp.lab.composition.job import belongs_to_hydra, checked, composed_of, leaves_of, objective_of, plain
from surfexp.lab.composition.overrides import SETTABLE, parsed
from surfexp.lab.composition.shown import shown
from surfexp.lab.errors import UserError
from surfexp.lab.experiment.hydra_flags import ANSWERED_BY_HYDRA, Words, parted
from surfexp.lab.plan.plan import Plan
from surfexp.lab.plan.resolution import make_plan
from surfexp.lab.registry.folders import package_folder
from surfexp.lab.store.kinds import KINDS


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
    PlanLauncher.removed = [text for text, item in read if item.is_delete() and not belongs_to_hydra(item)]
    overrides = [text for text in overrides if text not in PlanLauncher.removed]
    os.environ["HYDRA_FULL_ERROR"] = "1"
    own_mode = {"--run", "--multirun", *ANSWERED_BY_HYDRA} & words.flags.keys()
    sys.argv = ["surfexp run", *([] if own_mode else ["--multirun"]), *words.typed, *overrides]

    def job(configuration: DictConfig) -> float | None:
        """Plan and do one job of a launcher that takes each by itself."""
        from hydra.core.hydra_config import HydraConfig

        overrides = [*(str(text) for text in HydraConfig.get().overrides.task), *PlanLauncher.removed]
        composed, request = composed_of(overrides, words)
        plan = make_plan(leaves_of(plain(composed), overrides, request))
        action(plan)
        return objective_of(plan) if plan.settings.objective else None

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


def _plan_without_sweep(overrides: Sequence[str], words: Words) -> Plan | None:
    """The plan of one job, composed once; None where Hydra is asked for more than that: a sweep, a sweeper, a launcher."""
    from hydra import initialize_config_dir

    beyond = [item.is_sweep_override() or belongs_to_hydra(item) for item in parsed(overrides)]
    single = [text for text, more in zip(overrides, beyond, strict=True) if not more]
    with initialize_config_dir(_folder(words), version_base="1.3"):
        composed, request = checked(single, words)
    sweeper, launcher = composed.hydra.sweeper, str(composed.hydra.launcher._target_)
    usual = sweeper._target_.endswith(".BasicSweeper") and launcher.endswith(f".{PlanLauncher.__name__}")
    if any(beyond) or words.flags.keys() & {"--run", *ANSWERED_BY_HYDRA} or sweeper.get("params") or not usual:
        return None
    return make_plan(leaves_of(plain(composed), overrides, request))


def _configuration(overrides: Sequence[str], words: Words) -> str:
    """What `--cfg` asks for."""
    from hydra import initialize_config_dir

    read = list(zip(overrides, parsed(overrides), strict=True))
    if sweeping := [text.lstrip("+") for text, item in read if item.is_sweep_override()]:
        raise UserError(f"{sweeping[0]}: --cfg shows one job; give one value")
    with initialize_config_dir(_folder(words), version_base="1.3"):
        checked([text for text, item in read if not belongs_to_hydra(item)], words)
        composed, request = composed_of(overrides, words)
    return shown(composed, request, words.flags)
