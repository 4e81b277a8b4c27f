"""Models: better than their input, right where the truth is known, sound at their limits."""

from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import pytest

from surfexp.mesh.shapes.torus import torus
from surfexp.mesh.surface import Surface
from surfexp.operators.calculus import total_variation
from surfexp.operators.fem import fem
from surfexp.variational.fidelity import Method
from surfexp.variational.heat_blur import HeatBlur
from surfexp.variational.image import Image
from surfexp.variational.images.painting import add_noise
from surfexp.variational.images.two_phase import coloured_cells
from surfexp.variational.level_sets import perimeters
from surfexp.variational.models.chan_vese import ChanVese
from surfexp.variational.models.convex_chan_vese import ConvexChanVese
from surfexp.variational.models.deblurring import Deblurring
from surfexp.variational.models.inpainting import Inpainting
from surfexp.variational.models.multiphase import MultiphaseSegmentation
from surfexp.variational.models.rof import ROF
from surfexp.variational.separable_quadratic import inpainting, rof
from surfexp.variational.solvers.newton import newton
from surfexp.variational.solvers.primal_dual import primal_dual
from surfexp.variational.solvers.split_bregman import split_bregman

METHODS: list[Method] = [primal_dual, split_bregman]


def error(values: np.ndarray, clean: np.ndarray, mass: np.ndarray) -> float:
    return float(np.sqrt(mass @ (values - clean) ** 2 / mass.sum()))


@pytest.mark.parametrize("method", METHODS)
def test_rof_lowers_the_error(surface: Surface, image: Image, method: Method) -> None:
    operator = fem(surface.mesh)
    solution = ROF().run(image, operator, method)
    assert solution.metrics["rmse"] == pytest.approx(error(solution.values, image.clean, operator.mass))
    assert solution.metrics["rmse"] < 0.7 * error(image.values, image.clean, operator.mass)
    assert solution.metrics["psnr"] == pytest.approx(20 * np.log10(255 / solution.metrics["rmse"]))
    exact = newton(ROF().fidelity(image, operator), operator)
    distance = np.sqrt(operator.mass @ (solution.values - exact.values) ** 2)
    assert distance <= solution.error_bound + exact.error_bound
    assert (np.diff(solution.history["iteration"]) > 0).all()


def test_rof_limits(surface: Surface, image: Image) -> None:
    operator = fem(surface.mesh)
    mean = operator.mass @ image.values / operator.mass.sum()
    flat = ROF(mu=1e-4).run(image, operator, newton)
    assert np.abs(flat.values - mean).max() <= 1e-3
    sharp = ROF(mu=1e6).run(image, operator, newton)
    assert np.abs(sharp.values - image.values).max() <= 1e-2
    constant = ROF().run(Image(np.full_like(image.values, 7.0), noise=1.0), operator, primal_dual)
    assert constant.converged and np.abs(constant.values - 7.0).max() <= 1e-12


@pytest.mark.parametrize("method", METHODS)
def test_inpainting_fills_the_hole_within_the_box(surface: Surface, image: Image, method: Method) -> None:
    operator = fem(surface.mesh)
    clean = replace(image, values=np.where(image.known, image.clean, 128.0))
    solution = Inpainting(mu=100.0).run(clean, operator, partial(method, tolerance=1e-5))
    hole = ~image.known
    assert solution.values.min() >= 0 and solution.values.max() <= 255
    assert error(solution.values[hole], image.clean[hole], operator.mass[hole]) < 60
    assert np.abs(solution.values - image.clean)[image.known].max() < 5
    assert solution.error_bound is None and solution.relative_gap <= 1e-5


