"""Turn some faces over, glue a fin to an edge, and mend both."""

import numpy as np

from surfexp.mesh.repair import repair
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.validate import validate

sphere = icosphere(3).mesh
faces = np.vstack([sphere.faces, [*sphere.faces[0][:2], len(sphere.vertices)]])
faces[:10] = faces[:10, ::-1]
vertices = np.vstack([sphere.vertices, [[2.0, 2.0, 2.0]]])
print("\n".join(validate(vertices, faces).lines()))

mesh, changes, origin = repair(vertices, faces)
print("\n".join(changes))
print(f"genus {mesh.genus}, {len(mesh.vertices)} vertices, area error {abs(mesh.area - sphere.area):.1e}")
