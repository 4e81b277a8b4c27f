"""Arrays of numpy and tables in text, as scripts leave them."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from audits.reliability.scene import Scene
from audits.reliability.truth import MAPS, SURFACE, Truth

Written = tuple[Path, Truth]
TYPES = ("float64", "float32", "float16", "int8", "int32", "uint16", "bool", ">f8", ">i4")


def npz_surface(scene: Scene, rng: np.random.Generator, folder: Path) -> Written:
    """.npz of vertices, faces and maps, packed or not, of any type and order in memory."""
    faces = np.array([p[:3] for p in scene.polygons]).astype(str(rng.choice(["int32", "int64", "uint16"])))
    kind = str(rng.choice(["float32", "float64", ">f4"]))
    vertices = np.array(scene.vertices.astype(kind), order=str(rng.choice(["C", "F"])))  # type: ignore[call-overload]
    save = np.savez if rng.random() < 0.5 else np.savez_compressed
    path = folder / "a.npz"
    save(path, vertices=vertices, faces=faces, depth=scene.maps["gaps"], flow=scene.maps["flow"], made=np.array(3.0))
    return path, Truth(
        SURFACE, vertices.astype(float), faces.tolist(), {"depth": scene.maps["gaps"], "flow": scene.maps["flow"]}
    )


def numpy_map(scene: Scene, rng: np.random.Generator, folder: Path) -> Written:
    """.npy of any type, of one column or several."""
    values = np.round(20 * np.abs(scene.maps["flow"] if rng.random() < 0.4 else scene.maps["depth"]))
    stored = np.asarray(values.astype(str(rng.choice(TYPES))), order=str(rng.choice(["C", "F"])))  # type: ignore[call-overload]
    np.save(folder / "m.npy", stored)
    return folder / "m.npy", Truth(MAPS, maps={"m": stored.astype(float)})


def table(scene: Scene, rng: np.random.Generator, folder: Path) -> Written:
    """.csv, .txt, .dat with a header or without, byte order mark, quotes, NA and empty cells, comments."""
    suffix = str(rng.choice([".csv", ".txt", ".dat"]))
    columns = {"depth": scene.maps["depth"], "gaps": scene.maps["gaps"]}
    if rng.random() < 0.3:
        columns = {"depth": scene.maps["depth"]}
    headed = bool(rng.integers(2))
    separator = "," if suffix == ".csv" else str(rng.choice([" ", "\t", "   "]))
    unknown = str(rng.choice(["nan", "NaN", "NA", "N/A"] + ["", "null"] * (suffix == ".csv" and len(columns) > 1)))
    quote = '"' if suffix == ".csv" and rng.random() < 0.3 else ""
    lines = [separator.join(f"{quote}{name}{quote}" for name in columns)] if headed else []
    for row in zip(*(values.tolist() for values in columns.values()), strict=True):
        lines.append(separator.join(unknown if np.isnan(x) else f"{quote}{x!r}{quote}" for x in row))
    if rng.random() < 0.3:
        lines.insert(0, "# made by a script")
    text = str(rng.choice(["\n", "\r\n"])).join([*lines, ""])
    mark = b"\xef\xbb\xbf" if rng.random() < 0.3 else b""
    path = folder / f"m{suffix}"
    path.write_bytes(mark + text.encode())
    names = list(columns) if headed else ["m"] if len(columns) == 1 else ["map 1", "map 2"]
    return path, Truth(MAPS, maps=dict(zip(names, columns.values(), strict=True)))


DIALECTS = (npz_surface, numpy_map, table)