@pytest.mark.parametrize("method", METHODS)
def test_deblurring_sharpens(surface: Surface, image: Image, method: Method) -> None:
    operator = fem(surface.mesh)
    blur = HeatBlur(operator, image.clean, 1.0, 0.5 * operator.edge_length**2)
    mean = operator.mass @ image.clean
    assert operator.mass @ blur.blur(image.clean) == pytest.approx(mean)
    noisy = blur.blur(image.clean) + np.random.default_rng(0).normal(0, 5, len(image.clean))
    solution = Deblurring(width=1.0).run(Image(noisy, clean=image.clean, noise=5.0), operator, method)
    assert solution.converged and solution.metrics["rmse"] < 0.7 * error(noisy, image.clean, operator.mass)


@pytest.mark.parametrize("method", METHODS)
def test_convex_chan_vese_finds_the_regions(surface: Surface, image: Image, method: Method) -> None:
    operator = fem(surface.mesh)
    solution = ConvexChanVese(smoothness=0.3).run(image, operator, method)
    assert solution.converged and solution.segmentation is not None
    assert solution.metrics["dice bright"] > 0.97
    assert solution.metrics["c1"] == pytest.approx(255, abs=8) and solution.metrics["c2"] == pytest.approx(0, abs=8)
    assert solution.metrics["labelling_energy"] >= solution.energy >= solution.metrics["lower_bound"]
    field, level = solution.boundary
    assert ((field > level) == (solution.segmentation > 0.5)).all()
    assert perimeters(operator, field, np.array([level]))[0] == pytest.approx(solution.metrics["perimeter"])
    assert set(np.unique(solution.segmentation)) == {0.0, 1.0}
    # phi stays in the box of (2.19), and reaches both ends where the regions are clear
    assert field.min() == 0.0 and field.max() == 1.0


def test_means_that_are_not_divided_by_the_area_do_not_settle(surface: Surface, image: Image) -> None:
    operator = fem(surface.mesh)
    published = ConvexChanVese(smoothness=0.3, divide_by_area=False, updates=6).run(
        image, operator, partial(primal_dual, tolerance=1e-4)
    )
    assert not published.converged and "repeat with period" in published.reason
    assert ConvexChanVese(smoothness=0.3, updates=6).run(image, operator, primal_dual).converged


def test_a_region_that_vanishes_keeps_its_mean(surface: Surface, image: Image) -> None:
    operator = fem(surface.mesh)
    speck = np.zeros(len(image.values))
    speck[7] = 1.0
    solution = ConvexChanVese(smoothness=50.0).run(Image(speck), operator, primal_dual)
    assert solution.metrics["c1"] == 1.0 and any("c1 is empty" in note or "c1 keeps" in note for note in solution.notes)
    assert not solution.segmentation.any()


def test_multiphase_with_two_regions_is_convex_chan_vese(surface: Surface, image: Image) -> None:
    """With 2 labels |D(u, 1 - u)|_F / sqrt 2 is |Du|; both models then have the same segmentation."""
    operator = fem(surface.mesh)
    method = partial(primal_dual, tolerance=1e-5)
    mu = 2.0 / (255.0**2 * operator.edge_length)
    two = MultiphaseSegmentation(2, mu=mu).run(image, operator, method)
    convex = ConvexChanVese(mu=mu).run(image, operator, method)
    assert (two.segmentation == (convex.values > 0.5)).mean() > 0.997
    assert two.metrics["dice bright"] > 0.97 and two.converged


def test_multiphase_separates_three_colours(surface: Surface) -> None:
    u = surface.coordinates[:, 0]
    phase = np.digitize(np.sin(u), [-0.4, 0.4])
    colours = np.array([[0, 0, 100.0], [50, 100, 0], [100, 20, 20]])[phase]
    noisy = colours + np.random.default_rng(0).normal(0, 25, colours.shape)
    labels = {f"phase {j}": phase == j for j in range(3)}
    solution = MultiphaseSegmentation(3, smoothness=0.3).run(
        Image(noisy, labels=labels), fem(surface.mesh), primal_dual
    )
    assert solution.metrics["least_dice"] == min(solution.metrics[f"dice phase {j}"] for j in range(3)) > 0.96
    with pytest.raises(ValueError, match="regions is 1"):
        MultiphaseSegmentation(1).run(Image(noisy), fem(surface.mesh), primal_dual)


