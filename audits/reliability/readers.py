"""Ours and theirs: what each reader finds in a file."""

from __future__ import annotations

import contextlib
import importlib
import io
import warnings
from collections.abc import Callable, Iterator
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

from audits.reliability.truth import LABELS, LIST, MAPS, MASK, SURFACE, Found, Truth
from surfexp.io.freesurfer import read_vertex_list
from surfexp.io.map_files import read_maps, read_mask, read_named_labels
from surfexp.io.reading import read_mesh_file

TRIANGLES, POLYGONS = 5, (5, 7, 9)


def ours(path: Path, truth: Truth) -> Found:
    """Read a file by the door that its kind has.

    Raises
    ------
    ValueError
        The refusal.
    """
    if truth.kind == SURFACE:
        file = read_mesh_file(path)
        return Found(file.vertices, file.faces.tolist(), file.scalars)
    if truth.kind == MAPS:
        return Found(maps=read_maps(path, "left"))
    if truth.kind == LABELS:
        found = read_named_labels(path, "left")
        return Found(labels=[found.names.get(key, "") for key in found.keys.tolist()])
    if truth.kind == LIST:
        return Found(labels=list(map(str, read_vertex_list(path).tolist())))
    assert truth.kind == MASK and truth.mask is not None
    return Found(mask=read_mask(path, len(truth.mask)))


def import_others() -> None:
    """Import other readers once, before processes are forked from this one."""
    for package in ("vtk", "trimesh", "meshio", "open3d", "igl", "pandas"):
        if find_spec(package):
            importlib.import_module(package)


def theirs(path: Path, kind: str) -> Iterator[tuple[str, Callable[[Path], Found]]]:
    """Yield the other readers of a format that are installed, by name."""
    name = path.name.lower()
    suffix = "".join(path.suffixes[-2:]).lower() if name.endswith(".gz") else path.suffix.lower()
    if kind == SURFACE:
        if suffix in _VTK and find_spec("vtk"):
            yield "VTK", _with_vtk
        # trimesh leaves out the last of homogeneous coordinates without a word
        homogeneous = suffix == ".off" and path.read_bytes()[:4] == b"4OFF"
        if suffix in (".off", ".obj", ".ply", ".stl") and find_spec("trimesh") and not homogeneous:
            yield "trimesh", _with_trimesh
        if suffix in (".vtk", ".vtu", ".ply", ".obj", ".off", ".stl") and find_spec("meshio"):
            yield "meshio", _with_meshio
        if suffix in (".ply", ".obj", ".off", ".stl") and find_spec("open3d"):
            yield "open3d", _with_open3d
        if suffix in (".ply", ".obj", ".off", ".stl"):
            yield "libigl", _with_libigl
        if name.endswith((".gii", ".gii.gz")):
            yield "nibabel", _with_nibabel_gifti
        elif not path.suffix or suffix in (".white", ".pial", ".orig", ".inflated", ".sphere"):
            yield "nibabel", _with_nibabel_geometry
    elif kind == LABELS:
        if name.endswith(".annot"):
            yield "nibabel", _with_nibabel_annotation
        elif name.endswith((".gii", ".gii.gz")):
            yield "nibabel", _with_nibabel_labels
        elif name.endswith(".dlabel.nii"):
            yield "nibabel", _with_nibabel_cifti_labels
    elif kind == MAPS:
        if name.endswith((".dscalar.nii", ".dtseries.nii")):
            yield "nibabel", _with_nibabel_cifti
        elif name.endswith((".mgh", ".mgz", ".nii", ".nii.gz")):
            yield "nibabel", _with_nibabel_volume
        elif name.endswith((".gii", ".gii.gz")):
            yield "nibabel", _with_nibabel_maps
        elif suffix in (".sulc", ".curv", ".thickness", ".area"):
            yield "nibabel", _with_nibabel_morph
        elif suffix == ".npy":
            yield "numpy", lambda file: Found(maps={"": np.load(file).astype(float)}, named=False)
        elif suffix == ".csv" and find_spec("pandas"):
            yield "pandas", _with_pandas
    elif kind == LIST:
        yield "nibabel", _with_nibabel_list


_VTK = (".vtk", ".vtp", ".vtu", ".ply", ".stl", ".obj")


