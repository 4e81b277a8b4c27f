"""Maps and labels: what is written is what the tool that owns the format reads, and back; what is unfit is refused."""

from __future__ import annotations

import csv
import gzip
import zipfile
from itertools import product
from pathlib import Path

import nibabel
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from nibabel import cifti2

from surfexp.io.freesurfer_sizes import check_volume
from surfexp.io.hemisphere import hemisphere_of_file
from surfexp.io.map_files import read_maps, read_mask, read_scalars
from surfexp.io.npz import write_arrays
from surfexp.io.reading import read_mesh
from surfexp.io.text_tables import read_table, write_table
from surfexp.io.writing import write_mesh
from surfexp.io.written_maps import write_maps
from surfexp.mesh.shapes.icosphere import icosphere

MESH = icosphere(2).mesh
N = len(MESH.vertices)
VALUES = np.random.default_rng(0).standard_normal(N)
WITH_NAN = np.where(np.arange(N) % 7 == 0, np.nan, VALUES)
SINGLE = (".shape.gii", ".func.gii", ".dscalar.nii", ".mgh", ".mgz")
DOUBLE = (".npy", ".npz", ".csv", ".txt")


@pytest.mark.parametrize("suffix", SINGLE + DOUBLE)
def test_a_map_with_nan_comes_back(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"thickness{suffix}"
    write_maps(path, {"map": WITH_NAN}, "left")
    found = read_scalars(path, "left")
    expected = WITH_NAN.astype(np.float32).astype(np.float64) if suffix in SINGLE else WITH_NAN
    assert np.array_equal(found, expected, equal_nan=True)


@given(arrays(np.float64, st.integers(1, 40), elements=st.floats(allow_infinity=False)))
def test_text_and_archives_keep_every_digit(tmp_path_factory: pytest.TempPathFactory, values: np.ndarray) -> None:
    folder = tmp_path_factory.mktemp("maps")
    for suffix in DOUBLE:
        write_maps(folder / f"a{suffix}", {"map": values})
        assert np.array_equal(read_scalars(folder / f"a{suffix}"), values, equal_nan=True)


def test_curvature_files_are_those_of_nibabel(tmp_path: Path) -> None:
    write_maps(tmp_path / "lh.thickness", {"map": VALUES})
    assert np.array_equal(nibabel.freesurfer.read_morph_data(tmp_path / "lh.thickness"), VALUES.astype(np.float32))
    assert read_maps(tmp_path / "lh.thickness").keys() == {"lh.thickness"}
    with pytest.raises(ValueError, match="NaN"):
        write_maps(tmp_path / "lh.sulc", {"map": WITH_NAN})


def test_nibabel_reads_gifti_maps_with_names_and_side(tmp_path: Path) -> None:
    write_maps(tmp_path / "a.func.gii", {"one": VALUES, "two": WITH_NAN}, "right")
    image = nibabel.load(tmp_path / "a.func.gii")
    assert [array.metadata["Name"] for array in image.darrays] == ["one", "two"]
    assert image.meta["AnatomicalStructurePrimary"] == "CortexRight"
    assert list(read_maps(tmp_path / "a.func.gii")) == ["one", "two"]


def test_cifti_leaves_out_what_is_nan_and_nibabel_agrees(tmp_path: Path) -> None:
    path = tmp_path / "a.dscalar.nii"
    write_maps(path, {"depth": WITH_NAN}, "left")
    image = nibabel.load(path)
    model = image.header.get_axis(1)
    assert model.nvertices["CIFTI_STRUCTURE_CORTEX_LEFT"] == N
    assert np.array_equal(model.vertex, np.flatnonzero(np.isfinite(WITH_NAN)))
    with pytest.raises(ValueError, match="no vertices of CIFTI_STRUCTURE_CORTEX_RIGHT"):
        read_maps(path, "right")
    with pytest.raises(ValueError, match="left or right"):
        read_maps(path)


def test_a_time_series_of_both_hemispheres_is_split(tmp_path: Path) -> None:
    sides = [
        cifti2.BrainModelAxis.from_mask(np.arange(N) % 2 == k, name=["CortexLeft", "CortexRight"][k]) for k in (0, 1)
    ]
    model = sides[0] + sides[1]
    data = np.random.default_rng(1).standard_normal((5, len(model))).astype(np.float32)
    header = cifti2.Cifti2Header.from_axes((cifti2.SeriesAxis(0, 1, 5), model))
    cifti2.Cifti2Image(data, header).to_filename(tmp_path / "rest.dtseries.nii")
    right = read_scalars(tmp_path / "rest.dtseries.nii", "right")
    assert right.shape == (N, 5)
    inside = np.isfinite(right[:, 0])
    assert np.array_equal(np.flatnonzero(inside), np.arange(1, N, 2))
    assert np.array_equal(right[inside].T, data[:, len(sides[0]) :].astype(np.float64))


def test_values_of_parcels_are_refused_with_the_way_out(tmp_path: Path) -> None:
    parcels = cifti2.ParcelsAxis(
        ["front", "back"],
        [np.zeros((0, 3), int)] * 2,
        [{"CIFTI_STRUCTURE_CORTEX_LEFT": np.arange(3)}, {"CIFTI_STRUCTURE_CORTEX_LEFT": np.arange(3, 9)}],
        nvertices={"CIFTI_STRUCTURE_CORTEX_LEFT": N},
    )
    header = cifti2.Cifti2Header.from_axes((cifti2.ScalarAxis(["thickness"]), parcels))
    cifti2.Cifti2Image(np.ones((1, 2)), header).to_filename(tmp_path / "a.pscalar.nii")
    with pytest.raises(ValueError, match=r"a.pscalar.nii .* a ParcelsAxis, vertices .*: write a dense map"):
        read_maps(tmp_path / "a.pscalar.nii", "left")


def test_masks_of_every_kind_agree(tmp_path: Path) -> None:
    inside = MESH.vertices[:, 2] > -0.3
    rows = "".join(f"{v} 0 0 0 0\n" for v in np.flatnonzero(inside))
    (tmp_path / "lh.cortex.label").write_text(f"#!ascii label\n{inside.sum()}\n{rows}")
    write_maps(tmp_path / "m.shape.gii", {"map": np.where(inside, VALUES, np.nan)})
    write_maps(tmp_path / "m.npy", {"map": inside.astype(float)})
    from surfexp.io.label_files import write_labels

    write_labels(tmp_path / "m.label.gii", inside.astype(int), ["Unknown", "cortex"])
    write_labels(tmp_path / "m.annot", inside + 2 * (MESH.vertices[:, 0] > 0) * inside, ["medial_wall", "a", "b", "c"])
    for name in ("lh.cortex.label", "m.shape.gii", "m.npy", "m.label.gii", "m.annot", "m.annot:a,c"):
        assert np.array_equal(read_mask(tmp_path / name, N), inside), name
    with pytest.raises(ValueError, match="no label is named 'cc', the nearest"):
        read_mask(f"{tmp_path / 'm.annot'}:cc", N)
    with pytest.raises(ValueError, match="the surface has 7"):
        read_mask(tmp_path / "m.npy", 7)


@pytest.mark.parametrize(
    "array",
    [
        np.ones(5, complex),
        np.zeros(5, "datetime64[s]"),
        np.zeros(5, [("a", float)]),
        np.array(["a"] * 5),
        np.array([1.0, np.inf]),
    ],
    ids=str,
)
def test_arrays_that_hold_no_real_numbers_are_refused(tmp_path: Path, array: np.ndarray) -> None:
    np.save(tmp_path / "a.npy", array)
    with pytest.raises(ValueError, match=r"real numbers are needed|infinite") as caught:
        read_scalars(tmp_path / "a.npy")
    assert "a.npy" in str(caught.value) and "\n" not in str(caught.value)


def test_pickles_are_never_read(tmp_path: Path) -> None:
    np.save(tmp_path / "a.npy", np.array([print], dtype=object), allow_pickle=True)
    with pytest.raises(ValueError, match="allow_pickle"):
        read_scalars(tmp_path / "a.npy")


def test_a_curvature_file_of_two_values_a_vertex_is_refused(tmp_path: Path) -> None:
    write_maps(tmp_path / "lh.sulc", {"map": VALUES})
    data = bytearray((tmp_path / "lh.sulc").read_bytes())
    data[14] = 2
    (tmp_path / "lh.sulc").write_bytes(data)
    with pytest.raises(ValueError, match="claims 2 values a vertex"):
        read_scalars(tmp_path / "lh.sulc")


def test_a_freesurfer_header_one_face_short_is_refused(tmp_path: Path) -> None:
    write_mesh(tmp_path / "lh.pial", MESH)
    assert np.array_equal(read_mesh(tmp_path / "lh.pial")[1], MESH.faces)
    assert hemisphere_of_file(tmp_path / "lh.pial") == "left"
    data = (tmp_path / "lh.pial").read_bytes()
    head = data.find(b"\n\n") + 2
    count = int.from_bytes(data[head + 4 : head + 8], "big")
    for tag in (2, 20):  # what follows the faces in files of FreeSurfer
        (tmp_path / "lh.pial").write_bytes(data + tag.to_bytes(4, "big") + bytes(8))
        assert np.array_equal(read_mesh(tmp_path / "lh.pial")[1], MESH.faces)
    short = data[: head + 4] + (count - 1).to_bytes(4, "big") + data[head + 8 :]
    (tmp_path / "lh.pial").write_bytes(short)
    with pytest.raises(ValueError, match="beyond its"):
        read_mesh(tmp_path / "lh.pial")


@pytest.mark.parametrize("suffix", [".vtk", ".vtp", ".npz", ".ply"])
def test_geometry_and_maps_come_back_together(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"a{suffix}"
    write_mesh(path, MESH, {"depth": VALUES})
    vertices, faces, maps = read_mesh(path)
    assert np.array_equal(vertices, MESH.vertices) and np.array_equal(faces, MESH.faces)
    assert np.array_equal(maps["depth"], VALUES)


WAYS = list(product(("Ascii", "Binary", "Appended", "Appended raw"), ("None", "ZLib", "LZMA")))


@pytest.mark.optional
def test_vtk_itself_reads_what_is_written_and_is_read(tmp_path: Path) -> None:
    vtk = pytest.importorskip("vtk", reason="needs vtk: make optional")
    from vtk.util.numpy_support import vtk_to_numpy

    for suffix, kind in ((".vtk", "PolyData"), (".vtp", "XMLPolyData")):
        reader, writer = f"vtk{kind}Reader", f"vtk{kind}Writer"
        write_mesh(tmp_path / f"a{suffix}", MESH, {"depth": VALUES})
        source = getattr(vtk, reader)()
        source.SetFileName(str(tmp_path / f"a{suffix}"))
        source.Update()
        poly = source.GetOutput()
        assert np.array_equal(vtk_to_numpy(poly.GetPoints().GetData()), MESH.vertices)
        assert np.array_equal(vtk_to_numpy(poly.GetPointData().GetArray("depth")), VALUES)
        for mode, packing in WAYS if suffix == ".vtp" else [("ASCII", ""), ("Binary", "")]:
            sink = getattr(vtk, writer)()
            sink.SetFileName(str(tmp_path / f"b{suffix}"))
            sink.SetInputData(poly)
            if suffix == ".vtk":
                getattr(sink, f"SetFileTypeTo{mode}")()
            else:
                getattr(sink, f"SetDataModeTo{mode.removesuffix(' raw')}")()
                getattr(sink, f"SetCompressorTypeTo{packing}")()
                sink.SetEncodeAppendedData(not mode.endswith("raw"))
                sink.SetBlockSize(1 << 10)
            sink.Write()
            vertices, faces, maps = read_mesh(tmp_path / f"b{suffix}")
            assert np.allclose(vertices, MESH.vertices, atol=1e-5) and np.array_equal(faces, MESH.faces)
            assert np.allclose(maps["depth"], VALUES, atol=1e-5)


# what VTK writes since version 9: all places where a cell begins, then all corners
CELLS = """# vtk DataFile Version 5.1
vtk output
ASCII
DATASET POLYDATA
POINTS 5 double
0 0 0 1 0 0 1 1 0
0 1 0 2 0 0
METADATA
INFORMATION 1
NAME L2_NORM_RANGE LOCATION vtkDataArray
DATA 2 0 2

LINES 2 2
OFFSETS vtktypeint64
0 2
CONNECTIVITY vtktypeint64
0 4
POLYGONS 3 7
OFFSETS vtktypeint64
0 4 7
CONNECTIVITY vtktypeint64
0 1 2 3 1
4 2
POINT_DATA 5
SCALARS depth double
LOOKUP_TABLE default
1 2 3 4 5
"""
CHANGES = [
    ("0 4 7", "0 4 8", "its polygons go from 0 to 8, there are 7 corners"),
    ("0 4 7", "4 5 7", "its polygons go from 4 to 7, there are 7 corners"),
    ("0 4 7", "0 9 7", "polygon 1 begins at corner 9 and ends at 7"),
    ("0 4 7", "0 6 7", "face 1 has 1 vertices, at least 3 are needed"),
    ("POLYGONS 3 7", "POLYGONS 3 8", "it has 9 numbers where 8 are announced"),
    ("CONNECTIVITY vtktypeint64\n0 1", "0 1", "it has '0 1 2 3 1' where CONNECTIVITY and a type are needed"),
    ("Version 5.1", "Version five", "it has no header of a legacy VTK file"),
]


def test_cells_of_version_5_are_read(tmp_path: Path) -> None:
    (tmp_path / "a.vtk").write_text(CELLS)
    vertices, faces, maps = read_mesh(tmp_path / "a.vtk")
    assert vertices.shape == (5, 3) and maps["depth"].tolist() == [1, 2, 3, 4, 5]
    assert faces.tolist() == [[0, 1, 2], [0, 2, 3], [1, 4, 2]]
    big = CELLS.replace("ASCII", "BINARY").encode()
    numbers = {
        b"0 0 0 1 0 0 1 1 0\n0 1 0 2 0 0": vertices.astype(">f8"),
        b"0 2\nCONN": np.array([0, 2], ">i8"),
        b"0 4\nPOLY": np.array([0, 4], ">i8"),
        b"0 4 7": np.array([0, 4, 7], ">i8"),
        b"0 1 2 3 1\n4 2": np.array([0, 1, 2, 3, 1, 4, 2], ">i8"),
        b"1 2 3 4 5": maps["depth"].astype(">f8"),
    }
    for text, values in numbers.items():
        rest = text[-5:] if text[-4:] in (b"CONN", b"POLY") else b""
        assert big.count(text) == 1
        big = big.replace(text, values.tobytes() + rest)
    (tmp_path / "b.vtk").write_bytes(big)
    again = read_mesh(tmp_path / "b.vtk")
    assert np.array_equal(again[0], vertices) and np.array_equal(again[1], faces)
    assert np.array_equal(again[2]["depth"], maps["depth"])


@pytest.mark.parametrize(("old", "new", "reason"), CHANGES)
def test_cells_that_do_not_fit_are_refused(tmp_path: Path, old: str, new: str, reason: str) -> None:
    assert CELLS.count(old) == 1
    (tmp_path / "a.vtk").write_text(CELLS.replace(old, new))
    with pytest.raises(ValueError, match=reason):
        read_mesh(tmp_path / "a.vtk")


def test_corners_in_xml_are_one_number_each_and_norms_beside_numbers_are_passed_over(tmp_path: Path) -> None:
    path = tmp_path / "a.vtp"
    write_mesh(path, MESH)
    text = path.read_text()
    assert 'type="Int64" Name="connectivity" NumberOfComponents="1"' in text  # VTK reads no other
    norm = '<InformationKey name="L2_NORM_RANGE" location="vtkDataArray"><Value index="0">1</Value></InformationKey>'
    path.write_text(text.replace("</DataArray>", f"{norm}</DataArray>"))
    vertices, faces, _ = read_mesh(path)
    assert np.array_equal(vertices, MESH.vertices) and np.array_equal(faces, MESH.faces)


CUT = [".shape.gii", ".dscalar.nii", ".mgh", ".mgz", ".npy", ".npz", ".vtk", ".vtp", ".stl", "lh.sulc", "lh.pial"]


@pytest.mark.parametrize("name", CUT)
def test_every_cut_is_refused_in_one_line_with_the_name(tmp_path: Path, name: str) -> None:
    path = tmp_path / (f"a{name}" if name.startswith(".") else name)
    is_mesh = name in (".vtk", ".vtp", ".stl", "lh.pial")
    if is_mesh:
        write_mesh(path, MESH)
    else:
        write_maps(path, {"map": VALUES}, "left")
    data = path.read_bytes()
    for k in range(16):
        path.write_bytes(data[: len(data) * k // 16])
        with pytest.raises(ValueError, match=path.name) as caught:
            read_mesh(path) if is_mesh else read_scalars(path, "left")
        assert "\n" not in str(caught.value) and len(str(caught.value)) < 400


def test_maps_without_names_or_with_one_name_are_counted(tmp_path: Path) -> None:
    def array(name: str) -> nibabel.gifti.GiftiDataArray:
        return nibabel.gifti.GiftiDataArray(VALUES.astype(np.float32), meta={"Name": name} if name else {})

    for names, expected in {("",): ["a"], ("", ""): ["map 1", "map 2"], ("one", "one"): ["one", "one 2"]}.items():
        nibabel.save(nibabel.gifti.GiftiImage(darrays=[array(name) for name in names]), tmp_path / "a.func.gii")
        assert list(read_maps(tmp_path / "a.func.gii")) == expected


def test_an_off_file_that_ends_after_its_counts_says_what_is_missing(tmp_path: Path) -> None:
    (tmp_path / "a.off").write_text("OFF\n3 1 0\n")
    with pytest.raises(ValueError, match="it ends after 0 of 3 vertices and 1 faces"):
        read_mesh(tmp_path / "a.off")


def test_of_two_surfaces_in_a_file_none_is_read(tmp_path: Path) -> None:
    (tmp_path / "a.vtk").write_text(CELLS)
    part = CELLS[CELLS.index("POLYGONS") :]
    (tmp_path / "a.vtk").write_text(CELLS + part)
    with pytest.raises(ValueError, match="it has POLYGONS twice, one is read"):
        read_mesh(tmp_path / "a.vtk")
    write_mesh(tmp_path / "a.surf.gii", MESH)
    image = nibabel.load(tmp_path / "a.surf.gii")
    for array in list(image.darrays):
        image.add_gifti_data_array(array)
        nibabel.save(image, tmp_path / "b.surf.gii")
        with pytest.raises(ValueError, match="it has two arrays of NIFTI_INTENT_POINTSET, one is read"):
            read_mesh(tmp_path / "b.surf.gii")


@pytest.mark.parametrize("shape", [(), (2, 3, 4), (N, 1, 1)])
def test_a_map_has_one_number_or_one_row_for_each_vertex(tmp_path: Path, shape: tuple[int, ...]) -> None:
    values = np.zeros(shape)
    np.save(tmp_path / "a.npy", values)
    np.savez(tmp_path / "a.npz", map=values)
    for name in ("a.npy", "a.npz"):
        for read in (read_maps, read_scalars):
            with pytest.raises(
                ValueError, match=rf"{name} .* has shape .*, \(vertices,\) or \(vertices, channels\) is"
            ):
                read(tmp_path / name)
    np.savez(tmp_path / "mesh.npz", vertices=MESH.vertices, faces=MESH.faces, depth=values)
    if shape[:1] == (N,):
        with pytest.raises(ValueError, match="map 'depth' has shape"):
            read_mesh(tmp_path / "mesh.npz")


def test_text_tables_say_what_is_wrong(tmp_path: Path) -> None:
    cases = {
        "1,2\n3\n": "row 2 has 1 cells",
        "a,b\n1,x\n": "cell 'x'",
        "a,a\n1,2\n": "two columns",
        "": "0 bytes",
        "# only\n": "no row",
        "1\ninf\n": "infinite",
        "a;b\n2,5;1\n": "the cell '2,5', a number is needed, with a decimal point",
        "2,53\n-3,1\n": "its rows, as '2,53', are one number with a decimal comma or two: name the columns",
        "+2,5e-3\n0,1\n": "write decimal points",
        "2,5;1,5\n2,5;1,5\n": "the cell '5;1', a number is needed$",
        ",a\n1,2\n0,3\n": "its first column has no name and does not count the rows: name it",
    }
    for text, words in cases.items():
        (tmp_path / "a.csv").write_text(text)
        with pytest.raises(ValueError, match=words):
            read_maps(tmp_path / "a.csv")
    (tmp_path / "a.csv").write_bytes("\ufeffx,y\r\n1,NA\r\n2,3\r\n".encode())
    assert np.array_equal(read_maps(tmp_path / "a.csv")["y"], [np.nan, 3.0], equal_nan=True)
    for text in ("a,b\n1,0\n0,1\n", "1,0.0\n0,1\n", "1,-1\n1,1\n", "1, 0\n0, 1\n", "1;0\n0;1\n", "1\t0\n"):
        (tmp_path / "a.csv").write_text(text)
        assert len(read_maps(tmp_path / "a.csv")) == 2


@pytest.mark.parametrize("first", [0, 1])
@pytest.mark.parametrize("names", [("x",), ("0", "1"), ("V1", "V2")])
def test_what_counts_the_rows_is_no_map(tmp_path: Path, first: int, names: tuple[str, ...]) -> None:
    rows = [["", *names], *([str(k), *["0.5"] * len(names)] for k in range(first, first + 3))]
    (tmp_path / "a.csv").write_text("\n".join(map(",".join, rows)))
    found = read_maps(tmp_path / "a.csv")
    assert tuple(found) == names and all(values.tolist() == [0.5] * 3 for values in found.values())


@pytest.mark.parametrize("between", [",", ";", "\t"])
@pytest.mark.parametrize("header", [(), ("thickness", "sulc"), ("of age, sex", "a;b")])
def test_columns_are_separated_as_a_spreadsheet_does_it(tmp_path: Path, between: str, header: tuple[str, ...]) -> None:
    with (tmp_path / "a.csv").open("w", newline="") as stream:
        writer = csv.writer(stream, delimiter=between)
        stream.write("# from a spreadsheet\n\n")
        writer.writerows([*([header] if header else []), ("0.5", ""), ("-1e-3", "7")])
    found = read_maps(tmp_path / "a.csv")
    assert tuple(found) == (header or ("map 1", "map 2"))
    assert np.array_equal(np.stack(list(found.values())), [[0.5, -1e-3], [np.nan, 7.0]], equal_nan=True)


@pytest.mark.parametrize("names", [("a;b",), ("a;b,c;d",), ("a\tb;c", "d"), ("a;b;c", "d;e;f")])
def test_names_with_separators_come_back_from_a_table(tmp_path: Path, names: tuple[str, ...]) -> None:
    write_table(tmp_path / "a.csv", dict.fromkeys(names, VALUES))
    assert tuple(read_table(tmp_path / "a.csv")) == names


def test_coordinates_whose_volumes_overflow_are_refused(tmp_path: Path) -> None:
    (tmp_path / "a.off").write_text("OFF\n3 1 0\n0 0 0\n1e110 0 0\n0 1e110 0\n3 0 1 2\n")
    with pytest.raises(ValueError, match=r"1e\+110"):
        read_mesh(tmp_path / "a.off")
    (tmp_path / "a.vert").write_text("0 0 0\n1 0 0\n0 1 0\n")
    (tmp_path / "a.tri").write_text("1 2.5 3\n")
    with pytest.raises(ValueError, match="whole numbers"):
        read_mesh(tmp_path / "a.tri")


def test_entities_in_xml_expand_to_nothing(tmp_path: Path) -> None:
    bomb = '<?xml version="1.0"?><!DOCTYPE a [<!ENTITY b "' + "x" * 1000 + '">]>'
    for name in ("a.vtp", "a.shape.gii"):
        (tmp_path / name).write_text(bomb + '<VTKFile type="PolyData">&b;</VTKFile>')
        with pytest.raises(ValueError, match=name):
            read_mesh(tmp_path / name) if name == "a.vtp" else read_scalars(tmp_path / name)


def test_another_data_set_in_xml_and_a_file_without_its_end_are_refused(tmp_path: Path) -> None:
    write_mesh(tmp_path / "a.vtp", MESH)
    text = (tmp_path / "a.vtp").read_text()
    for changed in (text.replace('type="PolyData"', 'type="UnstructuredGrid"'), text.removesuffix("</VTKFile>\n")):
        assert changed != text
        (tmp_path / "a.vtp").write_text(changed)
        with pytest.raises(ValueError, match="it is no XML file of PolyData, or is cut off"):
            read_mesh(tmp_path / "a.vtp")


def test_a_volume_has_all_its_bytes_or_is_refused(tmp_path: Path) -> None:
    write_maps(tmp_path / "a.mgh", {"map": VALUES})
    whole = 284 + 4 * len(VALUES)
    data = (tmp_path / "a.mgh").read_bytes()
    for size in (whole, whole - 1):
        (tmp_path / "a.mgh").write_bytes(data[:size])
        if size == whole:
            check_volume(tmp_path / "a.mgh")
        else:
            with pytest.raises(
                ValueError, match=rf"{4 * len(VALUES)} bytes of data from byte 284 on, the file has {size}"
            ):
                check_volume(tmp_path / "a.mgh")


def test_gzip_that_is_none_is_refused(tmp_path: Path) -> None:
    for data in (b"\x1f\x8b" + b"0" * 50, gzip.compress(b"nothing")):
        (tmp_path / "a.mgz").write_bytes(data)
        with pytest.raises(ValueError, match=r"a\.mgz"):
            read_scalars(tmp_path / "a.mgz")


def test_an_archive_packs_whole_numbers_alone(tmp_path: Path) -> None:
    arrays = {"vectors": np.random.default_rng(0).normal(size=(500, 4)), "labels": np.zeros(4000, dtype=np.int64)}
    for name in ("a.npz", "b.npz"):
        write_arrays(tmp_path / name, arrays, "left")
    with zipfile.ZipFile(tmp_path / "a.npz") as archive:
        sizes = {item.filename: (item.compress_size, item.file_size) for item in archive.infolist()}
    assert sizes["vectors.npy"][0] == sizes["vectors.npy"][1] == 128 + 8 * 2000
    assert sizes["labels.npy"][0] < sizes["labels.npy"][1] / 50
    assert (tmp_path / "a.npz").read_bytes() == (tmp_path / "b.npz").read_bytes()
    with np.load(tmp_path / "a.npz") as loaded:
        assert (
            all(np.array_equal(loaded[name], array) for name, array in arrays.items())
            and loaded["hemisphere"] == "left"
        )
