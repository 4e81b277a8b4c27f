"""The isospectral pairs of seven tiles, from the group GL(3,2) acting on points and on lines."""

from __future__ import annotations

import itertools
from functools import cache

import numpy as np

from surfexp.mesh.shapes.isospectral_drum import TILES, Gluing, Permutation, TransplantationPair


@cache
def transplantation_pairs() -> tuple[TransplantationPair, ...]:
    """Return the seven pairs of simply connected, different drums, up to renaming of the tiles.

    An involution of GL(3,2) permutes the seven points of the Fano plane, and its transpose the seven lines. Three of them
    glue two drums, of one simply connected piece if the tiles form a tree, isospectral because the two actions have the
    same character. Sides keep their names, as those of a tile differ; up to renaming them too, there are three classes.
    """
    found = set()
    for triple in itertools.product(_involutions(), repeat=3):
        points, lines = (tuple(action[which] for action in triple) for which in (0, 1))
        if _is_tree(points) and _is_tree(lines):
            one, two = sorted((_canonical(points), _canonical(lines)))
            if one != two:
                found.add((one, two))
    return tuple(TransplantationPair(*pair) for pair in sorted(found))


@cache
def _involutions() -> tuple[tuple[Permutation, Permutation], ...]:
    """The 21 involutions of GL(3,2) as permutations of the nonzero vectors, each with its transpose."""
    vectors = [np.array(v) for v in itertools.product((0, 1), repeat=3) if any(v)]
    number = {tuple(v): i for i, v in enumerate(vectors)}
    identity = np.eye(3, dtype=int)
    result = []
    for entries in itertools.product((0, 1), repeat=9):
        matrix = np.array(entries).reshape(3, 3)
        if (matrix @ matrix % 2 == identity).all() and not (matrix == identity).all():
            points, lines = (tuple(number[tuple(m @ v % 2)] for v in vectors) for m in (matrix, matrix.T))
            result.append((points, lines))
    return tuple(result)


def _is_tree(gluing: tuple[Permutation, ...]) -> bool:
    """Whether the tiles, joined along their sides, are connected without a cycle."""
    reached, joints, stack = {0}, sum(p[t] > t for p in gluing for t in range(TILES)), [0]
    while stack:
        tile = stack.pop()
        for permutation in gluing:
            if permutation[tile] not in reached:
                reached.add(permutation[tile])
                stack.append(permutation[tile])
    return len(reached) == TILES and joints == TILES - 1


def _canonical(gluing: tuple[Permutation, ...]) -> Gluing:
    """The least form of a connected gluing under renaming of its tiles."""
    forms = []
    for root in range(TILES):
        names, order = {root: 0}, [root]
        for tile in order:
            for permutation in gluing:
                if permutation[tile] not in names:
                    names[permutation[tile]] = len(order)
                    order.append(permutation[tile])
        forms.append(tuple(tuple(names[permutation[tile]] for tile in order) for permutation in gluing))
    least = min(forms)
    return least[0], least[1], least[2]
