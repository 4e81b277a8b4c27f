"""What may not change the result: motions, relabelling, scaling of the surface, affine changes of the image."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.fem import fem
from surfexp.variational.image import Image
from surfexp.variational.models.convex_chan_vese import ConvexChanVese
from surfexp.variational.models.rof import ROF
from surfexp.variational.solvers.newton import newton
from surfexp.variational.solvers.primal_dual import primal_dual

SETTINGS = settings(deadline=None, max_examples=5)


def denoise(mesh: TriangleMesh, image: Image) -> np.ndarray:
    solution = ROF().run(image, fem(mesh), newton)
    assert solution.relative_gap is not None and solution.relative_gap <= 1e-10
    return solution.values


@pytest.fixture(scope="module")
def reference(surface: Surface, image: Image) -> np.ndarray:
    return denoise(surface.mesh, image)


@SETTINGS
@given(seed=st.integers(0, 1000), scale=st.floats(1e-2, 1e2))
def test_rotation_and_scaling(surface: Surface, image: Image, reference: np.ndarray, seed: int, scale: float) -> None:
    turned = scale * Rotation.random(rng=np.random.default_rng(seed)).apply(surface.mesh.vertices.copy()) + 3.0
    assert np.abs(denoise(TriangleMesh(turned, surface.mesh.faces), image) - reference).max() <= 0.05


@SETTINGS
@given(seed=st.integers(0, 1000))
def test_relabelling(surface: Surface, image: Image, reference: np.ndarray, seed: int) -> None:
    rng = np.random.default_rng(seed)
    order = rng.permutation(len(reference))
    number = np.argsort(order)
    faces = number[surface.mesh.faces][rng.permutation(len(surface.mesh.faces))]
    faces = np.stack([np.roll(face, shift) for face, shift in zip(faces, rng.integers(0, 3, len(faces)), strict=True)])
    renamed = replace(image, values=image.values[order], clean=None, known=None, labels={})
    assert np.abs(denoise(TriangleMesh(surface.mesh.vertices[order], faces), renamed) - reference[order]).max() <= 0.05


@SETTINGS
@given(factor=st.floats(0.01, 100.0), shift=st.floats(-1e3, 1e3))
def test_affine_images(surface: Surface, image: Image, reference: np.ndarray, factor: float, shift: float) -> None:
    changed = replace(image, values=factor * image.values + shift, noise=factor * image.noise)
    assert np.abs((denoise(surface.mesh, changed) - shift) / factor - reference).max() <= 0.05
    first, second = (ConvexChanVese().run(i, fem(surface.mesh), primal_dual) for i in (image, changed))
    assert (first.segmentation == second.segmentation).all()


def test_mean_is_kept(surface: Surface, image: Image, reference: np.ndarray) -> None:
    mass = fem(surface.mesh).mass
    assert mass @ reference == pytest.approx(mass @ image.values, rel=1e-9)


def test_vector_total_variation_does_not_depend_on_the_axes(surface: Surface) -> None:
    rng, operator = np.random.default_rng(0), fem(surface.mesh)
    colours = rng.normal(size=(operator.vertex_count, 3))
    turn = Rotation.from_rotvec([0.3, -1.0, 0.5]).as_matrix()
    for by_channel, least, most in ((False, 0.0, 0.02), (True, 0.05, 1.0)):
        model = ROF(mu=2.0 / operator.edge_length, by_channel=by_channel)
        plain, turned = (
            model.run(Image(c), operator, lambda f, o, s=None: primal_dual(f, o, s, tolerance=1e-7)).values
            for c in (colours, colours @ turn)
        )
        assert least <= np.abs(plain @ turn - turned).max() <= most
