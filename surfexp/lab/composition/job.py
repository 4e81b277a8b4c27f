"""One job of Hydra's: composed, told apart from what is Hydra's own, and expanded to leaves."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from hydra.core.override_parser.types import Override
from omegaconf import DictConfig, OmegaConf

from surfexp.lab.composition.hydra_guard import refuse_code
from surfexp.lab.composition.overrides import Request, request_of
from surfexp.lab.composition.overrides import without as without_removed
from surfexp.lab.errors import UserError
from surfexp.lab.experiment.configuration import expand
from surfexp.lab.experiment.hydra_files import check_one_file
from surfexp.lab.experiment.hydra_flags import Words
from surfexp.lab.experiment.interpolation import resolved
from surfexp.lab.experiment.own_data import with_datasets, without_foreign_words
from surfexp.lab.experiment.written_out import named, written_out
from surfexp.lab.plan.outcome import outcome
from surfexp.lab.plan.plan import Plan


def composed_of(overrides: Sequence[str], words: Words) -> tuple[DictConfig, Request]:
    """What Hydra, which is initialised, composes of one job, with its own section, and what is left for the planner."""
    from hydra import compose
    from hydra.core.global_hydra import GlobalHydra

    loader: Any = GlobalHydra.instance().config_loader()
    request = request_of(overrides, loader.repository)
    name = words.flags.get("--config-name", "config")
    composed = compose(name, overrides=request.rest, return_hydra_config=True)
    check_chosen(composed, loader.repository)
    return composed, request


def checked(overrides: Sequence[str], words: Words) -> tuple[DictConfig, Request]:
    """Compose one job without what the command line says of Hydra itself: what files say of it is refused where it is code."""
    composed, request = composed_of(overrides, words)
    of_hydra: Any = OmegaConf.to_container(composed.hydra, resolve=False)
    refuse_code(of_hydra)
    return composed, request


def check_chosen(composed: DictConfig, repository: Any) -> None:
    """Refuse a chosen file whose name is found in two places."""
    for group, name in composed.hydra.runtime.choices.items():
        check_one_file(f"{group}/{name}", repository)


def leaves_of(composed: dict[str, Any], overrides: Sequence[str], request: Request) -> list[dict[str, Any]]:
    """Expand the variants and grids of a composed job, with what the command line says of its stages."""
    composed = without_removed(composed, request, dotted=False)
    if request.datasets:
        composed["datasets"] = with_datasets(composed.get("datasets") or {}, request.datasets)
    composed = without_removed(written_out(composed, request.stages), request, dotted=True)
    return expand(without_foreign_words(composed, overrides), request.stages)


def plain(composed: DictConfig) -> dict[str, Any]:
    """What is ours of a composed job, resolved and named."""
    ours = OmegaConf.masked_copy(composed, [str(key) for key in composed if key != "hydra"])
    configuration = resolved(ours)
    return named(configuration, OmegaConf.select(composed, "hydra.runtime.choices.experiment"))


def objective_of(plan: Plan) -> float:
    """The mean of the objective over the rows of a plan."""
    name, results = plan.settings.objective, Path(plan.settings.results)
    metrics = [outcome(results, plan.nodes[leaf.key]).metrics for leaf in plan.leaves]
    if any(name not in found for found in metrics):
        raise UserError(f"objective {name!r} is no metric of {plan.settings.target}")
    return sum(found[str(name)] for found in metrics) / len(metrics)


def belongs_to_hydra(override: Override) -> bool:
    """Whether a word of the command line sets what is Hydra's own."""
    return override.key_or_group.replace("/", ".").partition(".")[0] == "hydra"
