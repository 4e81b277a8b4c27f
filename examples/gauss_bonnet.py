"""Do the angle defects of the white matter surface of a human cortex sum to 4 pi?"""

import igl
import numpy as np

import surfexp as sx

# %%
# The angle defect of a vertex is what its angles lack of 2 pi. By Gauss and Bonnet they sum to 4 pi on any closed surface
# without handles, whatever its folds.
cortex = sx.shape("fsaverage5", hemisphere="left", sheet="white")
curvature = igl.gaussian_curvature(cortex.mesh.vertices, np.array(cortex.mesh.faces))
print(f"{cortex.name}: area {cortex.mesh.area / 100:.0f} cm^2, total curvature {curvature.sum() / np.pi:.6f} pi")
picture = sx.plot(cortex, curvature, views=("lateral", "medial"), label="angle defect", limits=(-0.5, 0.5), width=800)
