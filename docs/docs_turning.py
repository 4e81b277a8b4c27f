"""The picture of the home page that turns: a cortex with the maps that come with it."""

from pathlib import Path

import surfexp as sx

MAPS = ("sulc", "curv", "thickness")


def write_picture(file: Path) -> None:
    """Write the page that the home page frames."""
    brain = sx.shape("fsaverage5", hemisphere="left")
    file.parent.mkdir(parents=True, exist_ok=True)
    sx.view(brain, list(MAPS)).save(file)
