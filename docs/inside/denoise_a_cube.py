"""Remove noise from a cube and keep its edges, by the total variation of its normals."""

from surfexp.mesh.noise import add_vertex_noise
from surfexp.mesh.shapes.cube import cube
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.variational.normal_filtering import NormalFiltering, normal_deviation

clean, noisy = cube(16).mesh, add_vertex_noise(cube(16), 0.03, seed=1).mesh
moved = TriangleMesh(NormalFiltering().run(noisy).values, clean.faces)
print(f"normals off by {normal_deviation(noisy, clean):.1f} degrees before, {normal_deviation(moved, clean):.1f} after")
