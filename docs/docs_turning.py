"""The picture of the home page that turns: a cortex with the maps that come with it."""

from pathlib import Path

import surfexp as sx
from surfexp.figures.camera import viewing_direction
from surfexp.figures.colormap import ColorScale
from surfexp.figures.panel import surface_panel
from surfexp.figures.render import SurfaceView
from surfexp.report.turning.alone import turning_picture
from surfexp.report.turning.fields import Field, Step
from surfexp.report.turning.scene import Drawn, Scene

SCALES = {
    "sulc": ColorScale("sulcal depth", "", "PuOr_r"),
    "curv": ColorScale("mean curvature", "1/mm", "PuOr_r"),
    "thickness": ColorScale("cortical thickness", "mm"),
}


def write_picture(file: Path) -> None:
    """Write the page that the home page frames."""
    brain = sx.shape("fsaverage5", hemisphere="left")
    fields = [Field(scale.label, (Step(brain.scalars[name]),), scale) for name, scale in SCALES.items()]
    view = viewing_direction("lateral", brain.mesh)
    scene = Scene([Drawn("cortex", brain.mesh, fields)], [(0, 0)], view)
    still = SurfaceView(brain.mesh, brain.scalars["sulc"], view, SCALES["sulc"])
    caption = "fsaverage5, left hemisphere: sulcal depth."
    figure = surface_panel([still], width=1000, caption=caption)
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(turning_picture(scene, figure), encoding="utf-8")
