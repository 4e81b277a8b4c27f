"""The descriptors that are compared, at the defaults of the project, of one spectrum and of one surface by two routes."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.mesh.surface import Surface
from surfexp.operators.fem import fem
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.spectrum.heat_kernel import heat_kernel_signature
from surfexp.spectrum.nodal_graph import NodalGraph
from surfexp.spectrum.nodal_signature import counted_domains
from surfexp.spectrum.pointwise_signatures import wave_kernel_signature
from surfexp.spectrum.shape_distributions import (
    ENERGIES,
    RELATIVE_TIMES,
    embedding_distances,
    heat_distribution,
    wave_distribution,
)
from surfexp.spectrum.shape_dna import shape_dna
from surfexp.spectrum.signature import Signature
from surfexp.spectrum.surface_spectrum import graph_of, surface_spectrum

from .certificate import value_radii
from .usual_spectrum import usual_spectrum

SHAPE_DNA, BRAINPRINT, MODES = 35, 50, 100
DESCRIPTORS = (
    "area", "shape_dna", "brainprint", "nodal_counts", "heat_means", "wave_means", "hks", "wks", "gps",
)  # fmt: skip
BOUNDED = ("shape_dna", "brainprint")
USUAL, RADII = "usual ", "radii "


def heat_means(system: EigenSystem, vertex_areas: Floats) -> Floats:
    """Return ln of the mean by area of A K(t, x, x), at the times of `heat_distribution`.

    But for the lumping of areas that is the heat trace Z(t): the mean forgets where on the surface the heat was.
    """
    times = RELATIVE_TIMES[RELATIVE_TIMES > 0.02] * system.area / (4.0 * np.pi)
    signature = heat_kernel_signature(system, times)[: len(vertex_areas)]
    return np.asarray(np.log(system.area * (vertex_areas @ signature) / vertex_areas.sum()))


def wave_means(system: EigenSystem, vertex_areas: Floats) -> Floats:
    """Return the mean by area of A times the wave kernel signature, in the bands of `wave_distribution`.

    But for the lumping of areas all entries are 1, on every surface: each band is a weighted mean of squares of
    eigenfunctions, and each of these has the mean 1 / A.
    """
    signature = wave_kernel_signature(system, ENERGIES, 2.0)[: len(vertex_areas)]
    return np.asarray(system.area * (vertex_areas @ signature) / vertex_areas.sum())


def descriptors(system: EigenSystem, graph: NodalGraph, vertex_areas: Floats) -> dict[str, Floats]:
    """Return all descriptors of a spectrum of a connected surface.

    Parameters
    ----------
    system : EigenSystem
        With at least 51 pairs, the constant among them.
    graph : NodalGraph
    vertex_areas : (n,) float64

    Returns
    -------
    dict of str to (d,) float64
        "area"; "shape_dna", 35 values times the area; "brainprint", 50 of them over their number; "nodal_counts",
        filtered; "heat_means" and "wave_means"; "hks" and "wks", quantiles over the surface; "gps", the distribution of
        distances in the space of the global point signature.

    Raises
    ------
    ValueError
        If there are too few pairs.
    """
    if len(system.values) <= BRAINPRINT:
        raise ValueError(f"the spectrum has {len(system.values)} values, descriptors need at least {BRAINPRINT + 1}")
    moving = shape_dna(system.values, "area", system.area)
    return {
        "area": np.array([system.area]),
        "shape_dna": moving[:SHAPE_DNA],
        "brainprint": moving[:BRAINPRINT] / np.arange(1.0, BRAINPRINT + 1.0),
        "nodal_counts": counted_domains(system, graph)[1:],
        "heat_means": heat_means(system, vertex_areas),
        "wave_means": wave_means(system, vertex_areas),
        "hks": heat_distribution(system, vertex_areas),
        "wks": wave_distribution(system, vertex_areas),
        "gps": embedding_distances(system, vertex_areas),
    }


def fingerprint(surface: Surface, count: int = MODES, seed: int = 0) -> Signature:
    """Return the descriptors of a closed connected surface from a certified spectrum and from that of the usual solver.

    Parameters
    ----------
    surface : Surface
    count : int
        Modes after the constant one.
    seed : int
        Of the start vectors.

    Returns
    -------
    Signature
        Shape DNA. Parts: all of `DESCRIPTORS`, "usual NAME" the same by the usual solver, and "radii NAME",
        "radii usual NAME" the certificates of those that are made of eigenvalues alone.
    """
    operator = fem(surface.mesh)
    systems = {
        "": surface_spectrum(surface, operator, count + 1, seed=seed),
        USUAL: usual_spectrum(operator, count + 1, seed),
    }
    parts: dict[str, Floats] = {}
    for route, system in systems.items():
        found = descriptors(system, graph_of(operator, systems[""]), surface.mesh.vertex_areas)
        parts |= {route + name: values for name, values in found.items()}
        radii = system.area * value_radii(operator, system)[1:]
        parts[f"{RADII}{route}shape_dna"] = radii[:SHAPE_DNA]
        parts[f"{RADII}{route}brainprint"] = radii[:BRAINPRINT] / np.arange(1.0, BRAINPRINT + 1.0)
    certified = systems[""]
    metrics = {name: certified.metrics[name] for name in ("complete", "largest_residual", "area")}
    metrics["vertices"] = float(len(surface.mesh.vertices))
    return Signature(parts.pop("shape_dna"), "shape_dna", parts, metrics, certified.notes)
