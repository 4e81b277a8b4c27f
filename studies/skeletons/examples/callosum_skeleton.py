"""The skeleton of a corpus callosum whose midline is known, by uniform levels and by levels at equal distances."""

from surfexp.skeleton.polyline import trunk_contours
from surfexp_studies.skeletons.callosum import callosum
from surfexp_studies.skeletons.midline import midline_errors
from surfexp_studies.skeletons.skeleton_study import eigenmap_skeleton

patch = callosum(seed=0)
for levels in ("uniform", "arc_length"):
    skeleton, _ = eigenmap_skeleton(patch.mesh, levels=levels)
    miss = midline_errors(patch.truth.midline, trunk_contours(skeleton))[0] / patch.mesh.edge_length
    print(f"{levels}: chain {skeleton.is_chain}, the midline is missed by {miss:.2f} edge lengths")
