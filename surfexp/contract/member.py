"""Items of a dataset: what is known of each beside its result."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

# what an item of a dataset may say beside its stages
FACTS = ("label", "class", "group", "level")


@dataclass(frozen=True)
class Member:
    """One item of a dataset: the key under which a method gets its result.

    Parameters
    ----------
    label : str
        Its name, for people; no two of a dataset are alike, and nothing else hangs on it.
    class_name : str
        What a classifier tells apart, or the line of a plot to which it belongs; default: a class of its own.
    group : str
        The person, object or seed to which it belongs: items of one group never stand in training and test sets at once;
        default: a group of its own.
    level : float, optional
        The number at which it stands: a refinement, a size, a noise.
    """

    label: str
    class_name: str = ""
    group: str = ""
    level: float | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "class_name", self.class_name or self.label)
        object.__setattr__(self, "group", self.group or self.label)

    def __str__(self) -> str:
        return self.label


def members_of(items: Iterable[Mapping[str, Any]]) -> dict[Member, dict[str, Any]]:
    """Split each item of a dataset into its facts and all else that it says; without a label its number is its label."""
    return {
        Member(str(item.get("label", number)), item.get("class", ""), item.get("group", ""), item.get("level")): {
            name: value for name, value in item.items() if name not in FACTS
        }
        for number, item in enumerate(items)
    }


def levels_of(members: Iterable[Member]) -> tuple[float, ...]:
    """Return the level of every member; ValueError naming the first without one."""
    levels = []
    for member in members:
        if member.level is None:
            raise ValueError(f"item {member.label!r} has no level: write 'level: NUMBER' beside its stages")
        levels.append(member.level)
    return tuple(levels)
