"""How does the curvature of a cortex look after smoothing by 10 mm, and is its mean kept?"""

import surfexp as sx

# %%
# A kernel of 10 mm full width at half maximum, as in other programs, along the surface and not across sulci.
brain = sx.shape("fsaverage5", hemisphere="left", sheet="pial")
smoothed = sx.smooth(brain, "curv", 10.0)
before, after = brain.scalars["curv"].std(), smoothed.values.std()
change = smoothed.certificate["change_of_mean"]
print(f"spread {before:.3f} / mm before, {after:.3f} / mm after; mean changed by {change:.0e}")
maps = {"before": "curv", "after": smoothed}
picture = sx.plot(
    brain, maps, views=("lateral", "medial"), limits=(-0.3, 0.3), label="mean curvature", unit="1/mm", width=800
)
picture.save("smoothed_curvature.png")
