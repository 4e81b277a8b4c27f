"""What a plugin writes beside its result: files that only it knows how to make."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

from surfexp.commands.exporting.names import slug
from surfexp.commands.exporting.writers import Place
from surfexp.contract.member import Member
from surfexp.lab.plan.plan import Keys, Node, Plan
from surfexp.lab.registry.registry import PLUGINS
from surfexp.lab.running.stage import make
from surfexp.lab.store import store
from surfexp.lab.store.kinds import KINDS


def write_further_files(plan: Plan, node: Node, results: Path, place: Place) -> None:
    """Write what the plugin of a stage exports beside its result; nothing for most.

    Raises
    ------
    DamagedResult
        If an input is not finished, or damaged; what was written before stays.
    """
    method = PLUGINS.get((node.kind, node.plugin))
    if method is None or method.exports is None:
        return

    def load(key: str) -> Any:
        kind = plan.nodes[key].kind
        return store.load(results, kind, key) if KINDS[kind].stored else make(plan.nodes, key, results)

    def some(role: str, keys: Keys) -> Any:
        if not isinstance(keys, dict):
            return load(keys) if isinstance(keys, str) else [load(key) for key in keys]
        names = [Member(**facts) for facts in node.members[role]] if role in node.members else list(keys)
        return LoadedWhenAsked(dict(zip(names, keys.values(), strict=True)), load)

    inputs = {role: some(role, keys) for role, keys in node.inputs.items()}
    with tempfile.TemporaryDirectory(dir=place.folder.staging) as folder:
        for name, file in method.exports(Path(folder), **inputs, **dict(method.options(**node.options))):
            file.rename(place.file("".join(file.suffixes), slug(name) or f"{node.plugin}-{node.key[:8]}"))


class LoadedWhenAsked(Mapping[Any, Any]):
    """Results by member, each read when it is asked for: one that is missing keeps none of the others from being used."""

    def __init__(self, keys: Mapping[Any, str], load: Callable[[str], Any]) -> None:
        self._keys, self._load = keys, load

    def __getitem__(self, name: Any) -> Any:
        """Read one."""
        return self._load(self._keys[name])

    def __iter__(self) -> Iterator[Any]:
        """Name each."""
        return iter(self._keys)

    def __len__(self) -> int:
        """Count them."""
        return len(self._keys)
