"""A map over corpora callosa read off on one grid, u along the skeleton and v across, and tested at every point of it."""

from surfexp_studies.skeletons.callosum import callosum
from surfexp_studies.skeletons.patch_grid import compare_on_grid, region_found

raised = {f"raised {i}": callosum(seed=100 + i, edge_length=1.0, signal=4.0) for i in range(8)}
plain = {f"plain {i}": callosum(seed=i, edge_length=1.0, signal=0.0) for i in range(8)}
found = region_found(compare_on_grid(raised, plain, along=24, across=9, chosen="signal", permutations=300))
print(f"planted at u = 0.61, v = 0.70; found at u = {found['centre_u']:.2f}, v = {found['centre_v']:.2f}")
print(f"{found['points_found']:.0f} of {found['points']:.0f} points, smallest p {found['smallest_corrected_p']:.3f}")