def _with_vtk(path: Path) -> Found:
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy

    vtk.vtkObject.GlobalWarningDisplayOff()
    readers = {
        ".vtp": vtk.vtkXMLPolyDataReader,
        ".vtu": vtk.vtkXMLUnstructuredGridReader,
        ".ply": vtk.vtkPLYReader,
        ".stl": vtk.vtkSTLReader,
        ".obj": vtk.vtkOBJReader,
    }
    suffix = path.suffix.lower()
    reader = readers[suffix]() if suffix in readers else vtk.vtkGenericDataObjectReader()
    reader.SetFileName(str(path))
    if suffix == ".vtk":
        reader.ReadAllScalarsOn()
        reader.ReadAllVectorsOn()
        reader.ReadAllFieldsOn()
    reader.Update()
    data = reader.GetOutput()
    if data is None or not data.GetNumberOfPoints():
        raise ValueError("VTK finds no points")
    vertices = vtk_to_numpy(data.GetPoints().GetData()).astype(float)
    polygons: list[list[int]] = []
    for number in range(data.GetNumberOfCells()):
        kind = data.GetCellType(number)
        ids = [data.GetCell(number).GetPointId(k) for k in range(data.GetCell(number).GetNumberOfPoints())]
        if kind in POLYGONS:
            polygons.append(ids)
        elif kind == 8:
            polygons.append([ids[0], ids[1], ids[3], ids[2]])
        elif kind == 6:
            polygons += [
                [ids[k], ids[k + 1], ids[k + 2]] if k % 2 == 0 else [ids[k + 1], ids[k], ids[k + 2]]
                for k in range(len(ids) - 2)
            ]
    maps = None
    if suffix in (".vtk", ".vtp", ".vtu"):
        skipped = {
            array.GetName()
            for array in (
                data.GetPointData().GetNormals(),
                data.GetPointData().GetTCoords(),
                data.GetPointData().GetTensors(),
            )
            if array is not None
        }
        arrays = [data.GetPointData().GetArray(k) for k in range(data.GetPointData().GetNumberOfArrays())]
        maps = {
            array.GetName(): vtk_to_numpy(array).astype(float)
            for array in arrays
            if array is not None and array.GetName() not in skipped and array.GetName() != "rgb"
        }
    return Found(vertices, polygons, maps, welds=suffix != ".stl")


def _with_trimesh(path: Path) -> Found:
    import trimesh

    mesh = trimesh.load_mesh(path, process=False, maintain_order=True)
    if not isinstance(mesh, trimesh.Trimesh):
        raise ValueError("trimesh finds several meshes or none")
    return Found(np.asarray(mesh.vertices, dtype=float), mesh.faces.tolist(), welds=False)


def _with_meshio(path: Path) -> Found:
    import meshio

    try:
        with contextlib.redirect_stderr(io.StringIO()), contextlib.redirect_stdout(io.StringIO()):
            mesh = meshio.read(path)
    except SystemExit:
        raise ValueError("meshio ends the process") from None
    polygons = [
        row.tolist() for block in mesh.cells if block.type in ("triangle", "quad", "polygon") for row in block.data
    ]
    return Found(np.asarray(mesh.points, dtype=float), polygons, welds=False)


def _with_open3d(path: Path) -> Found:
    import open3d

    with open3d.utility.VerbosityContextManager(open3d.utility.VerbosityLevel.Error):
        mesh = open3d.io.read_triangle_mesh(str(path))
    if not len(mesh.triangles):
        raise ValueError("open3d finds no triangles")
    return Found(np.array(mesh.vertices), np.array(mesh.triangles).tolist(), welds=False)


def _with_libigl(path: Path) -> Found:
    import igl

    vertices, faces = igl.read_triangle_mesh(str(path))
    if not len(faces) or faces.shape[1:] != (3,):
        raise ValueError("libigl finds no triangles")
    return Found(np.asarray(vertices, dtype=float), faces.tolist(), welds=False)


def _with_pandas(path: Path) -> Found:
    import pandas

    first = path.open().readline().split(",")
    plain = all(_is_number(word) for word in first)
    table = pandas.read_csv(path, header=None if plain else 0)
    return Found(maps={str(name): table[name].to_numpy(dtype=float) for name in table}, named=False)


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


