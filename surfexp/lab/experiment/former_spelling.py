"""Experiments as earlier versions wrote them, in the present spelling: one function for files, results and refusals.

What has no former spelling in it is returned as the same object, so that a caller sees what has changed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any

from surfexp.lab.errors import UserError
from surfexp.lab.experiment.claim import NOT_COMPARABLE, PLACES
from surfexp.lab.store.kinds import KINDS

Known = Callable[[str, str], bool]
SUMMARIES = ("all", "any", "mean", "min", "max", "ratio")
AS_STATED = "as stated"
WAY_OUT = "`surfexp upgrade FILE` rewrites a file"
WEIGHTED = {"rof", "vectorial_rof", "tgv", "inpainting", "deblurring", "normal_filtering"}  # `w` is `weight`
# beside the summary, in the order in which a claim is read
ORDER = ("claim", "published", "quantity", "rows", "between", "because", "unconverged", "moved", "otherwise", "cause")


def present(document: Any, known: Known = lambda kind, name: True) -> Any:
    """Return an experiment, or a part of one, in the present spelling.

    Parameters
    ----------
    document : object
        As YAML is read. Mappings and lists may be subclasses that carry where they stand; they are made anew by
        `rebuilt`, and an alias is a leaf with a `target`.
    known : callable
        Whether a plugin of that kind and name is known. {NAME: {OPTION: VALUE}} is a former stage only where it is.

    Returns
    -------
    object
        The same object where nothing in it has another spelling.

    Examples
    --------
    >>> present({"surface": {"cup": {"vertices": 4000}}, "axes": {"cups": {"small": {"surface": {"scale": 0.5}}}}})
    {'surface': {'name': 'cup', 'vertices': 4000}, 'datasets': {'cups': [{'label': 'small', 'surface': {'scale': 0.5}}]}}
    """
    if not isinstance(document, Mapping):
        return document
    return rebuilt(document, [_entry(key, value, known) for key, value in document.items()])


def present_dataset_file(document: Any) -> Any:
    """Return the content of a file of datasets, by name, in the present spelling."""
    if not isinstance(document, Mapping):
        return document
    return rebuilt(document, [(name, _dataset(items, lambda kind, plugin: True)) for name, items in document.items()])


def present_settings(settings: Mapping[str, Any]) -> dict[str, Any]:
    """Return the settings of a plan as an earlier version wrote it, in the present spelling."""
    return dict(present(settings))


def refuse_former_spelling(document: Any, known: Known) -> None:
    """Refuse what an earlier version would have read; UserError says how it is written now."""
    if (now := present(document, known)) is not document:
        where, old, new = next(differences(document, now, "the experiment"))
        raise UserError(f"{where}: {_shown(old)} is written {_shown(new)} now; {WAY_OUT}")


def differences(old: Any, new: Any, where: str) -> Iterator[tuple[str, Any, Any]]:
    """Yield the innermost places in which two documents differ: where, the old and the new entry."""
    if old is new:
        return
    if isinstance(old, Mapping) and isinstance(new, Mapping) and len(old) == len(new):
        for (key, before), (name, after) in zip(old.items(), new.items(), strict=True):
            if key != name:
                yield where, {key: before}, {name: after}
            yield from differences(before, after, str(key))
    elif isinstance(old, list) and isinstance(new, list) and len(old) == len(new):
        for number, (before, after) in enumerate(zip(old, new, strict=True), 1):
            yield from differences(before, after, f"{where} {number}")
    else:
        yield where, old, new


def rebuilt(old: Any, content: Any) -> Any:
    """Return a mapping or list of that content, of the class and anchor of the old one, or the old one if nothing changed."""
    if isinstance(old, Mapping):
        copied: Any = type(old)
        new = copied(content)
        same = len(new) == len(old) and all(a == b and old[a] is new[b] for a, b in zip(old, new, strict=True))
    else:
        new = type(old)(content)
        same = len(new) == len(old) and all(a is b for a, b in zip(old, new, strict=True))
    if same:
        return old
    if hasattr(old, "anchor"):
        new.anchor = old.anchor
    return new


def _entry(key: Any, value: Any, known: Known) -> tuple[Any, Any]:
    if key in KINDS:
        return key, _stage(key, value, known)
    if key == "figures" and isinstance(value, list):
        return key, rebuilt(value, [_figure(item, known) for item in value])
    if key == "variants" and isinstance(value, list):
        return key, rebuilt(value, [present(item, known) for item in value])
    if key == "parts" and isinstance(value, Mapping):
        return key, rebuilt(value, [(name, present(part, known)) for name, part in value.items()])
    if key == "grid" and isinstance(value, Mapping):
        return key, rebuilt(value, [(option, _values(option, values, known)) for option, values in value.items()])
    if key in ("axes", "datasets") and isinstance(value, Mapping):
        items = [(name, _dataset(items, known)) for name, items in value.items()]
        return "datasets" if key == "axes" else key, rebuilt(value, items)
    if key == "claims" and isinstance(value, list):
        return key, rebuilt(value, [_claim(item) for item in value])
    if key == "defaults" and isinstance(value, list):
        return key, rebuilt(value, [_default(item) for item in value])
    return key, value


def _values(option: str, values: Any, known: Known) -> Any:
    if option not in KINDS or not isinstance(values, list):
        return values
    return rebuilt(values, [_stage(option, item, known) for item in values])


def _default(item: Any) -> Any:
    if not isinstance(item, Mapping):
        return item
    renamed = [(str(key).replace("/axes", "/datasets") if "/axes" in key else key, item[key]) for key in item]
    return rebuilt(item, renamed)


def _figure(value: Any, known: Known) -> Any:
    if isinstance(value, Mapping) and "sweep" in value and "against" in value:
        words = {key: item for key, item in value.items() if key != "sweep"}
        return rebuilt(value, {"name": "sweep", "metric": value["sweep"], **words})
    return _stage("figure", value, known)


def _stage(kind: str, value: Any, known: Known) -> Any:
    """{PLUGIN: {OPTION: VALUE}} is {name: PLUGIN, OPTION: VALUE}; an input {over: AXIS} is {dataset: NAME}; the weight was `w`."""
    if not isinstance(value, Mapping):
        return value
    if len(value) == 1:
        ((name, options),) = value.items()
        if name not in ("name", "inputs", "<<") and _is_options(options) and known(kind, name):
            value = rebuilt(value, {"name": name, **_spread(options)})
    if "w" in value and value.get("name") in WEIGHTED:
        value = rebuilt(value, [("weight" if key == "w" else key, item) for key, item in value.items()])
    if not isinstance(inputs := value.get("inputs"), Mapping):
        return value
    inner = rebuilt(inputs, [(role, _input(given, known)) for role, given in inputs.items()])
    return rebuilt(value, [(key, inner if key == "inputs" else item) for key, item in value.items()])


def _is_options(value: Any) -> bool:
    return value is None or isinstance(getattr(value, "target", value), Mapping)


def _spread(options: Any) -> Mapping[str, Any]:
    """Entries beside a name; those that are anchored or stand elsewhere are merged in."""
    if options is None:
        return {}
    return options if isinstance(options, Mapping) and not getattr(options, "anchor", "") else {"<<": options}


def _input(given: Any, known: Known) -> Any:
    if not isinstance(given, Mapping):
        return given
    renamed = [("dataset", item) if key == "over" else _entry(key, item, known) for key, item in given.items()]
    return rebuilt(given, renamed)


def _dataset(items: Any, known: Known) -> Any:
    """{LABEL: ITEM}, {product: ...} and [{product: ...}] are lists of items."""
    if isinstance(items, Mapping):
        if "product" in items:
            return [_item(items, known)]
        return [
            {"label": label, **_spread(_item(item, known))} if _is_options(item) else item
            for label, item in items.items()
        ]
    return rebuilt(items, [_item(item, known) for item in items]) if isinstance(items, list) else items


def _item(item: Any, known: Known) -> Any:
    if not isinstance(item, Mapping):
        return item
    entries: list[tuple[Any, Any]] = []
    for key, value in item.items():
        if key == "product" and isinstance(value, Mapping):
            entries += _product(value, known)
        else:
            entries.append(_entry(key, value, known))
    return rebuilt(item, entries)


def _product(product: Mapping[str, Any], known: Known) -> list[tuple[str, Any]]:
    """A grid, and seeds that are counted from 0, if they come last, as a number of repetitions."""
    *first, last = product
    count = _count(last, product[last])
    grid = [(option, _range(_values(option, product[option], known))) for option in (first if count else product)]
    found = [("grid", rebuilt(product, grid))] if grid else []
    return [*found, ("repeat", {last: count})] if count else found


def _ends(values: Any) -> tuple[int, int] | None:
    if not isinstance(values, Mapping) or set(values) != {"from", "to"}:
        return None
    return int(values["from"]), int(values["to"])


def _range(values: Any) -> Any:
    ends = _ends(values)
    return values if ends is None else list(range(ends[0], ends[1] + 1))


def _count(option: str, values: Any) -> int:
    ends = _ends(values)
    return ends[1] + 1 if ends and ends[0] == 0 and str(option).endswith(".seed") else 0


def _claim(given: Any) -> Any:
    if not isinstance(given, Mapping):
        return given
    body = _merged(given)
    if "claim" not in body:
        if len(body) != 1 or not isinstance(_target(next(iter(body.values()))), Mapping):
            return given
        ((statement, below),) = body.items()
        body = {"claim": statement, **_merged(_target(below))}
    former = {"metric", "over", "not_comparable", "reference", *SUMMARIES} & body.keys()
    published = _target(body.get("published"))
    placed = isinstance(published, Mapping) and set(published) & {*PLACES, "value"}
    if body.keys() == given.keys() and not former and not placed:
        return given
    now = dict(body)
    if summary := next((name for name in SUMMARIES if name in body), ""):
        part = _target(now.pop(summary))
        part = _merged(part) if isinstance(part, Mapping) else {"metric": part}
        now["quantity"] = {summary: part["metric"]}
        now["rows"] = [part.get("of", {}), part.get("to", {})] if summary == "ratio" else part.get("of", {})
    elif former:
        now["quantity"] = {body.get("quantity"): now.pop("metric", None)}
        over = now.pop("over", None)
        now["rows"] = [body.get("rows", {}), over] if over is not None else body.get("rows", {})
    if not now.get("rows"):
        now.pop("rows", None)
    if "not_comparable" in now:
        now["because"], now["between"] = now.pop("not_comparable"), NOT_COMPARABLE
    if "reference" in now:
        now["published"] = {now.pop("reference"): AS_STATED}
    elif placed:
        place = next((name for name in PLACES if published.get(name) is not None), "place")
        now["published"] = {f"{place} {published.get(place, '')}": published.get("value", AS_STATED)}
    return rebuilt(given, {key: now[key] for key in (*ORDER, *(key for key in now if key not in ORDER)) if key in now})


def _target(value: Any) -> Any:
    return getattr(value, "target", value)


def _merged(body: Mapping[str, Any]) -> dict[str, Any]:
    """A mapping with what it merges from elsewhere written out."""
    own = {key: value for key, value in body.items() if key != "<<"}
    return {**_merged(_target(body["<<"])), **own} if "<<" in body else own


def _shown(value: Any) -> str:
    return " ".join(str(value).split())[:80]
