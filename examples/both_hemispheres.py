"""Does a filter treat both hemispheres of a cortex as one surface, and what do they share that each alone would lack?"""

import numpy as np

import surfexp as sx

# %%
# Both hemispheres of the average cortex are one surface with two components. Its thickness gets noise of .5 mm on both sides.
brain = sx.shape("fsaverage5", hemisphere="both", sheet="pial")
thickness = np.where(brain.scalars["thickness"] < 1.0, np.nan, brain.scalars["thickness"])  # without the medial wall
noisy = thickness + np.random.default_rng(0).normal(0.0, 0.5, len(thickness))

# %%
# One call reads the noise from both sides, and chooses its filter for both. A side alone has half of the data.
clean = sx.denoise(brain, noisy)
print(f"one noise level for both: {clean.certificate['noise']:.2f} mm, true 0.5")
for side, one in brain.hemispheres().items():
    inside = np.isfinite(thickness) & (brain.right == (side == "right"))
    error = np.sqrt(np.mean((clean.values - thickness)[inside] ** 2))
    alone = sx.denoise(one, noisy[brain.right == (side == "right")]).certificate["noise"]
    print(f"{side}: error {error:.2f} mm; noise read from it alone {alone:.2f} mm")

# %%
# No wave goes from one side to the other, but modes of nearly the same frequency share both.
modes = sx.eigenpairs(brain, 12)
held = (np.nan_to_num(modes.vectors[~brain.right]) ** 2).sum(0) / (np.nan_to_num(modes.vectors) ** 2).sum(0)
print("share of each mode on the left:", held[2:].round(2).tolist())

# %%
# A CIFTI file holds the maps of both sides; a picture shows them in four views.
sx.write("clean.dscalar.nii", {"thickness": clean.values}, brain)
sx.plot(brain, clean.values, label="thickness", unit="mm", width=1200).save("both_hemispheres.png")
