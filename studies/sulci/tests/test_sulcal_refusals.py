"""What has no line, and what is no template."""

from __future__ import annotations

import numpy as np
import pytest

from surfexp.mesh.shapes.icosphere import icosphere
from surfexp_studies.sulci.sulcal_lines import sulcal_line
from surfexp_studies.sulci.sulcal_template import make_template

BALL = icosphere(2)


def test_a_line_of_one_face_is_refused() -> None:
    face = np.isin(np.arange(len(BALL.mesh.vertices)), BALL.mesh.faces[0])
    with pytest.raises(ValueError, match="a line needs at least 4"):
        sulcal_line(BALL.mesh, face)


def test_a_template_without_regions_is_refused() -> None:
    with pytest.raises(ValueError, match="0 regions are to be measured"):
        make_template(BALL, 0)
