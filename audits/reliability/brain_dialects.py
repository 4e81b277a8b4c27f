"""FreeSurfer's, GIFTI's and CIFTI's files, by nibabel and by hand: surfaces, maps, labels and masks."""

from __future__ import annotations

import base64
import gzip
import warnings
import zlib
from pathlib import Path
from xml.sax.saxutils import escape

import nibabel
import numpy as np
from nibabel import cifti2

from audits.reliability.scene import Scene
from audits.reliability.truth import LABELS, MAPS, MASK, SURFACE, Truth

Written = tuple[Path, Truth]
STAMP = b"created by somebody on Mon Jan  1 00:00:00 2001"


def _triangles(scene: Scene) -> list[list[int]]:
    return [[p[0], p[k], p[k + 1]] for p in scene.polygons for k in range(1, len(p) - 1)]


def freesurfer_triangles(scene: Scene, rng: np.random.Generator, folder: Path) -> Written:
    """lh.white with two ends of line behind the stamp or one; nothing, tags or the volume's geometry behind the faces."""
    faces, path = _triangles(scene), folder / "lh.white"
    if rng.random() < 0.5:
        volume = {
            "head": [2, 0, 20],
            "valid": "1  # volume info valid",
            "filename": "../mri/filled-pretess255.mgz",
            "volume": [256, 256, 256],
            "voxelsize": [1.0, 1.0, 1.0],
            "xras": [-1.0, 0.0, 0.0],
            "yras": [0.0, 0.0, -1.0],
            "zras": [0.0, 1.0, 0.0],
            "cras": [5.4, 18.0, 0.0],
        }
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            nibabel.freesurfer.write_geometry(
                path, scene.vertices, np.array(faces), volume_info=volume if rng.integers(2) else None
            )
        return path, Truth(SURFACE, scene.single, faces)
    counts = np.array([len(scene.vertices), len(faces)], ">i4").tobytes()
    stamp = STAMP + b"\n" * int(rng.integers(1, 3))
    body = scene.vertices.astype(">f4").tobytes() + np.array(faces, ">i4").tobytes()
    behind = np.array([3], ">i4").tobytes() + bytes(4) + b"\x08" + b"cmdline\x00" if rng.random() < 0.5 else b""
    path.write_bytes(b"\xff\xff\xfe" + stamp + counts + body + behind)
    return path, Truth(SURFACE, scene.single, faces)


def freesurfer_quadrangles(scene: Scene, rng: np.random.Generator, folder: Path) -> Written:
    """The old quadrangle file, coordinates in hundredths or as numbers; nibabel cuts by the even and odd first corner."""
    new, path = bool(rng.integers(2)), folder / "lh.orig"
    quads = [p if len(p) == 4 else [p[0], p[1], p[2], p[2]] for p in scene.polygons if len(p) in (3, 4)]
    magic = b"\xff\xff\xfd" if new else b"\xff\xff\xff"
    head = magic + len(scene.vertices).to_bytes(3, "big") + len(quads).to_bytes(3, "big")
    if new:
        places, points = scene.vertices.astype(">f4"), scene.single
    else:
        places = np.round(np.clip(scene.vertices, -300, 300) * 100).astype(">i2")
        points = places.astype(float) / 100.0
    path.write_bytes(head + places.tobytes() + b"".join(int(k).to_bytes(3, "big") for q in quads for k in q))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        faces = nibabel.freesurfer.read_geometry(path)[1].tolist()
    return path, Truth(SURFACE, points, faces, tolerance=1e-6)


def freesurfer_text(scene: Scene, rng: np.random.Generator, folder: Path) -> Written:
    """.asc of mris_convert."""
    faces, path = _triangles(scene), folder / "lh.white.asc"
    rows = [f"{x:.6f}  {y:.6f}  {z:.6f}  0" for x, y, z in scene.vertices.tolist()]
    corners = [" ".join(map(str, f)) + " 0" for f in faces]
    head = ["#!ascii version of lh.white", f"{len(rows)} {len(faces)}"]
    path.write_text("\n".join([*head, *rows, *corners]) + str(rng.choice(["", "\n"])))
    return path, Truth(SURFACE, np.round(scene.vertices, 6), faces, tolerance=1e-9)


