"""Three surfaces on which the published spectral distance breaks the triangle inequality, and a distance that does not."""

import surfexp as sx
from surfexp.embedding.distance_methods import Pairing, pairwise_distances, triangle_metrics
from surfexp.embedding.spectral_embedding import spectral_embedding
from surfexp.mesh.shapes.counterexamples import named_revolution

embeddings = {}
for name in ("cigar", "needle_ball", "two_balls"):
    surface = named_revolution(name)
    embeddings[name] = spectral_embedding(sx.eigenpairs(surface, 2), surface.mesh.vertex_areas, n=1)
for method in ("mean_hausdorff", "hausdorff"):
    ratio = triangle_metrics(pairwise_distances(embeddings, Pairing(method))[0])["triangle_ratio"]
    print(f"{method}: the direct way is {ratio:.2f} times the detour")
