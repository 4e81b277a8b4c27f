"""Three surfaces on which the published spectral distance breaks the triangle inequality, and a distance that does not."""

from surfexp.embedding.distance_methods import Pairing, pairwise_distances, triangle_metrics
from surfexp.embedding.spectral_embedding import spectral_embedding
from surfexp.operators.elements_surface import surface_elements
from surfexp.spectrum.eigensolver import eigenpairs
from surfexp.studies.distances.counterexamples import named_revolution

embeddings = {}
for name in ("cigar", "needle_ball", "two_balls"):
    mesh = named_revolution(name).mesh
    elements = surface_elements(mesh)
    embeddings[name] = spectral_embedding(eigenpairs(elements.stiffness, elements.mass, k=2), mesh.vertex_areas, n=1)
for method in ("mean_hausdorff", "hausdorff"):
    ratio = triangle_metrics(pairwise_distances(embeddings, Pairing(method))[0])["triangle_ratio"]
    print(f"{method}: the direct way is {ratio:.2f} times the detour")
