"""The names of gyri carried from the left to the right hemisphere by ZoomOut, without pose."""

import surfexp as sx
from surfexp.embedding.labels import desikan_killiany, label_accuracy
from surfexp.embedding.surface_map import Pair, zoomout_map

surfaces = [sx.shape("fsaverage5", hemisphere=hemisphere, sheet="white") for hemisphere in ("left", "right")]
systems = [sx.eigenpairs(surface, 121) for surface in surfaces]
found = zoomout_map(Pair(*surfaces, *systems), field="sulc")
labels = [desikan_killiany(hemisphere) for hemisphere in ("left", "right")]
by_area, _ = label_accuracy(*labels, surfaces[1].mesh.vertex_areas, found.correspondence)
print(f"{100 * by_area:.1f} % of the area named right by {found.method}")
