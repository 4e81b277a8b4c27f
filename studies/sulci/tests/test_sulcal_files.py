"""Named sulci for three tools."""

from __future__ import annotations

import numpy as np

from surfexp.io.label_files import read_labels
from surfexp.io.vtk import write_vtk
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp_studies.sulci.sulcal_export import export_sulci, sulcus_names
from surfexp_studies.sulci.sulcal_measurement import NamedSulci


def test_sulci_are_exported_for_three_tools(tmp_path) -> None:
    from surfexp.mesh.surface import Surface

    mesh = icosphere(2).mesh
    own = np.where(mesh.vertices[:, 2] > 0.5, 1, -1)
    named = NamedSulci(np.arange(len(own)), np.full(len(own), 2), own)
    files = export_sulci(tmp_path / "out", "left @ anna", Surface(mesh), named, 3)
    assert [file.name for file in files] == ["left_anna.label.gii", "left_anna.annot", "left_anna.vtk"]
    for file in files[:2]:
        labels, names = read_labels(file)
        assert np.array_equal(labels, own + 1) and names == sulcus_names(3)
    write_vtk(tmp_path / "left_anna.vtk", mesh, {"own region": own + 1.0, "carried region": np.full(len(own), 3.0)})
    assert files[2].read_text() == (tmp_path / "left_anna.vtk").read_text()
