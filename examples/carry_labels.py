"""The names of gyri carried from the left to the right hemisphere by ZoomOut, without pose."""

from surfexp.anatomy.fsaverage5 import fsaverage5
from surfexp.embedding.labels import desikan_killiany, label_accuracy
from surfexp.embedding.surface_map import Pair, zoomout_map
from surfexp.operators.elements_surface import surface_elements
from surfexp.spectrum.eigensolver import eigenpairs

surfaces = [fsaverage5(hemisphere, "white") for hemisphere in ("left", "right")]
elements = [surface_elements(surface.mesh) for surface in surfaces]
systems = [eigenpairs(parts.stiffness, parts.mass, k=121) for parts in elements]
found = zoomout_map(Pair(*surfaces, *systems), field="sulc")
labels = [desikan_killiany(hemisphere) for hemisphere in ("left", "right")]
by_area, _ = label_accuracy(*labels, surfaces[1].mesh.vertex_areas, found.correspondence)
print(f"{100 * by_area:.1f} % of the area named right by {found.method}")
