"""Denoising where the map itself says by what."""

from __future__ import annotations

from typing import Any

from surfexp.smoothing.fitted_smoothing import FittedSmoothing, fitted_smoothing
from surfexp.tasks.denoised_map import DenoisedMap
from surfexp.tasks.noisy_image import NoisyImage
from surfexp.variational.fidelity import Progress

HEAT = {"heat_polynomial": "heat_kernel", "heat_flow": "heat_kernel"}
NAMED = 0.005
AT_THE_END = (
    "A parameter is an end of its grid. Where the noise itself is smooth, no estimate from one map sees it: give the noise "
    "that `noise` reads from a second measurement (--second)."
)


def automatically_denoised(
    image: NoisyImage, tolerance: float, threads: int = 1, progress: Progress | None = None
) -> DenoisedMap:
    """Denoise a map by the mixture of filters that promises the least error for the noise that was read from it.

    Parameters
    ----------
    image : NoisyImage
        Of one channel.
    tolerance : float
        Of the relative gap of the minimisations.
    threads, progress
        As in `fitted_smoothing`.
    """
    part = image.part
    noise = image.given_noise, tolerance, image.known_noise
    found = fitted_smoothing(image.operator, image.values, *noise, threads, progress)
    mixture, read = found.mixture, found.noise
    facts = {
        "noise": read.level,
        "noise_estimated": image.given_noise is None,
        "noise_kind": ", ".join(read.kinds) or "white",
    }
    facts |= {"outliers": len(read.outliers)} | _choice(found, part.length)
    facts |= {"relative_gap": found.largest_gap, "error_bound": found.error_bound, "converged": found.converged}
    notes = part.notes + tuple(sentence for kind, sentence in read.sentences.items() if kind != "outliers")
    if len(read.outliers):
        notes += (
            f"{len(read.outliers)} of {len(image.values)} values are far from those of all their neighbours and were replaced by "
            "the median of these: `outliers` lists them.",
        )
    if found.drawn_in:
        notes += (
            f"The noise has heavy tails: {found.drawn_in} values were drawn towards the smoothed map before the last pass. "
            "No estimate of the error holds then.",
        )
    ends = [one.at_the_end for one, share in zip(mixture.members, mixture.shares, strict=True) if share > NAMED]
    notes += (AT_THE_END,) if any(ends) and read.measurements == 1 else ()
    values, outliers = image.on_whole(mixture.values), part.vertices[read.outliers]
    return DenoisedMap(values, "auto", facts, notes, outliers=outliers, given=image.on_whole(image.values))


def _choice(found: FittedSmoothing, length: float) -> dict[str, Any]:
    """What a mixture is made of and its risk, as a certificate holds them; widths of kernels in the unit of the surface."""
    mixture = found.mixture
    names = [HEAT.get(one.method, one.method) for one in mixture.members]
    units = [length if name == "heat_kernel" else 1.0 for name in names]
    parameters = [one.parameter * unit for one, unit in zip(mixture.members, units, strict=True)]
    largest = int(mixture.shares.argmax())
    facts: dict[str, Any] = {"chosen": names[largest], "parameter": parameters[largest]}
    for name, parameter, share in zip(names, parameters, mixture.shares, strict=True):
        if NAMED < share < 1.0 - NAMED:
            facts |= {f"share_{name}": float(share), f"parameter_{name}": parameter}
    if found.drawn_in:
        return facts | {"drawn_in": found.drawn_in}
    return facts | {"risk": mixture.risk, "risk_error": mixture.risk_error}
