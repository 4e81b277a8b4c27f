"""Names by which atlases call what is not cortex: the medial wall, and vertices without a label."""

from __future__ import annotations

import re
from collections.abc import Iterable

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
