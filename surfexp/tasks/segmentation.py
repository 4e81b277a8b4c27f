"""Two regions of a surface, brighter and darker, with a short boundary."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.contract.drawable import Drawable
from surfexp.contract.summary import Summary
from surfexp.mesh.given_numbers import given_threads, real_number
from surfexp.mesh.label_map import LabelMap
from surfexp.mesh.surface import Surface
from surfexp.mesh.surface_part import SurfacePart
from surfexp.operators.fem import fem
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.smoothing.absurd_values import refuse_absurd_values
from surfexp.smoothing.noisy_phases import NoisyPhases, noisy_phases
from surfexp.tasks.given_map import MapLike, as_single_map
from surfexp.tasks.given_surface import SurfaceLike, as_surface
from surfexp.tasks.part_of_task import part_for
from surfexp.tasks.skeletons import mean_curvature
from surfexp.variational.fidelity import Fidelity, Progress
from surfexp.variational.image import Image
from surfexp.variational.models.convex_chan_vese import ConvexChanVese
from surfexp.variational.own_unit import OwnUnit, own_unit
from surfexp.variational.solution import Solution
from surfexp.variational.solvers.primal_dual import primal_dual

# of the size of the curvature; what is left is little more than its sign, which two means can follow
CLIPPED_AT = 50.0
SMOOTHNESS, HALVINGS = 0.3, 8
# rounding of a curvature, and of a map that is the curvature times a number
SAME = 1e-9
NAMES = {0: "unknown", 1: "darker", 2: "brighter"}


@dataclass(frozen=True, eq=False, repr=False)
class Segmentation(Drawable):
    """Two regions of a surface, and what is proved of them.

    Parameters
    ----------
    labels : (n,) int64
        1 in the brighter region, 0 in the darker one, -1 outside the mask.
    c1, c2 : float
        The means of the brighter and of the darker region in the energy that is bounded, c1 > c2.
    energy : float
        Sum over the faces of area times |gradient| of the piecewise linear field that is 1 in the brighter region and 0 in
        the darker one, plus the sum of mass times mu r over the brighter region, r the difference of the squared distances
        to the two means: 0 for a region that is empty, below it where two regions are better than one. The first sum is
        the length of the line through the midpoints of the edges that the boundary cuts, not `perimeter`.
    lower_bound : float
        No two regions have less energy for these means.
    gap : float
        By how much the field whose level set the regions are exceeds the bound, as a share of what the best threshold of
        the map leaves open: at most the tolerance where `converged`.
    labelling_gap : float
        The same for the regions themselves, on the same scale: 0 is proved least. Edges cannot follow a boundary exactly, so
        that it stays well above 0 on a coarse mesh, however good the regions are.
    converged : bool
        Whether the relaxed problem reached its tolerance and the means came to rest.
    perimeter : float
        Length of the level line of the field at which the regions meet, in the unit of the surface.
    notes : tuple of str
    """

    labels: Integers
    c1: float
    c2: float
    energy: float
    lower_bound: float
    gap: float
    labelling_gap: float
    converged: bool
    perimeter: float
    notes: tuple[str, ...] = ()

    @property
    def values(self) -> Floats:
        """The labels as a map: NaN outside the mask."""
        return np.where(self.labels < 0, np.nan, self.labels.astype(np.float64))

    @property
    def label_map(self) -> LabelMap:
        """The labels as files hold them: 0 unknown, 1 darker, 2 brighter."""
        return LabelMap(self.labels + 1, NAMES)

    def _summary(self) -> Summary:
        counts = {f"vertices {name}": int((self.labels == key - 1).sum()) for key, name in NAMES.items() if key}
        numbers = {"mean of the brighter": self.c1, "mean of the darker": self.c2, "boundary length": self.perimeter}
        proof = {"gap": self.gap, "labelling gap": self.labelling_gap, "converged": self.converged}
        return Summary("two regions", counts | numbers | proof, self.notes)


def segment(
    surface: SurfaceLike,
    values: MapLike | None = None,
    *,
    smoothness: float | None = None,
    tolerance: float = 1e-3,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Segmentation:
    """Divide a surface into two regions in which a map is nearly constant, with a short boundary (Chan and Vese).

    For given means the convex relaxation proves how near the regions are to the best ones. Regions and means are updated
    in turn until neither changes. This may be a local minimum over the means.

    Parameters
    ----------
    surface : Surface, path, or (vertices, faces)
        The part inside the mask is divided, or the part where the map is finite if there is no mask.
    values : str or (n,) float64, optional
        Name of a map of the surface, or the map. Without one it is the mean curvature, positive where the surface bulges
        outward. Any multiple of it is clipped at the median of its modulus, of what is not 0 where most is flat. On a cortex the
        brighter region is then the gyri.
    smoothness : float, optional
        Weight of the boundary's length, dimensionless; larger is smoother. If it is not given, curvature takes 0.3. Any
        other map is denoised, by `denoise`: the regions start from two means of the result, the map is clipped to its range,
        and the length weighs twice the product of edge, contrast and noise. That weight is halved while a region is empty.
    tolerance : float
        Largest relative duality gap of the relaxed problem.
    threads : int, optional
        Of the denoising: all cores if not given; the bytes are the same.
    progress : callable, optional
        Receives the iteration and the gap.

    Returns
    -------
    Segmentation
        `labels` (1 brighter, 0 darker, -1 outside), `c1`, `c2`, `lower_bound`, `gap`, `perimeter`.

    Raises
    ------
    ValueError
        If the map does not fit, is constant or has several channels, or a parameter is not positive.

    References
    ----------
    Chan, Esedoglu, Nikolova: Algorithms for finding global minimizers of image segmentation and denoising models (2006).

    Examples
    --------
    >>> import surfexp as sx
    >>> sphere = sx.shape("icosphere", levels=3)
    >>> noise = 0.3 * np.random.default_rng(0).standard_normal(642)
    >>> parts = sx.segment(sphere, np.sign(sphere.mesh.vertices[:, 2]) + noise)
    >>> bool((parts.labels == (sphere.mesh.vertices[:, 2] > 0)).mean() > 0.95)
    True
    """
    if smoothness is not None:
        smoothness = real_number(smoothness, "smoothness", above=0.0)
    tolerance = real_number(tolerance, "tolerance", above=1e-15, below=1.0)
    threads = given_threads(threads)
    owner = as_surface(surface)
    given = () if values is None else (as_single_map(owner, values),)
    part = part_for(owner, *given)
    inside = np.asarray(part.restrict(given[0]), dtype=np.float64) if given else _curvature(owner, part)
    if np.isnan(inside).any():
        part = part_for(owner, mean_curvature(owner))
        inside = _curvature(owner, part)
    if given:
        refuse_absurd_values(inside, part.vertices)
    if np.ptp(inside) == 0:
        raise ValueError(f"map is constant at {inside.flat[0]:g}, two regions need two values")
    operator = fem(part.mesh)
    said: tuple[str, ...] = ()
    own, phases = own_unit(inside), None
    if not given or _is_multiple_of_curvature(inside, owner, part, own.unit):
        inside, said = _clipped_curvature(inside)
        own, smoothness = own_unit(inside), smoothness or SMOOTHNESS
    elif smoothness is None:
        phases = _phases(operator, own.normalised(inside), threads, progress)

    def solve(fidelity: Fidelity, operator: SurfaceOperator, start: Solution | None = None) -> Solution:
        return primal_dual(fidelity, operator, start, tolerance=tolerance, progress=progress)

    if phases is None:
        model = ConvexChanVese(smoothness=smoothness or SMOOTHNESS)
        solution = model.run(Image(own.normalised(inside), "map"), operator, solve)
        return _labelled(solution, part, own, (*part.notes, *said))
    bounds = own.restored(np.array([phases.least, phases.largest]))
    said = (f"The map was clipped to the range of the denoised one, {bounds[0]:.3g} to {bounds[1]:.3g}.",)
    image = Image(phases.clipped, "map")
    for halving in range(HALVINGS):
        weight = 0.5**halving
        solution = ConvexChanVese(mu=phases.mu / weight, initial=phases.brighter).run(image, operator, solve)
        if found := 0.0 < solution.metrics["brighter_share"] < 1.0:
            break
    if not found:
        said += (f"A region is empty, also where the length weighs {weight:g} of what the noise asks for.",)
    elif halving:
        said += (
            f"The length weighs {weight:g} of what the noise asks for, for a region was empty before: such a boundary may be "
            "one of noise.",
        )
    return _labelled(solution, part, own, (*part.notes, *said))


def _curvature(surface: Surface, part: SurfacePart) -> Floats:
    """The mean curvature on a part."""
    return np.asarray(part.restrict(mean_curvature(surface)), dtype=np.float64)


def _is_multiple_of_curvature(values: Floats, surface: Surface, part: SurfacePart, unit: float) -> bool:
    """Whether a map is the mean curvature times a number that is not 0."""
    try:
        curvature = _curvature(surface, part)
    except ValueError:
        return False
    own, size = values / unit, float(np.linalg.norm(curvature))
    if size == 0 or not np.ptp(curvature) > 0:
        return False
    factor = float(own @ curvature) / size**2
    return bool(factor != 0 and np.linalg.norm(own - factor * curvature) <= SAME * np.linalg.norm(own))


def _phases(operator: SurfaceOperator, values: Floats, threads: int, progress: Progress | None) -> NoisyPhases | None:
    """The phases of a map in its own unit, or nothing where no noise can be read from it."""
    try:
        return noisy_phases(operator, values, threads, progress)
    except ValueError:
        return None


def _clipped_curvature(curvature: Floats) -> tuple[Floats, tuple[str, ...]]:
    """The mean curvature of a part, clipped at the median of its size, or of what is no rounding, and the note that says so."""
    sizes = np.abs(curvature)
    bound, rounding, where = float(np.percentile(sizes, CLIPPED_AT)), SAME * float(sizes.max()), ""
    if bound <= rounding:
        bound, where = float(np.percentile(sizes[sizes > rounding], CLIPPED_AT)), " where it is not 0"
    note = f"The map is the mean curvature, clipped at ±{bound:.3g}, the median of its size{where}."
    return np.clip(curvature, -bound, bound), (note,)


def _labelled(solution: Solution, part: SurfacePart, own: OwnUnit, notes: tuple[str, ...]) -> Segmentation:
    """The regions of a solution on a part, put back on the whole."""
    assert solution.segmentation is not None and solution.lower_bound is not None  # noqa: S101, narrows a type
    assert solution.relative_gap is not None  # noqa: S101, narrows a type
    labels = np.full(part.whole_count, -1, dtype=np.int64)
    labels[part.vertices] = solution.segmentation.astype(np.int64)
    found = solution.metrics
    return Segmentation(
        labels,
        c1=float(own.restored(np.array(found["c1"]))),
        c2=float(own.restored(np.array(found["c2"]))),
        energy=found["labelling_energy"] * part.length,
        lower_bound=solution.lower_bound * part.length,
        gap=solution.relative_gap,
        labelling_gap=found["labelling_gap"],
        converged=solution.converged,
        perimeter=found["perimeter"] * part.length,
        notes=notes + tuple(solution.notes),
    )