def curvature(scene: Scene, rng: np.random.Generator, folder: Path) -> Written:
    """lh.sulc, new (nibabel's) or old in hundredths; mris_convert's text."""
    values, way = scene.maps["depth"], int(rng.integers(3))
    if way == 0:
        path = folder / "lh.sulc"
        nibabel.freesurfer.write_morph_data(path, values, fnum=int(rng.integers(0, 99)))
        return path, Truth(MAPS, maps={"lh.sulc": values.astype(np.float32).astype(float)})
    if way == 1:
        path, kept = folder / "lh.curv", np.round(values * 100).astype(">i2")
        head = len(values).to_bytes(3, "big") + len(scene.polygons).to_bytes(3, "big")
        path.write_bytes(head + kept.tobytes())
        return path, Truth(MAPS, maps={"lh.curv": kept.astype(float) / 100.0}, tolerance=1e-12)
    path = folder / "lh.thickness.asc"
    rows = zip(range(len(values)), scene.vertices.tolist(), values.tolist(), strict=True)
    path.write_text("".join(f"{k:03d} {x:.5f} {y:.5f} {z:.5f} {value!r}\n" for k, (x, y, z), value in rows))
    return path, Truth(MAPS, maps={"lh.thickness": values})


def annotation(scene: Scene, rng: np.random.Generator, folder: Path) -> Written:
    """.annot with the new table of colours (nibabel's) or the old one, vertices in any order, colours without a name."""
    path, count = folder / "lh.aparc.annot", len(scene.names)
    colours = np.array([[25 * k + 5, 9 * k, 3 * k, 0] for k in range(count)])
    keys = colours @ np.array([1, 1 << 8, 1 << 16, 1 << 24])
    if rng.random() < 0.4:
        nibabel.freesurfer.write_annot(path, scene.labels, np.column_stack([colours, keys]), list(scene.names))
        return path, Truth(LABELS, labels=[scene.names[k] for k in scene.labels])
    stray = rng.random(len(scene.labels)) < 0.1
    values = np.where(stray, 123456789, keys[scene.labels])
    order = rng.permutation(len(values))
    pairs = np.column_stack([order, values[order]]).astype(">i4").tobytes()
    entries = [(k, (name + "\0").encode(), colours[k]) for k, name in enumerate(scene.names)]
    number = lambda k: int(k).to_bytes(4, "big", signed=True)  # noqa: E731
    file = b"colortable.txt\0"
    if rng.random() < 0.5:
        table = number(count) + number(len(file)) + file
        table += b"".join(number(len(name)) + name + b"".join(map(number, colour)) for _, name, colour in entries)
    else:
        table = number(-2) + number(count) + number(len(file)) + file + number(count)
        table += b"".join(number(k) + number(len(name)) + name + b"".join(map(number, c)) for k, name, c in entries)
    path.write_bytes(number(len(values)) + pairs + number(1) + table)
    labels = ["" if lost else scene.names[k] for lost, k in zip(stray, scene.labels, strict=True)]
    return path, Truth(LABELS, labels=labels)


def label_list(scene: Scene, rng: np.random.Generator, folder: Path) -> Written:
    """.label, vertices in any order, and -1 for points that have none."""
    path = folder / "lh.cortex.label"
    inside = rng.permutation(np.flatnonzero(scene.mask))
    rows = [f"{k}  {scene.vertices[k, 0]:.3f}  0.000  0.000 0.0000000000" for k in inside]
    if rng.random() < 0.3:
        rows.insert(0, "-1  1.0  2.0  3.0 0.0")
    head = str(rng.choice(["#!ascii label  , from subject  vox2ras=TkReg", "#"]))
    path.write_text("\n".join([head, str(len(rows)), *rows]) + "\n")
    return path, Truth(MASK, mask=scene.mask)