@pytest.mark.slow
def test_multiphase_separates_six_noisy_colours() -> None:
    """The first means have to be those of the cells: the alternation cannot part two that begin as one."""
    surface = torus(120, 48)
    cells = add_noise(coloured_cells(surface, 6), 40.0)
    solution = MultiphaseSegmentation(6, updates=20).run(cells, fem(surface.mesh), primal_dual)
    assert solution.converged and solution.metrics["least_dice"] > 0.9


def test_nonconvex_chan_vese_descends_and_depends_on_the_initial_curve(surface: Surface, image: Image) -> None:
    operator = fem(surface.mesh)
    good = ChanVese(smoothness=0.3).run(image, operator)
    assert good.metrics["dice bright"] > 0.95 and good.relative_gap is None
    speck = np.zeros(len(image.values), dtype=bool)
    speck[surface.mesh.faces[5]] = True
    other = ChanVese(smoothness=0.3, initial=speck, iteration_limit=300).run(image, operator)
    assert abs(other.energy - good.energy) > 0.01 * good.energy


def test_nonconvex_chan_vese_records_the_energy_of_its_own_means(surface: Surface, image: Image) -> None:
    """The energy, written out again here, falls at each step and is stationary in c1 and c2 at the end."""
    operator = fem(surface.mesh)
    mu, mass = 1e-3, operator.mass
    end = ChanVese(mu=mu).run(image, operator)
    assert (np.diff(end.history["energy"]) <= 0.0).all()
    inside = 0.5 + np.arctan(end.values) / np.pi

    def energy(c1: float, c2: float) -> float:
        misfit = (image.values - c1) ** 2 * inside + (image.values - c2) ** 2 * (1.0 - inside)
        return total_variation(operator, inside) + mu * float(mass @ misfit)

    c1, c2 = end.metrics["c1"], end.metrics["c2"]
    assert end.energy == pytest.approx(energy(c1, c2), rel=1e-3)
    for moved in (energy(c1 + 1, c2), energy(c1 - 1, c2), energy(c1, c2 + 1), energy(c1, c2 - 1)):
        assert moved > energy(c1, c2)
    assert energy(c1 + 1, c2) == pytest.approx(energy(c1 - 1, c2), rel=1e-9)
    assert energy(c1, c2 + 1) == pytest.approx(energy(c1, c2 - 1), rel=1e-9)
    steps = [ChanVese(mu=mu, iteration_limit=limit).run(image, operator).energy for limit in (20, 80)]
    assert steps[0] > steps[1] > end.energy


@dataclass(frozen=True, eq=False)
class AbsoluteDeviation:
    """A user's H(phi) = mu sum m |phi - I|, given by value, prox and dual value."""

    mass: np.ndarray
    image: np.ndarray
    mu: float
    name: str = "TV-L1"
    strong_convexity: float = 0.0
    step: float = 0.05

    @property
    def shape(self) -> tuple[int, ...]:
        return self.image.shape

    def value(self, values: np.ndarray) -> float:
        return self.mu * float(self.mass @ np.abs(values - self.image))

    def prox(self, values: np.ndarray, step: float) -> np.ndarray:
        return self.image + np.sign(values - self.image) * np.maximum(np.abs(values - self.image) - step * self.mu, 0)

    def dual_value(self, load: np.ndarray) -> float:
        return float(load @ self.image) if (np.abs(load) <= self.mu * self.mass * (1 + 1e-12)).all() else -np.inf

    def primal_from_dual(self, load: np.ndarray) -> None:
        return None

    def initial(self) -> np.ndarray:
        return self.image

    @property
    def tolerance(self) -> float:
        return 1e-4

    def gap_scale(self, energy: float, lower_bound: float) -> float:
        return energy


