"""What an experiment's file says of its own data, and not of data that the command line puts in their place."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from surfexp.lab.errors import UserError, check_known, unknown
from surfexp.lab.experiment.dataset_files import DATASET, is_of_files, items_of_files
from surfexp.lab.experiment.hydra_files import loaded
from surfexp.lab.store.kinds import KINDS

DATA = {"surface", "image", "datasets", "variants", "grid"}
FIGURE_WORDS = {"title", "caption", "reference"}
CLAIMS_LEFT_OUT = "The experiment's claims are left out: they are about its own methods and data, as its file has them."
WORDS_LEFT_OUT = "Titles and captions of the experiment are left out with its claims: they are about its own data."


def without_foreign_words(configuration: Mapping[str, Any], overrides: Sequence[str]) -> dict[str, Any]:
    """Return a composed configuration without claims, titles and captions that `overrides` take the ground from.

    Parameters
    ----------
    configuration : mapping
        As composed from the experiment's file.
    overrides : sequence of str
        What the command line asks for, "key=value" each. One of a stage, its options, a dataset, a variant or a grid
        leaves the claims out; one of a surface, an image, a dataset, a variant, a grid, or the inputs of a stage leaves
        titles, captions and headings out too.
    """
    keys = [text.lstrip("+~").partition("=")[0] for text in overrides]
    heads = {key.replace("@", ".").partition(".")[0] for key in keys}
    if not heads & (DATA | set(KINDS) - {"figure"}):
        return dict(configuration)
    kept = {**configuration, "claims": []}
    if not heads & DATA and not any(".inputs" in key for key in keys):
        return kept | {"description": f"{configuration.get('description', '')} {CLAIMS_LEFT_OUT}".strip()}
    headings: dict[str, str] = {}
    # a method that the command line names is that of all tables
    asked = dict(text.lstrip("+~").partition("=")[::2] for text in overrides)
    variants = [_wordless(variant, headings, kept, asked) for variant in configuration.get("variants") or []]
    title = f"{configuration.get('experiment', 'experiment')}: {_data_named(overrides) or 'other data'}"
    words = {"title": title, "description": WORDS_LEFT_OUT}
    return _wordless(kept, headings, kept, asked) | words | {"variants": variants}


def _data_named(overrides: Sequence[str]) -> str:
    """The dataset, surface and image that a command line names, a file by its name: what a title says."""
    named: dict[str, str] = {}
    for text in overrides:
        key, _, value = text.lstrip("+~").partition("=")
        kind, _, option = key.partition(".")
        if value and (kind == "datasets" or (kind in ("surface", "image") and option in ("", "path"))):
            parts = [Path(part.strip("'\" ")).name for part in value.split(",")]
            words = parts[0] if len(parts) == 1 else f"{parts[0]} and {len(parts) - 1} more"
            named[kind] = named[kind] if not option and kind in named else words
    return ", ".join(named[kind] for kind in ("datasets", "image", "surface") if kind in named)


def dataset_called(name: str, repository: Any) -> dict[str, Any]:
    """Return the datasets of `datasets/NAME.yaml` among Hydra's files, by name, or one of files that are named.

    Parameters
    ----------
    name : str
        As written behind `datasets=`: of a file of datasets, or a folder, a table, a pattern of paths.
    repository
        Hydra's, of configuration files.

    Raises
    ------
    UserError
        If there is no such dataset, or no item in it.
    """
    from hydra.core.object_type import ObjectType

    from surfexp.lab.experiment.interpolation import resolved

    if found := loaded(f"datasets/{name}", repository):
        return dict(resolved(found.config))
    if is_of_files(name):
        return {DATASET: items_of_files(Path(name))}
    if repository.load_config(f"axes/{name}"):
        raise UserError(f"conf/axes/{name}.yaml is of an earlier version: surfexp upgrade conf/axes/{name}.yaml")
    known = repository.get_group_options("datasets", ObjectType.CONFIG)
    said = unknown("dataset", name, known)
    raise UserError(f"{said}; a folder, a table (.csv) or a pattern such as 'shapes/*.off' is one as well")


def with_datasets(datasets: Mapping[str, Any], given: Mapping[str, Mapping[str, Any]]) -> dict[str, Any]:
    """Return the datasets of an experiment with one's own in place of its own.

    Parameters
    ----------
    datasets : mapping
        Items by name of the dataset.
    given : mapping
        One's own by the name of the dataset that they replace, each as its file has it: items by name. Under "" the file's
        dataset replaces the one of its name, or the only one of surfaces.

    Raises
    ------
    UserError
        If the dataset is unknown, or it does not follow which one is to be replaced.
    """
    own = dict(datasets)
    for target, found in given.items():
        for name, items in found.items():
            if target:
                check_known("dataset", [target], datasets)
            own[target or _to_replace(datasets, name)] = items
    return own


def _to_replace(datasets: Mapping[str, Any], name: str) -> str:
    if name in datasets:
        return name
    of_surfaces = [known for known, items in datasets.items() if any(map(_sets_surface, items or []))]
    if not of_surfaces:
        raise UserError(
            "datasets: this experiment compares no surfaces of a dataset; set surface=file surface.path=FILE"
        )
    if len(of_surfaces) > 1:
        choice = ", ".join(f"datasets.{known}=NAME" for known in of_surfaces)
        raise UserError(f"datasets: this experiment has {len(of_surfaces)} datasets of surfaces, choose {choice}")
    return of_surfaces[0]


def _sets_surface(item: Any) -> bool:
    if not isinstance(item, Mapping):
        return False
    options = [*item, *(item.get("grid") or {}), *(item.get("repeat") or {})]
    return any(str(option).partition(".")[0] == "surface" for option in options)


def _wordless(part: Any, headings: dict[str, str], whole: Mapping[str, Any], asked: Mapping[str, str]) -> Any:
    """A part of a configuration without captions, its figures without theirs, its heading replaced by the task."""
    if not isinstance(part, Mapping):
        return part
    wordless = {key: value for key, value in part.items() if key != "caption"}
    if part.get("comparison"):
        task = _task({**part, **asked}, whole) or f"Table {len(headings) + 1}"
        twins = sum(known == task or known.startswith(f"{task}, ") for known in headings.values())
        wordless["comparison"] = headings.setdefault(part["comparison"], f"{task}, {twins + 1}" if twins else task)
    if part.get("figures"):
        wordless["figures"] = [_figure(figure) for figure in part["figures"]]
    return wordless


def _task(part: Mapping[str, Any], whole: Mapping[str, Any]) -> str:
    """What a table is about: the method at the end of its stages, or the model that solvers minimise; empty where open."""
    target = str(part.get("target") or whole.get("target") or "solver")
    kind = "model" if target == "solver" else target
    stage = part.get(kind) or whole.get(kind)
    name = stage.get("name") if isinstance(stage, Mapping) else stage
    return f"{kind.capitalize()}: {name}".replace("_", " ") if isinstance(name, str) and name.isidentifier() else ""


def _figure(figure: Any) -> Any:
    if not isinstance(figure, Mapping):
        return figure
    return {key: value for key, value in figure.items() if key not in FIGURE_WORDS}