def volume_map(scene: Scene, rng: np.random.Generator, folder: Path) -> Written:
    """.mgh, .mgz, .nii, .nii.gz of one row of voxels along any axis, of several types and frames, scaled."""
    values, n = scene.maps["depth"], len(scene.vertices)
    axis, suffix = int(rng.integers(3)), str(rng.choice([".mgh", ".mgz", ".nii", ".nii.gz"]))
    path = folder / f"lh.map{suffix}"
    shape = [1, 1, 1]
    shape[axis] = n
    several = rng.random() < 0.3
    data = (scene.maps["flow"] if several else values[:, None]).reshape(*shape, -1)
    kind = str(rng.choice(["float32", "int16", "uint8", "int32"]))
    if kind != "float32":
        data = np.round(np.clip(40 * data + 60, 0, 255))
    stored = data.astype(kind)
    stored = stored if several else stored[..., 0]
    if suffix in (".mgh", ".mgz"):
        image = nibabel.freesurfer.MGHImage(stored, np.eye(4))
        told = stored.astype(float)
    else:
        image = (nibabel.Nifti1Image if rng.random() < 0.7 else nibabel.Nifti2Image)(stored, np.eye(4))
        told = stored.astype(float)
    nibabel.save(image, path)
    if suffix == ".nii" and type(image) is nibabel.Nifti1Image and rng.random() < 0.5:
        content = path.read_bytes()  # slope and intercept of the header
        path.write_bytes(content[:112] + np.array([0.5, 3.0], "<f4").tobytes() + content[120:])
        told = told * 0.5 + 3.0
    told = told.reshape(n, -1)
    return path, Truth(MAPS, maps={"lh.map": told[:, 0] if told.shape[1] == 1 else told}, tolerance=1e-6)


class _Gifti:
    """A GIFTI file by hand, so that every encoding, order of bytes and order of axes is written."""

    def __init__(self, rng: np.random.Generator, folder: Path) -> None:
        self.encoding = str(rng.choice(["ASCII", "Base64Binary", "GZipBase64Binary", "ExternalFileBinary"]))
        self.endian = str(rng.choice(["LittleEndian", "BigEndian"]))
        self.order = str(rng.choice(["RowMajorOrder", "ColumnMajorOrder"]))
        self.folder, self.rng = folder, rng
        self.external, self.parts, self.table = b"", list[str](), ""

    def array(self, values: np.ndarray, intent: str, meta: dict[str, str] | None = None, system: bool = False) -> None:
        code, kind = {"f": ("f4", "FLOAT32"), "i": ("i4", "INT32")}[values.dtype.kind]
        if values.dtype.kind == "f" and self.rng.random() < 0.2 and intent != "NIFTI_INTENT_POINTSET":
            code, kind = "f8", "FLOAT64"
        flat = values.ravel(order="F" if self.order.startswith("Column") else "C").astype(code)
        raw = flat.astype((">" if self.endian == "BigEndian" else "<") + code).tobytes()
        file, offset, text = "", 0, ""
        if self.encoding == "ASCII":
            text = " ".join(f"{x:.9g}" if code == "f4" else repr(x) for x in flat.tolist())
        elif self.encoding == "Base64Binary":
            text = base64.b64encode(raw).decode()
        elif self.encoding == "GZipBase64Binary":
            text = base64.b64encode(zlib.compress(raw)).decode()
        else:
            file, offset, self.external = "beside.dat", len(self.external), self.external + raw
        sizes = " ".join(f'Dim{k}="{length}"' for k, length in enumerate(values.shape))
        pairs = "".join(
            f"<MD><Name><![CDATA[{k}]]></Name><Value><![CDATA[{v}]]></Value></MD>" for k, v in (meta or {}).items()
        )
        space = (
            "<CoordinateSystemTransformMatrix><DataSpace><![CDATA[NIFTI_XFORM_UNKNOWN]]></DataSpace><TransformedSpace>"
            "<![CDATA[NIFTI_XFORM_TALAIRACH]]></TransformedSpace><MatrixData>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</MatrixData>"
            "</CoordinateSystemTransformMatrix>"
            if system
            else ""
        )
        self.parts.append(
            f'<DataArray Intent="{intent}" DataType="NIFTI_TYPE_{kind}" ArrayIndexingOrder="{self.order}" '
            f'Dimensionality="{values.ndim}" {sizes} Encoding="{self.encoding}" Endian="{self.endian}" '
            f'ExternalFileName="{file}" ExternalFileOffset="{offset if file else ""}">\n<MetaData>{pairs}</MetaData>\n'
            f"{space}<Data>{text}</Data>\n</DataArray>\n"
        )

    def save(self, name: str) -> Path:
        if self.external:
            (self.folder / "beside.dat").write_bytes(self.external)
        text = (
            '<?xml version="1.0" encoding="UTF-8"?>\n'
            '<!DOCTYPE GIFTI SYSTEM "http://www.nitrc.org/frs/download.php/115/gifti.dtd">\n'
            f'<GIFTI Version="1.0" NumberOfDataArrays="{len(self.parts)}">\n<MetaData/>\n'
            f"<LabelTable>{self.table}</LabelTable>\n{''.join(self.parts)}</GIFTI>\n"
        ).encode()
        packed = self.rng.random() < 0.2 and not self.external
        path = self.folder / (name + ".gz" if packed else name)
        path.write_bytes(gzip.compress(text) if packed else text)
        return path


