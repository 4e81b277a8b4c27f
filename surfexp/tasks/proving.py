"""Results as pages that prove themselves: in the browser of who reads them, from the arrays inside."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from surfexp.contract.arrays import Floats
from surfexp.embedding.distance import Distance
from surfexp.embedding.spectral_embedding import Weighting
from surfexp.io.replacing import check_writable, replacing
from surfexp.mesh.surface import Surface
from surfexp.operators.elements_surface import Boundary, Mass
from surfexp.proof.claim import Claim
from surfexp.proof.page import check_size, claims_page
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.tasks.denoised_map import DenoisedMap
from surfexp.tasks.given_surface import SurfaceLike
from surfexp.tasks.part_of_task import part_for
from surfexp.tasks.proved_claims import gap_claim, sign_claims, spectrum_claim


@dataclass(frozen=True, eq=False, repr=False)
class ProofPage:
    """Claims about a result, computed again by the page that states them.

    Parameters
    ----------
    claims : tuple of Claim
    title : str
    """

    claims: tuple[Claim, ...]
    title: str

    def html(self) -> str:
        """Return the page, which loads nothing and runs no script but its own.

        Returns
        -------
        str

        Raises
        ------
        ValueError
            If it would take more than 5 MB.
        """
        return claims_page(self.claims, self.title)

    def save(self, path: Path | str) -> None:
        """Write the page as .html.

        Parameters
        ----------
        path : path

        Raises
        ------
        ValueError
            If the suffix is another one, or the page would take more than 5 MB.
        """
        target = Path(path)
        check_proof_target(target)
        text = self.html()
        with replacing(target) as temporary:
            temporary.write_text(text, encoding="utf-8")

    def __repr__(self) -> str:
        return f"<ProofPage: {len(self.claims)} claims>"


def proof_page(
    result: DenoisedMap | EigenSystem | Distance,
    *surfaces: SurfaceLike,
    mass: Mass = "consistent",
    boundary: Boundary = "neumann",
    weighting: Weighting = "biharmonic",
    tolerance: float = 1e-8,
    title: str = "",
) -> ProofPage:
    """Return a page that proves a result to whoever opens it: its browser computes the certificate again.

    The page holds the arrays and assembles the operator from vertices and faces. Of a denoised map it computes the duality gap.
    Of eigenpairs it computes residuals and the number of eigenvalues below a shift. Of a distance it computes both spectra, the
    bound for every choice of signs, and the nearest points. It shows what it does not prove.

    Parameters
    ----------
    result : DenoisedMap, EigenSystem or Distance
        Of `denoise` by "rof" or "tgv", `eigenpairs` or `distance`.
    *surfaces : Surface, path, or (vertices, faces)
        Those that eigenpairs (one) or a distance (source and target) were computed on; none for a map.
    mass : {"consistent", "lumped"}
    boundary : {"neumann", "dirichlet"}
        As in `eigenpairs`.
    weighting : {"biharmonic", "global_point"}
        As in `distance`.
    tolerance : float
        As in `eigenpairs`.
    title : str

    Returns
    -------
    ProofPage
        `save(path)` writes .html.

    Raises
    ------
    ValueError
        If the result has no such certificate, or does not belong to the surfaces.

    Examples
    --------
    >>> import surfexp as sx
    >>> sphere = sx.shape("icosphere", levels=3)
    >>> page = sx.proof_page(sx.eigenpairs(sphere, 9), sphere)
    >>> page, len(page.html()) < 300_000
    (<ProofPage: 1 claims>, True)
    """
    needed = {DenoisedMap: 0, EigenSystem: 1, Distance: 2}.get(type(result))
    if needed is None:
        raise ValueError(
            f"a {type(result).__name__} has no certificate for a page: give that of denoise, eigenpairs or distance"
        )
    if len(surfaces) != needed:
        raise ValueError(f"{len(surfaces)} surfaces for a {type(result).__name__}, give {needed}")
    if isinstance(result, DenoisedMap):
        return ProofPage((gap_claim(result),), title or f"A map after {result.method}, and its proof")
    if isinstance(result, EigenSystem):
        claim = spectrum_claim(result, surfaces[0], mass, boundary, tolerance)
        return ProofPage((claim,), title or f"{len(result.values)} eigenpairs, and their proof")
    return ProofPage(
        sign_claims(result, surfaces[0], surfaces[1], weighting), title or "A spectral distance, and its proof"
    )


def check_proof_size(surface: Surface, *maps: Floats, columns: int, of_faces: int = 0) -> None:
    """Refuse a surface with which a page would be too large, by the least that its arrays take.

    Parameters
    ----------
    surface : Surface
    *maps : (n,) or (n, c) float64
        Outside of which nothing is computed.
    columns, of_faces : int
        How many numbers the page has for each vertex, beside its position, and for each face, beside its corners.

    Raises
    ------
    ValueError
        As `claims_page`.
    """
    mesh = part_for(surface, *maps).mesh
    # in base64
    check_size((len(mesh.vertices) * (24 + 8 * columns) + len(mesh.faces) * (12 + 8 * of_faces)) * 4 // 3)


def check_proof_target(target: Path) -> None:
    """Refuse a file that no page can be written to.

    Raises
    ------
    ValueError
        Naming the format.
    """
    if target.suffix.lower() != ".html":
        raise ValueError(f"{target} cannot hold a page of proof: choose .html")
    check_writable(target)
