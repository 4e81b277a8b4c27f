"""Which kind of body is it? Spectra of poses against nodal counts, each pose judged by the other poses."""

from surfexp.contract.member import Member
from surfexp.operators.fem import fem
from surfexp.populations.articulated import articulated_body
from surfexp.spectrum.spectral_signature import spectral_signature
from surfexp.statistics.classifiers import classify
from surfexp.statistics.signature_distances import signature_distances

signatures = {}
for body in ("biped", "quadruped", "worm"):
    for pose in (1, 2, 3):
        surface = articulated_body(body, pose, vertices=800)
        signatures[Member(f"{body} {pose}", body, str(pose))] = spectral_signature(surface, fem(surface.mesh), 30)
for part in ("shape_dna", "nodal_counts"):
    found = classify(signature_distances(signatures, part), permutations=99)
    print(f"{part}: {found.metrics['accuracy']:.2f} right, p = {found.metrics['p_value']:.2f}")
