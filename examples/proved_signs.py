"""Which signs of twenty eigenfunctions bring two cortices together, and do no others do better?"""

import surfexp as sx

# %%
# The eigenfunctions of two surfaces correspond up to their signs: 2^20 choices for twenty of them. Branch and bound finds the best
# choice and proves it with few evaluations.
left, right = (sx.shape("fsaverage5", hemisphere=side, sheet="white") for side in ("left", "right"))
found = sx.distance(left, right, n=20, weighting="global_point")
print(f"distance {found.value:.4f}, no signs give less than {found.lower_bound:.4f}: {found.optimal}")
print(f"proved with {found.evaluations} evaluations of {2**20}")

# %%
# Each vertex of the right side takes the colour of the vertex of the left one that it finds.
places = left.mesh.vertices[:, 1], left.mesh.vertices[found.correspondence, 1]
sides = (left, right)
pictures = [sx.plot(side, field, views=("lateral",), width=500) for side, field in zip(sides, places, strict=True)]
