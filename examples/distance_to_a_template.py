"""How far are subjects from the template that they were made from, and does their pose count?"""

import matplotlib.pyplot as plt
import numpy as np

import surfexp as sx

# %%
# Ten subjects are the template moved by a smooth random field, a little more from one to the next, and turned at random. The
# spectral distance scales areas to 1 and knows no pose.
template = sx.shape("ellipsoid", levels=3, semiaxes=(1.0, 1.4, 2.0))
random = np.random.default_rng(0)
strengths = np.linspace(0.0, 0.25, 10)
waves, phases = random.normal(0.0, 1.5, (3, 3)), random.uniform(0.0, 2.0 * np.pi, 3)
field = np.sin(template.vertices @ waves + phases)
subjects = []
for strength in strengths:
    turn = np.linalg.qr(random.normal(size=(3, 3)))[0]
    turn *= np.linalg.det(turn)
    subjects.append(sx.Surface(((template.vertices + strength * field) @ turn, template.faces)))
distances = sx.SpectralDistance(n=10).fit([template]).transform(subjects)[:, 0]
print("distance " + ", ".join(f"{value:.3f}" for value in distances))
far = sx.distance(template, subjects[-1], n=10)
print(f"the last one {far.value:.3f}, no signs give less than {far.lower_bound:.3f}: {far.optimal}")

# %%
# Each vertex of a subject finds its vertex of the template: the colours are heights on the template.
figure, axes = plt.subplots(figsize=(6, 4))
axes.plot(strengths, distances, "o-")
axes.set(xlabel="strength of the field, in lengths of the shortest axis", ylabel="distance to the template")
height = template.vertices[:, 2]
pictures = [
    sx.plot(template, height, label="height on the template", width=500),
    sx.plot(subjects[-1], height[far.correspondence], label="carried to the last subject", width=500),
]
