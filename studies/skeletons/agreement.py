"""Whether skeletons are the same graph, and how far they differ in size."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.skeleton.skeleton import Skeleton


def same_graph(first: Skeleton, second: Skeleton) -> bool:
    """Whether an isomorphism maps contours to contours of the same level, caps to caps and junctions to junctions."""
    import networkx

    def alike(a: dict[str, object], b: dict[str, object]) -> bool:
        return a["kind"] == b["kind"] and a["level"] == b["level"]

    if len(first.positions) != len(second.positions) or len(first.arcs) != len(second.arcs):
        return False
    return bool(networkx.is_isomorphic(first.graph(), second.graph(), node_match=alike))


def length_profile(skeleton: Skeleton) -> Floats:
    """(K,) total length of the contours at each level: the widths of a chain."""
    on_levels = skeleton.level_index >= 0
    index, lengths = skeleton.level_index[on_levels], skeleton.lengths[on_levels]
    return np.bincount(index, lengths, len(skeleton.levels)).astype(np.float64)


def topology(skeleton: Skeleton) -> tuple[int, int, int]:
    """Leaves, branch nodes and loops: skeletons of one topology have these in common."""
    return tuple(int(skeleton.metrics[name]) for name in ("leaves", "branch_nodes", "b1"))  # type: ignore[return-value]
