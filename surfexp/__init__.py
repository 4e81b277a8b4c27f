"""Intrinsic surface processing: total variation and Laplace-Beltrami eigen-geometry on triangle meshes, with certificates."""

from __future__ import annotations

import importlib
from importlib.metadata import PackageNotFoundError, version
from typing import TYPE_CHECKING, Any

from surfexp.face import FACE

if TYPE_CHECKING:
    from surfexp.experiments import load as load
    from surfexp.experiments import run as run
    from surfexp.linalg.ldlt import ldlt as ldlt
    from surfexp.mesh.surface import Surface as Surface
    from surfexp.tasks.comparison_of_maps import compare_maps as compare_maps
    from surfexp.tasks.denoising import denoise as denoise
    from surfexp.tasks.denoising import smooth as smooth
    from surfexp.tasks.denoising_path import denoise_path as denoise_path
    from surfexp.tasks.distance_transformer import SpectralDistance as SpectralDistance
    from surfexp.tasks.distances import distance as distance
    from surfexp.tasks.files import read as read
    from surfexp.tasks.fingerprints import fingerprint as fingerprint
    from surfexp.tasks.mode_alignment import align as align
    from surfexp.tasks.noise_of_map import noise as noise
    from surfexp.tasks.null_maps import null_maps as null_maps
    from surfexp.tasks.parcellation import parcels as parcels
    from surfexp.tasks.permutation_testing import permutation_test as permutation_test
    from surfexp.tasks.pictures import plot as plot
    from surfexp.tasks.proving import proof_page as proof_page
    from surfexp.tasks.reeb_distances import check_reeb_distance as check_reeb_distance
    from surfexp.tasks.reeb_distances import reeb_distance as reeb_distance
    from surfexp.tasks.repairing import check as check
    from surfexp.tasks.repairing import repair as repair
    from surfexp.tasks.segmentation import segment as segment
    from surfexp.tasks.shapes import shape as shape
    from surfexp.tasks.signature_transformers import NodalCounts as NodalCounts
    from surfexp.tasks.signature_transformers import ShapeDNA as ShapeDNA
    from surfexp.tasks.skeletons import geodesic as geodesic
    from surfexp.tasks.skeletons import mean_curvature as mean_curvature
    from surfexp.tasks.skeletons import reeb_graph as reeb_graph
    from surfexp.tasks.solids import Solid as Solid
    from surfexp.tasks.spectra import eigenpairs as eigenpairs
    from surfexp.tasks.spectra import eigsh as eigsh
    from surfexp.tasks.spectrum_of_surface import Spectrum as Spectrum
    from surfexp.tasks.viewing import view as view
    from surfexp.tasks.written_files import write as write

try:
    __version__ = version("surfexp")
except PackageNotFoundError:
    __version__ = "0"

__all__ = ["__version__", *FACE]


def __getattr__(name: str) -> Any:
    if name not in FACE:
        raise AttributeError(f"module 'surfexp' has no attribute {name!r}")
    try:
        return getattr(importlib.import_module(FACE[name]), name)
    except ModuleNotFoundError as error:
        from surfexp.extras import MissingExtra, missing_line, missing_module

        if missing := missing_module(error):
            raise MissingExtra(missing_line(f"sx.{name}", [missing])) from None
        raise


def __dir__() -> list[str]:
    return sorted(__all__)
