"""Area of an ellipsoid from vertices alone: facets against cubic patches across the normals (PN triangles)."""

import surfexp as sx
from surfexp.operators.elements_nodes import flat_positions, number_nodes
from surfexp.operators.elements_patches import patch_positions
from surfexp.operators.elements_surface import assemble_elements

mesh = sx.shape("ellipsoid", levels=3, semiaxes=(2.0, 1.0, 1.0)).mesh
exact = 21.478435  # 2 pi (1 + 2 arcsin(e) / e), e = sqrt(3) / 2
nodes = number_nodes(mesh.faces, len(mesh.vertices), 2)
for name, places in (("facets", flat_positions(mesh.vertices[mesh.faces], 2)), ("patches", patch_positions(mesh, 2))):
    print(f"{name:8s} {abs(assemble_elements(nodes, places).area / exact - 1):.1e}")
