"""Three families of ellipsoids in the plane, by classical scaling of their spectra."""

from surfexp.member import Member
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.fem import fem
from surfexp.spectrum.spectral_signature import spectral_signature
from surfexp.statistics.multidimensional_scaling import classical_scaling
from surfexp.statistics.signature_distances import signature_distances

ball, signatures = icosphere(3).mesh, {}
for name, axes in (("long", [2.0, 1.0, 1.0]), ("flat", [1.5, 1.5, 0.6]), ("round", [1.1, 1.0, 0.9])):
    for size in (1.0, 1.5):
        mesh = TriangleMesh(size * ball.vertices * axes, ball.faces)
        signatures[Member(f"{name} {size}", name)] = spectral_signature(Surface(mesh), fem(mesh), 20)
embedding = classical_scaling(signature_distances(signatures))
for label, (x, y) in zip(embedding.labels, embedding.points, strict=True):
    print(f"{label}: {x:6.2f} {y:6.2f}")
print(f"stress {embedding.metrics['stress']:.3f}")
