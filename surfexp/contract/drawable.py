"""Results that are drawn on their surface."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from surfexp.contract.summary import Summarized


class Drawable(Summarized):
    """A result that `surfexp.plot` and `surfexp.view` know how to show; it does not hold its surface."""

    def plot(self, surface: Any, **options: Any) -> Any:
        """Draw the result on its surface: the same as ``surfexp.plot(surface, result, **options)``.

        Parameters
        ----------
        surface : Surface, path, or (vertices, faces)
            That of which it was made; of a distance the list of both.
        **options
            Those of `surfexp.plot`.

        Returns
        -------
        Picture
            `save(path)` writes .png, .svg or .pdf.

        Raises
        ------
        ValueError
            If it is not the surface.

        Examples
        --------
        >>> import surfexp as sx
        >>> sphere = sx.shape("icosphere", levels=3)
        >>> sx.eigenpairs(sphere, 5).plot(sphere, width=400)
        <Picture: 400 by 1795 pixels>
        """
        # by name: drawing stands above what is drawn
        return import_module("surfexp").plot(surface, self, **options)
