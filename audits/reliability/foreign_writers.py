"""Files by the programs themselves: VTK, trimesh, meshio. Each is left out where it is not installed."""

from __future__ import annotations

import contextlib
import io
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

from audits.reliability.scene import Scene
from audits.reliability.truth import SURFACE, Truth

Written = tuple[Path, Truth]


def _vtk_data(scene: Scene, points_only: bool = False) -> Any:
    import vtk
    from vtk.util.numpy_support import numpy_to_vtk

    data = vtk.vtkPolyData()
    points = vtk.vtkPoints()
    points.SetData(numpy_to_vtk(scene.vertices, deep=True))
    data.SetPoints(points)
    cells = vtk.vtkCellArray()
    for polygon in scene.polygons:
        cells.InsertNextCell(len(polygon), polygon)
    data.SetPolys(cells)
    for name, values in (
        {} if points_only else {"sulcal depth": scene.maps["depth"], "flow": scene.maps["flow"]}.items()
    ):
        array = numpy_to_vtk(values, deep=True)
        array.SetName(name)
        data.GetPointData().AddArray(array)
    return data


def vtk_legacy(scene: Scene, rng: np.random.Generator, folder: Path) -> Written:
    """vtkPolyDataWriter, versions 4.2 and 5.1, text or bytes, with normals, strings, identities and data of cells."""
    import vtk
    from vtk.util.numpy_support import numpy_to_vtk

    data = _vtk_data(scene)
    maps = {"sulcal depth": scene.maps["depth"], "flow": scene.maps["flow"]}
    if rng.random() < 0.5:
        data.GetPointData().SetActiveScalars("sulcal depth")
    if rng.random() < 0.5:
        names = vtk.vtkStringArray()
        names.SetName("names")
        for number in range(len(scene.vertices)):
            names.InsertNextValue(f"vertex {number}" * int(rng.integers(0, 9)))
        data.GetPointData().AddArray(names)
    if rng.random() < 0.5:
        cells = numpy_to_vtk(np.arange(len(scene.polygons)), deep=True)
        cells.SetName("region")
        data.GetCellData().SetScalars(cells)
    if rng.random() < 0.5:
        normals = numpy_to_vtk(rng.standard_normal(scene.vertices.shape).astype(np.float32), deep=True)
        normals.SetName("Normals")
        data.GetPointData().SetNormals(normals)
    if rng.random() < 0.3:
        time = numpy_to_vtk(np.array([0.5]), deep=True)
        time.SetName("TimeValue")
        data.GetFieldData().AddArray(time)
    writer = vtk.vtkPolyDataWriter()
    writer.SetFileVersion(int(rng.choice([42, 51])))
    writer.SetFileType(int(rng.integers(1, 3)))
    path = _vtk_write(writer, data, folder / "a.vtk")
    return path, Truth(
        SURFACE, scene.vertices, scene.polygons, maps, tolerance=1e-5 if writer.GetFileType() == 1 else 0.0
    )


def vtk_xml(scene: Scene, rng: np.random.Generator, folder: Path) -> Written:
    """vtkXMLPolyDataWriter with all its modes and compressors; LZ4 has to be refused."""
    import vtk

    writer = vtk.vtkXMLPolyDataWriter()
    writer.SetDataMode(int(rng.integers(3)))
    writer.SetEncodeAppendedData(int(rng.integers(2)))
    packing = int(rng.integers(4))
    writer.SetCompressorType(packing)
    writer.SetHeaderType(int(rng.choice([32, 64])))
    writer.SetByteOrder(int(rng.integers(2)))
    path = _vtk_write(writer, _vtk_data(scene), folder / "a.vtp")
    lz4 = b"vtkLZ4" in path.read_bytes()[:400] and writer.GetDataMode() != 0
    maps = {"sulcal depth": scene.maps["depth"], "flow": scene.maps["flow"]}
    return path, Truth(SURFACE, scene.vertices, scene.polygons, maps, refused="LZ4" if lz4 else "", tolerance=1e-9)


def vtk_unstructured(scene: Scene, rng: np.random.Generator, folder: Path) -> Written:
    """vtkXMLUnstructuredGridWriter and vtkUnstructuredGridWriter of what vtkAppendFilter makes."""
    import vtk

    join = vtk.vtkAppendFilter()
    join.AddInputData(_vtk_data(scene))
    join.Update()
    if rng.random() < 0.5:
        writer, path = vtk.vtkXMLUnstructuredGridWriter(), folder / "a.vtu"
        writer.SetDataMode(int(rng.integers(3)))
    else:
        writer, path = vtk.vtkUnstructuredGridWriter(), folder / "a.vtk"
        writer.SetFileType(int(rng.integers(1, 3)))
        writer.SetFileVersion(int(rng.choice([42, 51])))
    _vtk_write(writer, join.GetOutput(), path)
    maps = {"sulcal depth": scene.maps["depth"], "flow": scene.maps["flow"]}
    return path, Truth(SURFACE, scene.vertices, scene.polygons, maps, tolerance=1e-5)


