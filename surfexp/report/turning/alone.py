"""One picture that turns, as a page of its own: to be put into another page, or sent."""

from __future__ import annotations

import base64

from surfexp.figures.encode import encode_png
from surfexp.figures.figure import Figure
from surfexp.report.render import render
from surfexp.report.turning.payload import Payload
from surfexp.report.turning.scene import Scene
from surfexp.report.turning.turning import SCRIPTS


def turning_picture(scene: Scene, figure: Figure) -> str:
    """Return a page with the still picture and its caption, which turns as those of a report do.

    Parameters
    ----------
    scene : Scene
    figure : Figure
        What is seen at first, on paper, and where no script runs.

    Returns
    -------
    str
        HTML that needs no other file.

    Raises
    ------
    ValueError
        If the surfaces take more than a page may.
    """
    payload = Payload()
    described = payload.add(scene)
    picture = f"data:image/png;base64,{base64.b64encode(encode_png(figure.pixels)).decode()}"
    return render("turning.html.j2", SCRIPTS, scene=described, arrays=payload.arrays, figure=figure, picture=picture)
