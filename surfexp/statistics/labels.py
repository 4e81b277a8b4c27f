"""Labels of the members of a collection: "class @ owner ...", for example "caudate @ 9861 left"."""

from __future__ import annotations

from collections.abc import Iterable


def classes_of(labels: Iterable[str]) -> tuple[str, ...]:
    """Return what stands before " @ " in each label, the whole label where it has none."""
    return tuple(label.partition(" @ ")[0] for label in labels)


def groups_of(labels: Iterable[str]) -> tuple[str, ...]:
    """Return the first word after " @ " in each label, the whole label where it has none.

    Members of one group belong to one person or object and never stand in training and test sets at once.
    """
    groups = []
    for label in labels:
        _, at, owner = label.partition(" @ ")
        groups.append(owner.split()[0] if at and owner.split() else label)
    return tuple(groups)
