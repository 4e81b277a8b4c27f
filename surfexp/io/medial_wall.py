"""Names by which atlases call what is not cortex: the medial wall, and vertices without a label."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping

import numpy as np

from surfexp.contract.arrays import Integers

# in small letters, without hemisphere, signs and spaces
NAMES = {
    "": "??? of HCP-MMP1, AICHA and FreeSurfer's empty tables",
    "unknown": "Desikan-Killiany, Destrieux, PALS-B12, Brainnetome, von Economo",
    "medialwall": "Destrieux, PALS-B12, Gordon, von Economo",
    "corpuscallosum": "Desikan-Killiany, Lausanne",
    "freesurferdefinedmedialwall": "Yeo",
    "backgroundfreesurferdefinedmedialwall": "Schaefer",
    "background": "nilearn's tables",
    "none": "Gordon",
    "undefined": "BALSA's tables",
    "unassigned": "BALSA's tables",
    "unlabeled": "MindBoggle, BrainVISA",
    "unlabelled": "MindBoggle, BrainVISA",
    "nolabel": "MindBoggle, BrainVISA",
}
HEMISPHERE = re.compile(r"^(?:ctx[-_ .])?(?:[lr]h?|left|right|hemi-[lr])[-_ .]+|[-_ .]+(?:[lr]h?|left|right)$")


def is_outside(name: str) -> bool:
    """Whether a label of an atlas stands for the medial wall or for nothing.

    Parameters
    ----------
    name : str
        With or without a hemisphere before or behind it, in any writing: `lh.Medial_wall`, `L_???`, `MEDIAL.WALL`.

    Examples
    --------
    >>> [is_outside(name) for name in ("ctx-lh-unknown", "Background+FreeSurfer_Defined_Medial_Wall", "insula")]
    [True, True, False]
    """
    bare = HEMISPHERE.sub("", name.strip().lower())
    return re.sub(r"[\W_]+", "", bare) in NAMES


def outside_names(names: Iterable[str]) -> list[str]:
    """Return which names of labels are outside of the cortex, in their order."""
    return [name for name in names if is_outside(name)]


def named_labels(keys: Integers, names: Mapping[int, str]) -> dict[int, str]:
    """Return the labels of a file that stand for something, each with its name.

    Parameters
    ----------
    keys : (n,) int64
        The label of each vertex.
    names : dict of int to str
        The table of the file.

    Returns
    -------
    dict of int to str
        Where the table names nothing but what is outside, as of subfields of the hippocampus, each label but 0 by its number.

    Examples
    --------
    >>> named_labels(np.array([0, 2, 2]), {0: "unknown", 1: "insula", 2: "cuneus"})
    {1: 'insula', 2: 'cuneus'}
    >>> named_labels(np.array([0, 2, 2]), {0: "???"})
    {2: '2'}
    """
    known = {key: name for key, name in names.items() if not is_outside(name)}
    none = {0, -1, *names} if names else {0}
    return known or {key: str(key) for key in np.unique(keys).tolist() if key not in none}
