"""What rides along with a surface is written again."""

from __future__ import annotations

import gzip
import warnings
from pathlib import Path

import nibabel
import numpy as np
import pytest
from nibabel.freesurfer import read_geometry, write_geometry

import surfexp as sx
from surfexp.io.gifti import write_gifti
from surfexp.mesh.shapes.icosphere import icosphere

MESH = icosphere(1).mesh
VOLUME = {
    "head": np.array([2, 0, 20], np.int32),
    "valid": "1  # volume info valid",
    "filename": "../mri/filled.mgz",
    "volume": np.array([256, 256, 256]),
    "voxelsize": np.ones(3),
    "xras": np.array([-1.0, 0, 0]),
    "yras": np.array([0.0, 0, -1]),
    "zras": np.array([0.0, 1, 0]),
    "cras": np.array([5.4, 18.0, -2.5]),
}


@pytest.mark.parametrize("head", [[20], [2, 0, 20], [2, 1, 20]])
def test_coordinates_of_the_scanner_stay_such_byte_for_byte(tmp_path: Path, head: list[int]) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # nibabel does not know the third
        write_geometry(tmp_path / "lh.white", MESH.vertices, MESH.faces, volume_info={**VOLUME, "head": np.array(head)})
    surface = sx.read(tmp_path / "lh.white")
    assert surface.frame.volume["head"].tolist() == head
    assert surface.frame.volume["cras"].tolist() == [5.4, 18.0, -2.5] and surface.unit == "mm"
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        sx.write(tmp_path / "lh.copy", surface)
    before, after = ((tmp_path / name).read_bytes() for name in ("lh.white", "lh.copy"))
    faces = MESH.faces.astype(">i4").tobytes()
    assert before.partition(faces)[2] == after.partition(faces)[2] != b""


def test_of_several_transforms_one_is_kept_which_is_said(tmp_path: Path) -> None:
    file, packed = tmp_path / "a.surf.gii", tmp_path / "b.surf.gii.gz"
    sx.write(file, MESH)
    assert sx.read(file).notes == ()
    text = file.read_text()
    begin, end = text.index("<CoordinateSystemTransformMatrix"), text.index("</CoordinateSystemTransformMatrix>")
    block = text[begin : end + len("</CoordinateSystemTransformMatrix>")]
    file.write_text(text.replace(block, block + block.replace("1.000000", "3.000000"), 1))
    packed.write_bytes(gzip.compress(file.read_bytes()))
    for path in (file, packed):
        found = sx.read(path)
        assert found.notes == ("Its points have 2 coordinate transforms: the last is kept.",)
        assert [transform.matrix[0, 0] for transform in found.frame.transforms] == [3.0]


@pytest.mark.parametrize("volume", [VOLUME, None])
def test_freesurfer_volume_geometry_is_carried(tmp_path: Path, volume: dict[str, object] | None) -> None:
    write_geometry(tmp_path / "lh.white", MESH.vertices, MESH.faces, volume_info=volume)
    surface = sx.read(tmp_path / "lh.white")
    sx.write(tmp_path / "lh.copy", surface)
    again = read_geometry(tmp_path / "lh.copy", read_metadata=True)[2] if volume else {}
    assert set(again) == set(volume or {})
    assert not volume or np.array_equal(again["cras"], VOLUME["cras"])
    assert bool(surface.frame.lost_in("GIFTI")) == bool(volume) and surface.frame.lost_in("FreeSurfer") == ""


def test_gifti_transform_metadata_and_maps_are_carried(tmp_path: Path) -> None:
    gifti = nibabel.gifti
    matrix = np.diag([2.0, 2.0, 2.0, 1.0])
    matrix[:3, 3] = 10, 20, 30
    points = gifti.GiftiDataArray(
        MESH.vertices.astype(np.float32),
        "NIFTI_INTENT_POINTSET",
        coordsys=gifti.GiftiCoordSystem(1, 3, matrix),
        meta=gifti.GiftiMetaData({"AnatomicalStructurePrimary": "CortexRight", "GeometricType": "Anatomical"}),
    )
    faces = gifti.GiftiDataArray(MESH.faces.astype(np.int32), "NIFTI_INTENT_TRIANGLE")
    height = MESH.vertices[:, 2].astype(np.float32)
    thick = gifti.GiftiDataArray(height, "NIFTI_INTENT_SHAPE", meta=gifti.GiftiMetaData({"Name": "thick"}))
    nibabel.save(gifti.GiftiImage(darrays=[points, faces, thick]), tmp_path / "a.surf.gii")
    surface = sx.read(tmp_path / "a.surf.gii")
    assert np.array_equal(surface.scalars["thick"], height) and surface.hemisphere == "right"
    sx.write(tmp_path / "b.surf.gii", surface)
    array = nibabel.load(tmp_path / "b.surf.gii").darrays[0]
    assert np.array_equal(np.reshape(array.coordsys.xform, (4, 4)), matrix)
    assert (array.coordsys.dataspace, array.coordsys.xformspace) == (1, 3)
    assert array.metadata["GeometricType"] == "Anatomical"
    assert "coordinate transforms" in surface.frame.lost_in("PLY") and surface.frame.lost_in("GIFTI") == ""


@pytest.mark.parametrize("place", ["image", "array"])
@pytest.mark.parametrize("side", ["left", "right"])
def test_the_hemisphere_of_a_gifti_is_read_wherever_it_stands(tmp_path: Path, place: str, side: str) -> None:
    """Workbench writes it beside the file's other facts, FreeSurfer beside the positions; the name says nothing here."""
    path = tmp_path / "some.surf.gii"
    write_gifti(path, MESH, side, None)
    image = nibabel.load(path)
    said = {"AnatomicalStructurePrimary": f"Cortex{side.title()}"}
    image.meta = nibabel.gifti.GiftiMetaData(said if place == "image" else {})
    for array in image.darrays:
        array.meta = nibabel.gifti.GiftiMetaData(said if place == "array" else {})
    nibabel.save(image, path)
    assert sx.read(path).hemisphere == side