def vtk_meshes(scene: Scene, rng: np.random.Generator, folder: Path) -> Written:
    """vtkPLYWriter, vtkSTLWriter and vtkOBJWriter."""
    import vtk

    kind = str(rng.choice(["ply", "stl", "obj"]))
    if kind == "obj":
        path = _vtk_write(vtk.vtkOBJWriter(), _vtk_data(scene, True), folder / "a.obj")
        return path, Truth(SURFACE, scene.vertices, scene.polygons, tolerance=1e-4)
    triangles = [p[:3] for p in scene.polygons]
    data = _vtk_data(Scene(scene.single, triangles, scene.maps, scene.labels, scene.mask), True)
    writer = vtk.vtkPLYWriter() if kind == "ply" else vtk.vtkSTLWriter()
    text = bool(rng.integers(2))
    writer.SetFileType(1 if text else 2)
    path = _vtk_write(writer, data, folder / f"a.{kind}")
    if kind == "stl" and text:
        return path, _stl_text(path, triangles)
    return path, Truth(SURFACE, scene.single, triangles, welded=kind == "stl", tolerance=1e-5 if text else 0.0)


def _stl_text(path: Path, triangles: list[list[int]]) -> Truth:
    """Read the rounded coordinates that stand in the text, three rows a triangle."""
    rows = [line.split()[1:4] for line in path.read_text().splitlines() if line.split()[:1] == ["vertex"]]
    points = np.array(rows, dtype=float)
    return Truth(SURFACE, points, np.arange(len(points)).reshape(-1, 3).tolist(), welded=True)


def _vtk_write(writer: Any, data: Any, path: Path) -> Path:
    writer.SetInputData(data)
    writer.SetFileName(str(path))
    writer.Write()
    return path


def trimesh_meshes(scene: Scene, rng: np.random.Generator, folder: Path) -> Written:
    """trimesh's OFF, OBJ, PLY and STL, with normals and colours of vertices."""
    import trimesh

    kind = str(rng.choice(["off", "obj", "ply", "stl", "stl_ascii"]))
    triangles = [p[:3] for p in scene.polygons]
    mesh = trimesh.Trimesh(scene.single, triangles, process=False)
    if rng.random() < 0.5 and kind in ("ply", "obj", "off"):
        mesh.visual.vertex_colors = rng.integers(0, 256, (len(scene.vertices), 4)).astype(np.uint8)
    path = folder / f"a.{kind[:3]}"
    options = {"encoding": str(rng.choice(["ascii", "binary"]))} if kind == "ply" else {}
    exported = mesh.export(file_type=kind, **options)
    path.write_bytes(exported if isinstance(exported, bytes) else exported.encode())
    if kind == "stl_ascii":
        return path, _stl_text(path, triangles)
    maps = {}
    if kind in ("ply", "obj") and mesh.visual.kind == "vertex":
        colours = np.asarray(mesh.visual.vertex_colors, dtype=float)
        names = ("red", "green", "blue", "alpha")[: 4 if kind == "ply" else 3]
        maps = {name: colours[:, k] for k, name in enumerate(names)}
    digits = 1e-5 if kind in ("off", "obj") or options.get("encoding") == "ascii" else 0.0
    return path, Truth(SURFACE, scene.single, triangles, maps, welded=kind == "stl", tolerance=digits)


def meshio_meshes(scene: Scene, rng: np.random.Generator, folder: Path) -> Written:
    """meshio's VTK, VTU, PLY, OBJ, OFF and STL, triangles and quadrangles in blocks."""
    import meshio

    suffix = str(rng.choice([".vtk", ".vtu", ".ply", ".obj", ".off", ".stl"]))
    three = [p for p in scene.polygons if len(p) == 3]
    four = [p for p in scene.polygons if len(p) == 4]
    if suffix in (".off", ".stl") or not three:
        three, four = [p[:3] for p in scene.polygons], []
    cells = [("triangle", np.array(three))] + ([("quad", np.array(four))] if four else [])
    holds = suffix in (".vtk", ".vtu", ".ply")
    maps = {"depth": scene.maps["depth"], "labels": scene.labels.astype(float)} if holds else {}
    vertices = scene.single
    mesh = meshio.Mesh(
        vertices, cells, point_data={k: v.astype(np.float32) if suffix == ".ply" else v for k, v in maps.items()}
    )
    path = folder / f"a{suffix}"
    options: dict[str, Any] = {"binary": bool(rng.integers(2))} if suffix in (".vtk", ".vtu", ".ply", ".stl") else {}
    if suffix == ".vtk":
        options["file_format"] = str(rng.choice(["vtk42", "vtk51"]))
    if suffix == ".stl" and options["binary"]:
        mesh.points = vertices.astype(np.float32)
    with contextlib.redirect_stderr(io.StringIO()), contextlib.redirect_stdout(io.StringIO()):
        meshio.write(path, mesh, **options)
    if suffix == ".stl" and not options["binary"]:
        return path, _stl_text(path, three)
    if suffix == ".ply":
        maps = {name: values.astype(np.float32).astype(float) for name, values in maps.items()}
    return path, Truth(SURFACE, vertices, [*three, *four], maps, welded=suffix == ".stl", tolerance=1e-9)


def known() -> tuple[Any, ...]:
    """Return the dialects whose writer is installed."""
    by_package = {
        "vtk": (vtk_legacy, vtk_xml, vtk_unstructured, vtk_meshes),
        "trimesh": (trimesh_meshes,),
        "meshio": (meshio_meshes,),
    }
    return tuple(dialect for package, dialects in by_package.items() if find_spec(package) for dialect in dialects)
