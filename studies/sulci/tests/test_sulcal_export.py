"""Named sulci leave as files that other programs open."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import numpy as np

from surfexp.io.label_files import read_labels
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp_studies.sulci.sulcal_export import export_sulci, sulcus_names


def test_labels_of_both_files_are_those_of_the_regions(tmp_path: Path) -> None:
    surface = icosphere(2)
    own = np.arange(len(surface.mesh.vertices)) % 4 - 1
    named = SimpleNamespace(own=own, carried=np.roll(own, 1))
    files = export_sulci(tmp_path / "new" / "folder", "my brain/left", surface, named, 3)  # type: ignore[arg-type]
    assert [file.name for file in files] == [f"my_brain_left{suffix}" for suffix in (".label.gii", ".annot", ".vtk")]
    for file in files[:2]:
        labels, names = read_labels(file)
        assert names == sulcus_names(3) and (labels == own + 1).all()
