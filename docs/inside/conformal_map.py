"""Map an ellipsoid to the sphere: the largest angle error halves with the edge length, and no face flips."""

import numpy as np

import surfexp as sx
from surfexp.baselines.conformal_flow import conformal_flow
from surfexp.baselines.distortion import distortion
from surfexp.baselines.parameter_domain import image_mesh
from surfexp.baselines.spherical_map import spherical_map

for levels in (2, 3, 4):
    mesh = sx.shape("ellipsoid", levels=levels, semiaxes=(1.0, 1.0, 1.8)).mesh
    image = image_mesh(mesh, conformal_flow(mesh, spherical_map(mesh)))
    measured = distortion(mesh, image, np.zeros(3))
    print(f"angle error {measured['angle_error_max']:.2f} degrees, {measured['flipped_faces']:.0f} faces flipped")
