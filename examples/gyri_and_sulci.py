"""Which part of a cortex are its gyri, by mean curvature and a short boundary, and how far does the depth agree?"""

import numpy as np

import surfexp as sx

# %%
# Without a map the mean curvature is divided, with a boundary as short as it allows. FreeSurfer's depth is the independent judge.
brain = sx.shape("fsaverage5", hemisphere="left", sheet="pial")
parts = sx.segment(brain)
raised = brain.scalars["sulc"] < 0
for name, found in (("short boundary", parts.labels == 1), ("sign of curvature alone", sx.mean_curvature(brain) > 0)):
    share = np.average(found == raised, weights=brain.mesh.vertex_areas)
    print(f"{name}: {100 * share:.1f} % of the area agrees with the depth")

# %%
# The gap is proved for the two means that were found.
print(f"boundary {parts.perimeter / 10:.0f} cm, gap {parts.gap:.0e}")
sx.write("gyri.label.gii", parts, brain)
picture = sx.plot(brain, parts.labels, views=("lateral", "medial"), label="gyri", width=800)