def test_any_convex_fidelity_works_by_its_value_and_prox(surface: Surface) -> None:
    """TV-L1 keeps the contrast of what it keeps, and removes a speck altogether."""
    operator = fem(surface.mesh)
    truth = (surface.mesh.vertices[:, 0] > 0).astype(float)
    dirty = truth.copy()
    specks = [np.argmax(surface.mesh.vertices[:, 0]), np.argmin(surface.mesh.vertices[:, 0])]
    dirty[specks] = 1 - dirty[specks]
    fidelity = AbsoluteDeviation(operator.mass, dirty, 2.0)
    first = primal_dual(fidelity, operator, iteration_limit=4000)
    second = split_bregman(fidelity, operator, iteration_limit=4000)
    assert first.energy == pytest.approx(second.energy, rel=1e-3)
    assert first.energy < fidelity.value(dirty) + total_variation(operator, dirty)
    assert np.abs(first.values - truth)[specks].max() < 0.05
    assert operator.mass @ np.abs(first.values - truth) < 0.02 * operator.mass.sum()


@pytest.mark.parametrize(
    ("message", "act"),
    [
        (
            "constant at 3.0",
            lambda s, i: ConvexChanVese().run(Image(np.full(len(i.values), 3.0)), fem(s.mesh), primal_dual),
        ),
        ("smoothness is 0", lambda s, i: ConvexChanVese(smoothness=0).run(i, fem(s.mesh), primal_dual)),
        ("initial has 3", lambda s, i: ConvexChanVese(initial=np.ones(3, bool)).run(i, fem(s.mesh), primal_dual)),
        ("updates is 0", lambda s, i: ConvexChanVese(updates=0).run(i, fem(s.mesh), primal_dual)),
        ("noise 0.0", lambda s, i: ROF().run(Image(i.values, clean=i.values), fem(s.mesh), primal_dual)),
        ("weight is -1", lambda s, i: ROF(weight=-1).run(i, fem(s.mesh), primal_dual)),
        ("mu is 0", lambda s, i: ROF(mu=0).run(i, fem(s.mesh), primal_dual)),
        ("does not say which", lambda s, i: Inpainting().run(Image(i.values, noise=1.0), fem(s.mesh), primal_dual)),
        ("image has 10 values", lambda s, i: ROF(mu=1).run(Image(np.arange(10.0)), fem(s.mesh), primal_dual)),
        ("width is 0", lambda s, i: Deblurring(width=0).run(i, fem(s.mesh), primal_dual)),
    ],
)
def test_bad_input_is_refused_by_name(surface: Surface, image: Image, message: str, act: object) -> None:
    with pytest.raises(ValueError, match=message):
        act(surface, image)  # type: ignore[operator]


def test_no_fidelity_claims_more_strong_convexity_than_it_has(surface: Surface, image: Image) -> None:
    """H((u + v) / 2) <= (H(u) + H(v)) / 2 - mu/8 |u - v|^2, and no larger mu holds but for HeatBlur, whose mu is 0."""
    operator = fem(surface.mesh)
    known = surface.mesh.vertices[:, 0] > 0.0
    random = np.random.default_rng(0)
    terms = [rof(operator.mass, image.values, 0.7), inpainting(operator.mass, image.values, known, 0.7)]
    for fidelity in [*terms, HeatBlur(operator, image.values, 3.0, 4.0 * operator.edge_length**2)]:
        box = getattr(fidelity, "lower", -np.inf), getattr(fidelity, "upper", np.inf)
        u, v = np.clip(image.values + random.normal(size=(2, len(image.values))), *box)
        bent = 0.5 * (fidelity.value(u) + fidelity.value(v)) - fidelity.value(0.5 * (u + v))
        claimed = fidelity.strong_convexity / 8.0 * float(operator.mass @ (u - v) ** 2)
        assert claimed <= bent * (1.0 + 1e-6)
