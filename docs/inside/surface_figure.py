"""Draw a brain, coloured by its curvature with the border of its sulci in red, without a display."""

from pathlib import Path

from surfexp.anatomy.fsaverage5 import fsaverage5
from surfexp.figures.colormap import ColorScale
from surfexp.figures.contours import Contours
from surfexp.figures.encode import encode_png
from surfexp.figures.panel import surface_panel
from surfexp.figures.render import SurfaceView

brain = fsaverage5("left", "pial")
scale, border = ColorScale("mean curvature", "1/mm", "RdBu_r"), Contours(brain.scalars["sulc"])
views = [SurfaceView(brain.mesh, brain.scalars["curv"], name, scale, (border,), name) for name in ("lateral", "medial")]
figure = surface_panel(views, width=1200)
Path("surface_figure.png").write_bytes(encode_png(figure.pixels))
print(figure.pixels.shape, figure.caption)