def gifti_surface(scene: Scene, rng: np.random.Generator, folder: Path) -> Written:
    """.surf.gii in all encodings, with a transform, triangles before points, maps beside the surface."""
    file, faces = _Gifti(rng, folder), _triangles(scene)
    maps = {}
    arrays = [
        lambda: file.array(scene.vertices, "NIFTI_INTENT_POINTSET", {"AnatomicalStructurePrimary": "CortexLeft"}, True),
        lambda: file.array(np.array(faces), "NIFTI_INTENT_TRIANGLE"),
    ]
    if rng.random() < 0.5:
        arrays.append(lambda: file.array(scene.maps["gaps"].astype(np.float32), "NIFTI_INTENT_SHAPE", {"Name": "gaps"}))
        maps["gaps"] = scene.maps["gaps"].astype(np.float32).astype(float)
    for k in rng.permutation(len(arrays)):
        arrays[k]()
    return file.save("a.surf.gii"), Truth(SURFACE, scene.single, faces, maps)


def gifti_maps(scene: Scene, rng: np.random.Generator, folder: Path) -> Written:
    """.func.gii of one array or several, with node indices, of rows of numbers, without names."""
    file, n = _Gifti(rng, folder), len(scene.vertices)
    named, several = bool(rng.integers(2)), bool(rng.integers(2))
    values = {"depth": scene.maps["depth"]} | (
        {"gaps": scene.maps["gaps"], "flow": scene.maps["flow"]} if several else {}
    )
    kept = np.arange(n)
    if rng.random() < 0.4:
        kept = rng.permutation(np.append(np.flatnonzero(rng.random(n - 1) < 0.7), n - 1))
        file.array(kept, "NIFTI_INTENT_NODE_INDEX")
    maps = {}
    for number, (name, row) in enumerate(values.items(), 1):
        given = row.astype(np.float32).astype(float)
        whole = np.full(given.shape, np.nan)
        whole[kept] = given[kept]
        file.array(given[kept], "NIFTI_INTENT_NONE", {"Name": name} if named else {})
        maps[name if named else f"map {number}"] = whole
    path = file.save("sub-1_hemi-L.func.gii")
    if not named and not several:
        maps = {"sub-1_hemi-L": maps["map 1"]}
    return path, Truth(MAPS, maps=maps)


def gifti_labels(scene: Scene, rng: np.random.Generator, folder: Path) -> Written:
    """.label.gii with keys that do not count up, with node indices, with keys that the table does not name."""
    file, n = _Gifti(rng, folder), len(scene.vertices)
    numbers = rng.permutation(200)[: len(scene.names)]
    keys = numbers[scene.labels].astype(np.int32)
    stray = rng.random(n) < 0.1
    keys[stray] = 777
    file.table = "".join(
        f'<Label Key="{k}" Red="0.5" Green="0.1" Blue="{0.1 * i}" Alpha="1"><![CDATA[{escape(name)}]]></Label>'
        for i, (k, name) in enumerate(zip(numbers, scene.names, strict=True))
    )
    kept = np.arange(n)
    if rng.random() < 0.3:
        kept = np.append(np.flatnonzero(rng.random(n - 1) < 0.7), n - 1)
        file.array(kept, "NIFTI_INTENT_NODE_INDEX")
    if rng.random() < 0.3:
        file.array(scene.maps["depth"][kept], "NIFTI_INTENT_SHAPE", {"Name": "depth"})
    file.array(keys[kept], "NIFTI_INTENT_LABEL")
    labels = ["" if lost else scene.names[k] for lost, k in zip(stray, scene.labels, strict=True)]
    inside = set(kept.tolist())
    return file.save("lh.parcels.label.gii"), Truth(
        LABELS, labels=[x if k in inside else "" for k, x in enumerate(labels)]
    )


