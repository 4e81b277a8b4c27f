"""The declared table is what the solvers really accept."""

from functools import partial

import numpy as np
import pytest

from surfexp.mesh.surface import Surface
from surfexp.operators.fem import fem
from surfexp.operators.vertex_averaged import vertex_averaged
from surfexp.variational.image import Image
from surfexp.variational.models.convex_chan_vese import ConvexChanVese
from surfexp.variational.models.deblurring import Deblurring
from surfexp.variational.models.inpainting import Inpainting
from surfexp.variational.models.multiphase import MultiphaseSegmentation
from surfexp.variational.models.rof import ROF
from surfexp.variational.published.chambolle import published_chambolle
from surfexp.variational.published.split_bregman import published_split_bregman
from surfexp.variational.requirements import SOLVABLE_MODELS, check_combination
from surfexp.variational.solvers.chambolle_dual import chambolle_dual
from surfexp.variational.solvers.fista_dual import fista_dual
from surfexp.variational.solvers.gradient_descent import gradient_descent
from surfexp.variational.solvers.newton import newton
from surfexp.variational.solvers.primal_dual import primal_dual
from surfexp.variational.solvers.split_bregman import split_bregman

SOLVERS = [
    *(primal_dual, split_bregman, gradient_descent, chambolle_dual, fista_dual, newton),
    *(published_split_bregman, published_chambolle),
]
MODELS = {
    "rof": ROF(),
    "vectorial_rof": ROF(),
    "inpainting": Inpainting(),
    "deblurring": Deblurring(),
    "convex_chan_vese": ConvexChanVese(updates=1),
    "multiphase": MultiphaseSegmentation(updates=1),
}


@pytest.mark.parametrize("consistent", [True, False])
@pytest.mark.parametrize("solver", SOLVERS, ids=lambda solver: solver.__name__)
def test_table(surface: Surface, image: Image, solver: object, consistent: bool) -> None:
    operator = fem(surface.mesh) if consistent else vertex_averaged(surface.mesh)
    for name, model in MODELS.items():
        given = image
        if name == "vectorial_rof":
            given = Image(np.stack([image.values, image.values[::-1]], axis=1), noise=40.0)
        try:
            check_combination(solver.__name__, name, consistent)  # type: ignore[attr-defined]
            declared = True
        except ValueError as error:
            assert "choose one of" in str(error) or "needs a consistent operator" in str(error)
            declared = False
        method = partial(solver, iteration_limit=2)  # type: ignore[call-overload]
        if declared:
            assert model.run(given, operator, method).iterations <= 2
        else:
            with pytest.raises(ValueError, match=r"use|not|needs|solves"):
                model.run(given, operator, method)


def test_unknown_names_are_told_the_known_ones() -> None:
    with pytest.raises(ValueError, match="model 'rov' is unknown, choose one of chan_vese, convex_chan_vese"):
        check_combination("newton", "rov")
    with pytest.raises(ValueError, match="choose one of primal_dual"):
        check_combination("newton", "inpainting")
    assert "newton" in SOLVABLE_MODELS
