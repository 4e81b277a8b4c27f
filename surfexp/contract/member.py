"""Members of a collection: what is known of each beside its result."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

# what a member of an axis may say beside its stages
FACTS = ("class", "group", "level")


@dataclass(frozen=True)
class Member:
    """One member of a collection: the key under which a method gets its result.

    Parameters
    ----------
    label : str
        Its name, for people; no two of a collection are alike, and nothing else hangs on it.
    class_name : str
        What a classifier tells apart, or the line of a plot to which it belongs; default: a class of its own.
    group : str
        The person, object or seed to which it belongs: members of one group never stand in training and test sets at once;
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


def axis_members(axis: Mapping[Any, Any] | Iterable[Any]) -> dict[Member, dict[str, Any]]:
    """Split each member of an axis, given by label or in a list, into its facts and all else that it says."""
    parts = axis if isinstance(axis, Mapping) else dict(enumerate(axis))
    return {
        Member(str(label), part.get("class", ""), part.get("group", ""), part.get("level")): {
            name: value for name, value in part.items() if name not in FACTS
        }
        for label, part in parts.items()
    }


def levels_of(members: Iterable[Member]) -> tuple[float, ...]:
    """Return the level of every member; ValueError naming the first without one."""
    levels = []
    for member in members:
        if member.level is None:
            raise ValueError(f"axis member {member.label!r} has no level: write 'level: NUMBER' beside its stages")
        levels.append(member.level)
    return tuple(levels)