def _models(scene: Scene, rng: np.random.Generator) -> tuple[cifti2.BrainModelAxis, np.ndarray, np.ndarray]:
    """Left cortex without its medial wall, often beside the right one and voxels; columns of the left, vertices."""
    left = np.append(scene.mask[:-1], True)
    parts = [cifti2.BrainModelAxis.from_mask(left, name="CIFTI_STRUCTURE_CORTEX_LEFT")]
    if rng.random() < 0.7:
        parts.append(cifti2.BrainModelAxis.from_mask(rng.random(30) < 0.5, name="CIFTI_STRUCTURE_CORTEX_RIGHT"))
    if rng.random() < 0.5:
        voxels = cifti2.BrainModelAxis.from_mask(
            np.ones((2, 2, 2)), affine=np.eye(4), name="CIFTI_STRUCTURE_THALAMUS_LEFT"
        )
        parts.append(voxels)
    order = rng.permutation(len(parts))
    axis, at, columns = None, 0, np.zeros(0, int)
    for k in order:
        if k == 0:
            columns = np.arange(at, at + len(parts[0]))
        at += len(parts[k])
        axis = parts[k] if axis is None else axis + parts[k]
    return axis, columns, np.flatnonzero(left)


def cifti_maps(scene: Scene, rng: np.random.Generator, folder: Path) -> Written:
    """.dscalar.nii and .dtseries.nii of one or both hemispheres and voxels; .pscalar.nii has to be refused."""
    axis, columns, vertices = _models(scene, rng)
    kind, rows = str(rng.choice(["dscalar", "dtseries", "pscalar"])), int(rng.integers(1, 4))
    data = rng.standard_normal((rows, len(axis))).astype(np.float32)
    whole = np.full((rows, len(scene.vertices)), np.nan)
    whole[:, vertices] = data[:, columns]
    path = folder / f"a.{kind}.nii"
    if kind == "pscalar":
        parcels = cifti2.ParcelsAxis.from_brain_models([("one", axis), ("two", axis)])
        axes = (cifti2.ScalarAxis([f"map {k}" for k in range(rows)]), parcels)
        cifti2.Cifti2Image(data[:, :2], cifti2.Cifti2Header.from_axes(axes)).to_filename(path)
        return path, Truth(MAPS, refused=".dscalar.nii")
    first = (
        cifti2.SeriesAxis(0.0, 0.7, rows)
        if kind == "dtseries"
        else cifti2.ScalarAxis([f"map {k}" for k in range(rows)])
    )
    cifti2.Cifti2Image(data, cifti2.Cifti2Header.from_axes((first, axis))).to_filename(path)
    if kind == "dtseries":
        return path, Truth(MAPS, maps={"series": whole.T})
    maps = {f"map {k}": whole[k] for k in range(rows)}
    return path, Truth(MAPS, maps=maps)


def cifti_labels(scene: Scene, rng: np.random.Generator, folder: Path) -> Written:
    """.dlabel.nii of one or both hemispheres."""
    axis, columns, vertices = _models(scene, rng)
    numbers = rng.permutation(50)[: len(scene.names)]
    table = {int(k): (name, (0.1, 0.2, 0.3, 1.0)) for k, name in zip(numbers, scene.names, strict=True)}
    data = rng.choice(numbers, (1, len(axis)))
    data[0, columns] = numbers[scene.labels[vertices]]
    header = cifti2.Cifti2Header.from_axes((cifti2.LabelAxis(["parcels"], [table]), axis))
    path = folder / "a.dlabel.nii"
    cifti2.Cifti2Image(data.astype(np.float32), header).to_filename(path)
    inside = set(vertices.tolist())
    return path, Truth(LABELS, labels=[scene.names[x] if k in inside else "" for k, x in enumerate(scene.labels)])


DIALECTS = (
    freesurfer_triangles,
    freesurfer_quadrangles,
    freesurfer_text,
    curvature,
    annotation,
    label_list,
    volume_map,
    gifti_surface,
    gifti_maps,
    gifti_labels,
    cifti_maps,
    cifti_labels,
)
