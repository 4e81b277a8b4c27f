"""What are area, volume and first eigenvalues of all meshes of a folder, as a table?"""

from pathlib import Path

import pandas

import surfexp as sx

# %%
# A folder of meshes, as a segmentation may leave it.
folder = Path("bodies")
folder.mkdir(exist_ok=True)
for name, axes in (("ball", (1.0, 1.0, 1.0)), ("cigar", (2.0, 1.0, 1.0)), ("pancake", (1.5, 1.5, 0.5))):
    sx.write(folder / f"{name}.ply", sx.shape("ellipsoid", levels=3, semiaxes=axes))

# %%
# The table has a column for each file, in the layout of BrainPrint, and says whether each spectrum is proved complete.
found = sx.fingerprint(folder, count=6)
table = pandas.DataFrame(found.rows(), index=list(found.columns))
print(table[["area", "volume", "ev1", "ev5", "complete"]].round(2))
found.save("bodies.csv")
pictures = [sx.plot(file, width=400) for file in sorted(folder.iterdir())]
