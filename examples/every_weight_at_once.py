"""Which weight of total variation leaves least error, and how much worse are its neighbours, by the noisy map alone?"""

import numpy as np

import surfexp as sx

sphere = sx.shape("icosphere", levels=4)
x, y, z = sphere.mesh.vertices.T
clean = 2.0 * np.sign(z) + x
noisy = clean + np.random.default_rng(0).normal(0, 1, len(clean))

# %%
# A few weights are solved, and at every weight between them the duality gap is proved. The error at each weight is estimated from
# the noisy map, by Stein's estimate.
path = sx.denoise_path(sphere, noisy)
risk = path.risk()
print(
    f"{path.certificate['solves']} solves prove a relative gap of {path.certificate['relative_gap']:.0e} at every weight"
)
for weight in (risk.weight / 5, risk.weight, 5 * risk.weight):
    error = np.average((path.at(weight).values - clean) ** 2, weights=sphere.mesh.vertex_areas)
    (estimate,) = path.risk([weight]).risks * path.certificate["noise"] ** 2
    print(f"weight {weight:.2f}: mean square error {error:.2f}, estimated {estimate:.2f}")

# %%
# On a page a slider runs over the weights, beside the curve of the error.
path.view(sphere, title="Every weight").save("every_weight.html")
pictures = [path.plot(sphere, width=1000), risk.plot(width=800)]