def _with_nibabel_list(path: Path) -> Found:
    import nibabel

    return Found(labels=list(map(str, nibabel.freesurfer.read_label(path).tolist())))


def _nibabel(path: Path) -> Any:
    import nibabel

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return nibabel.load(path)


def _with_nibabel_gifti(path: Path) -> Found:
    image = _nibabel(path)
    points, faces = (image.get_arrays_from_intent(f"NIFTI_INTENT_{x}")[0].data for x in ("POINTSET", "TRIANGLE"))
    return Found(np.asarray(points, dtype=float), faces.tolist())


def _with_nibabel_geometry(path: Path) -> Found:
    import nibabel

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        vertices, faces = nibabel.freesurfer.read_geometry(path)
    return Found(np.asarray(vertices, dtype=float), faces.tolist())


def _with_nibabel_annotation(path: Path) -> Found:
    import nibabel

    with np.errstate(over="ignore"):
        labels, _, names = nibabel.freesurfer.read_annot(path)
    return Found(labels=[names[k].decode() if k >= 0 else "" for k in labels])


def _with_nibabel_labels(path: Path) -> Found:
    image = _nibabel(path)
    names = image.labeltable.get_labels_as_dict()
    keys, nodes = (image.get_arrays_from_intent(f"NIFTI_INTENT_{x}") for x in ("LABEL", "NODE_INDEX"))
    values = [str(names.get(int(k), "")) for k in np.ravel(keys[0].data)]
    if nodes:
        whole = [""] * (int(nodes[0].data.max()) + 1)
        for node, value in zip(nodes[0].data.ravel().tolist(), values, strict=True):
            whole[node] = value
        values = whole
    return Found(labels=values)


def _with_nibabel_maps(path: Path) -> Found:
    import nibabel

    image = _nibabel(path)
    nodes = image.get_arrays_from_intent("NIFTI_INTENT_NODE_INDEX")
    surface = {
        nibabel.nifti1.intent_codes[f"NIFTI_INTENT_{x}"] for x in ("POINTSET", "TRIANGLE", "NODE_INDEX", "LABEL")
    }
    maps = {}
    for number, array in enumerate(array for array in image.darrays if array.intent not in surface):
        values = np.asarray(array.data, dtype=float)
        if nodes:
            whole = np.full((int(nodes[0].data.max()) + 1, *values.shape[1:]), np.nan)
            whole[nodes[0].data.ravel()] = values
            values = whole
        maps[str(number)] = np.squeeze(values)
    return Found(maps=maps, named=False)


def _with_nibabel_cifti(path: Path) -> Found:
    image = _nibabel(path)
    axis, data = image.header.get_axis(1), np.asarray(image.dataobj, dtype=float)
    for name, columns, model in axis.iter_structures():
        if name == "CIFTI_STRUCTURE_CORTEX_LEFT":
            whole = np.full((len(data), axis.nvertices[name]), np.nan)
            whole[:, model.vertex] = data[:, columns]
            if path.name.endswith(".dtseries.nii"):
                return Found(maps={"series": whole.T}, named=False)
            return Found(maps={str(k): row for k, row in enumerate(whole)}, named=False)
    raise ValueError("no left cortex")


def _with_nibabel_cifti_labels(path: Path) -> Found:
    image = _nibabel(path)
    axis, data = image.header.get_axis(1), np.asarray(image.dataobj)
    table = {int(key): name for key, (name, _) in image.header.get_axis(0).label[0].items()}
    for name, columns, model in axis.iter_structures():
        if name == "CIFTI_STRUCTURE_CORTEX_LEFT":
            labels = [""] * axis.nvertices[name]
            for vertex, key in zip(model.vertex.tolist(), data[0, columns].tolist(), strict=True):
                labels[vertex] = table.get(int(key), "")
            return Found(labels=labels)
    raise ValueError("no left cortex")


def _with_nibabel_volume(path: Path) -> Found:
    data = np.asarray(_nibabel(path).dataobj, dtype=float)
    values = data.reshape(int(np.prod(data.shape[:3])), -1, order="F")
    values = values[:, 0] if values.shape[1] == 1 else values
    return Found(maps={"": values}, named=False)


def _with_nibabel_morph(path: Path) -> Found:
    import nibabel

    return Found(maps={"": nibabel.freesurfer.read_morph_data(path).astype(float)}, named=False)
