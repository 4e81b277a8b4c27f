"""Names of maps as files hold them: no two become one, none is lost."""

from __future__ import annotations

from collections.abc import Collection, Iterable


def check_map_names(names: Iterable[str]) -> None:
    """Refuse names that no reader gives back: empty ones, and those with control characters.

    Raises
    ------
    ValueError
        Naming the first of them.
    """
    for name in names:
        if not name.strip() or not name.isprintable() or name != name.strip():
            raise ValueError(f"map name {name!r} is empty or has characters that are not printed: rename the map")


def check_label_names(names: Iterable[str]) -> None:
    """Refuse names of labels with control characters, which no reader gives back; one may be empty.

    Raises
    ------
    ValueError
        Naming the first of them.
    """
    for name in names:
        if not name.isprintable() or name != name.strip():
            raise ValueError(f"name {name!r} of a label has characters that are not printed: rename the label")


def names_without_spaces(names: Iterable[str], reserved: Collection[str] = ()) -> list[str]:
    """Return names for formats whose names are words: an underscore stands for white space.

    Parameters
    ----------
    names : iterable of str
    reserved : collection of str
        What the format calls its own numbers.

    Raises
    ------
    ValueError
        If two become one, or one is reserved.
    """
    given = list(names)
    words = ["_".join(name.split()) for name in given]
    for name, word in zip(given, words, strict=True):
        if words.count(word) > 1:
            others = [repr(other) for other, same in zip(given, words, strict=True) if same == word]
            raise ValueError(f"maps {' and '.join(others)} are both called {word!r} in this format: rename one")
        if word in reserved:
            raise ValueError(f"map name {name!r} is what the format calls its own {word}: rename the map")
    return words


def told_apart(names: Iterable[object]) -> list[str]:
    """Return names of which no two are the same: an empty one, and one that stands before it, get their place from 1.

    Examples
    --------
    >>> told_apart(["pre", "post", "pre", ""])
    ['pre', 'post', 'pre 3', 'map 4']
    """
    found: list[str] = []
    for place, name in enumerate(names, 1):
        word = str(name).strip() or f"map {place}"
        while word in found:
            word = f"{word} {place}"
        found.append(word)
    return found


def printable_name(name: str) -> str:
    """Return a name that every format holds: what is not printed becomes a space, nothing becomes "map"."""
    shown = "".join(character if character.isprintable() else " " for character in name)
    return " ".join(shown.split()) or "map"
