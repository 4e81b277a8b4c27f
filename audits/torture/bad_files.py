"""Files that are cut, spoilt, lie about themselves, or hold surfaces that are none: read as a user would read them."""

from __future__ import annotations

import bz2
import gzip
import random
import re
import struct
import tempfile
from collections.abc import Iterator, Sequence
from functools import cache
from itertools import islice
from pathlib import Path

import numpy as np

import surfexp as sx
from audits.torture.case import REFUSED, REPAIRED, RIGHT, UNKNOWABLE, WRONG, Ended, clear, in_a_child
from audits.torture.sound_files import LABELS, MAPS, UNCOUNTED, truth, write_sound_files
from surfexp.contract.arrays import Floats, Integers
from surfexp.io.map_files import read_mask, read_named_labels, read_scalars
from surfexp.io.writing import write_mesh
from surfexp.mesh.triangle_mesh import TriangleMesh

CUTS = 16
COMPILATION = 600.0
NUMBERS = (b"nan", b"inf", b"-inf", b"1e300", b"1e-300", b"1e999", b"-1", b"4294967296", b"0.5", b"x", b"", b"0x10")
Content = tuple[str, str, bytes]


def bad_files(seed: int = 0, every: int = 1) -> Iterator[Ended]:
    """Run all cases, or one of so many."""
    with tempfile.TemporaryDirectory() as text:
        folder = Path(text)
        (folder / "sound").mkdir()
        sound = write_sound_files(folder / "sound")
        # what is compiled once on a machine is not counted
        in_a_child("sound", "a.off", lambda: _surface(folder / "sound" / "a.off", repair=True), COMPILATION, 2**32)
        for kind, name, content in islice(contents(sound, seed), 0, None, every):
            place = folder / "case"
            place.mkdir(exist_ok=True)
            for other in ("a.vert", "a.tri"):
                (place / other).write_bytes(sound[other])
            (place / name).write_bytes(content)
            yield in_a_child(kind, name, lambda file=place / name, kind=kind: _read(file, kind))  # type: ignore[misc]
            (place / name).unlink()
        for kind, mesh in islice(surfaces(seed), 0, None, every):
            yield from _surface_cases(kind, *mesh, folder)


def contents(sound: dict[str, bytes], seed: int) -> Iterator[Content]:
    """Spoil every sound file in every way that its bytes allow: (kind, file name, bytes)."""
    rng = random.Random(seed)
    for name, whole in sound.items():
        for part in range(CUTS):
            yield "cut off", name, whole[: len(whole) * part // CUTS]
        yield "cut off", name, whole[:-1]
        yield "bytes behind the end", name, whole + b"\x00\x01garbage\xff"
        yield "wrong format", name, b"\x89PNG\r\n\x1a\n" + whole[:200]
        yield "UTF-16", name, whole[:4000].decode("latin-1").encode("utf-16")
        for _ in range(4):
            spoilt = bytearray(whole)
            for _ in range(3):
                spoilt[rng.randrange(len(spoilt))] = rng.randrange(256)
            yield "bytes changed", name, bytes(spoilt)
        if _is_text(whole):
            yield "line ends of Windows", name, whole.replace(b"\n", b"\r\n")
            for number in NUMBERS:
                places = [match.span() for match in re.finditer(rb"(?<![\w.-])-?\d+(\.\d+)?(e-?\d+)?(?![\w.])", whole)]
                start, stop = rng.choice(places)
                yield f"a number that is {number.decode() or 'missing'}", name, whole[:start] + number + whole[stop:]
        elif len(whole) > 64:
            yield "counts that lie", name, _larger_counts(whole)
            yield "zeros", name, whole[:64] + bytes(len(whole) - 64)
    yield "a bomb", "a.surf.gii.gz", _bomb()
    yield "a bomb", "m.mgz", _bomb()
    yield "a bomb", "a.obj", bz2.compress(bytes(2**24))
    entities = (
        b'<!DOCTYPE x [<!ENTITY a "'
        + b"a" * 999
        + b'">'
        + b"".join(b'<!ENTITY %c "%s">' % (98 + k, b"&%c;" % (97 + k) * 10) for k in range(9))
    )
    for name in ("a.surf.gii", "a.vtp", "m.shape.gii"):
        yield (
            "a bomb",
            name,
            b'<?xml version="1.0"?>' + entities + b"]>" + sound[name].partition(b"?>")[2].replace(b"\n", b"&j;", 3),
        )


def surfaces(seed: int) -> Iterator[tuple[str, tuple[Floats, Integers]]]:
    """Surfaces that are none, or hardly: (kind, (vertices, faces))."""
    known = truth()
    v, f = known.vertices, known.faces
    yield "index out of range", (v, np.where(f == 3, len(v) + 5, f))
    yield "negative index", (v, np.where(f == 3, -2, f))
    yield "coordinates not finite", (np.where(v == v[3], np.nan, v), f)
    yield "coordinates not finite", (np.where(v == v[3], np.inf, v), f)
    yield "coordinates of 1e300", (v * 1e300, f)
    yield "coordinates of 1e-300", (v * 1e-300, f)
    yield "all vertices in one place", (v * 0.0, f)
    yield "a face of no area", (v, np.concatenate([f, [[0, 1, 1]]]))
    yield "slivers", (v * [1.0, 1.0, 1e-9], f)
    yield "a flipped face", (v, np.concatenate([[f[0, ::-1]], f[1:]]))
    yield "a face twice", (v, np.concatenate([f, f[:1]]))
    yield (
        "three faces at an edge",
        (np.concatenate([v, [[3.0, 3.0, 3.0]]]), np.concatenate([f, [[f[0, 0], f[0, 1], len(v)]]])),
    )
    yield "vertices in no face", (np.concatenate([v, v + 5.0]), f)
    yield "no face", (v, f[:0])
    yield "no vertex", (v[:0], f[:0])
    yield "one face", (v, f[:1])
    yield "bow tie", (np.concatenate([v, v[1:] + 2.0 * v[0]]), np.concatenate([f, np.where(f == 0, 0, f + len(v) - 1)]))
    copies = np.concatenate([v + 3.0 * k for k in range(1000)])
    yield "a thousand components", (copies, np.concatenate([f + len(v) * k for k in range(1000)]))
    yield "Moebius strip", _band(30, twist=True)
    yield "Klein bottle", _klein(20)
    yield (
        "T-junction",
        (
            np.array([[0.0, 0, 0], [2, 0, 0], [1, 1, 0], [1, 0, 0], [1, -1, 0]]),
            np.array([[0, 1, 2], [0, 4, 3], [3, 4, 1]]),
        ),
    )


def _surface_cases(kind: str, vertices: Floats, faces: Integers, folder: Path) -> Iterator[Ended]:
    for name in ("s.off", "s.ply", "s.surf.gii"):
        file = folder / name
        if kind in ("index out of range", "negative index", "coordinates not finite", "no face", "no vertex"):
            if name != "s.off":
                continue
            rows = "".join(f"{x!r} {y!r} {z!r}\n" for x, y, z in vertices.tolist())
            rows += "".join(f"3 {a} {b} {c}\n" for a, b, c in faces.tolist())
            file.write_text(f"OFF\n{len(vertices)} {len(faces)} 0\n{rows}")
        else:
            try:
                write_mesh(file, TriangleMesh(vertices, faces))
            except ValueError as error:
                wrong = clear(str(error))
                yield Ended(kind, name, WRONG if wrong else REFUSED, wrong or str(error))
                continue
        for repair in (False, True):
            what = f"{name}, repaired" if repair else name
            yield in_a_child(kind, what, lambda file=file, repair=repair: _surface(file, repair))  # type: ignore[misc]


def _surface(file: Path, repair: bool) -> tuple[str, str]:
    """A surface that is accepted must carry modes, or their refusal must be clear; repairs and what is left out must be said."""
    surface = sx.read(file, repair=repair)
    if not (surface.mesh.areas > 0).any():
        return WRONG, "a surface that has no area was accepted"
    modes = sx.eigenpairs(surface, 4)
    if not modes.complete or not np.isfinite(modes.values).all():
        return WRONG, f"modes {modes.values} of it are not certified"
    if not np.isfinite(surface.mesh.vertices).all():
        return _said_outside(modes.notes)
    return (REPAIRED, "; ".join(surface.notes)) if surface.notes else (RIGHT, "")


def _said_outside(notes: Sequence[str]) -> tuple[str, str]:
    """Vertices without a position are outside, and every result says so."""
    said = [note for note in notes if "no finite position" in note]
    return (REPAIRED, said[0]) if said else (WRONG, "vertices without a position were left out in silence")


def _read(file: Path, kind: str) -> tuple[str, str]:
    """Read a spoilt file; what is accepted must be the truth, or a change that no reader can know of."""
    known, name = truth(), file.name
    if name in (*MAPS, "m.shape.gii.gz"):
        found, true = read_scalars(file, "left"), known.values
    elif name == LABELS[2]:
        found, true = read_mask(file, len(known.values)).astype(float), (known.labels == 2).astype(float)
    elif name in LABELS:
        found, true = read_named_labels(file, "left").keys.astype(float), known.labels.astype(float)
    else:
        surface = sx.read(file)
        mesh = surface.mesh
        if not np.isfinite(mesh.vertices[mesh.faces]).all():
            return _said_outside(sx.eigenpairs(surface, 1).notes)
        return _judged(mesh.vertices[mesh.faces], known.vertices[known.faces], kind, name)
    return _judged(found, true, kind, name)


def _judged(found: Floats, true: Floats, kind: str, name: str) -> tuple[str, str]:
    if found.shape == true.shape and np.allclose(found, true, rtol=1e-5, atol=1e-6, equal_nan=True):
        return RIGHT, ""
    if not np.isfinite(found).all() and name not in MAPS:
        return WRONG, "numbers that are not finite were accepted"
    # a changed number is a number; a file without counts may end anywhere
    if kind in ("bytes changed", "zeros") or kind.startswith("a number") or (kind == "cut off" and name in UNCOUNTED):
        return UNKNOWABLE, ""
    return WRONG, f"{found.shape} numbers were read in place of {true.shape}"


@cache
def _bomb() -> bytes:
    """A quarter of a gigabyte of zeros, compressed."""
    return gzip.compress(bytes(2**28), 9, mtime=0)


def _is_text(whole: bytes) -> bool:
    return not set(whole[:2000]) - set(bytes(range(32, 127)) + b"\n\r\t")


def _larger_counts(whole: bytes) -> bytes:
    """Every four bytes of the head that look like a count of vertices, faces or values, made large."""
    spoilt = whole
    for count in (42, 80, 126):
        for order in "<>":
            spoilt = (
                spoilt[:400].replace(struct.pack(f"{order}i", count), struct.pack(f"{order}i", 2**31 - 1))
                + spoilt[400:]
            )
    return spoilt


def _band(count: int, twist: bool) -> tuple[Floats, Integers]:
    angle = 2.0 * np.pi * np.arange(count) / count
    half = 0.5 * angle if twist else 0.0 * angle
    axis = np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=1)
    across = np.cos(half)[:, None] * axis + np.sin(half)[:, None] * np.array([0.0, 0.0, 1.0])
    vertices = np.concatenate([axis + 0.3 * across, axis - 0.3 * across])
    faces = []
    for k in range(count):
        a, b, c, d = k, k + count, (k + 1) % count, (k + 1) % count + count
        if k == count - 1 and twist:
            c, d = d, c
        faces += [[a, b, c], [c, b, d]]
    return vertices, np.array(faces)


def _klein(count: int) -> tuple[Floats, Integers]:
    u, v = np.meshgrid(2.0 * np.pi * np.arange(count) / count, 2.0 * np.pi * np.arange(count) / count, indexing="ij")
    r = 2.0 + np.cos(0.5 * u) * np.sin(v) - np.sin(0.5 * u) * np.sin(2.0 * v)
    z = np.sin(0.5 * u) * np.sin(v) + np.cos(0.5 * u) * np.sin(2.0 * v)
    vertices = np.stack([r * np.cos(u), r * np.sin(u), z], axis=-1).reshape(-1, 3)

    def at(i: int, j: int) -> int:
        return (i % count) * count + ((j if i < count else -j) % count)

    faces = [
        face
        for i in range(count)
        for j in range(count)
        for face in ([at(i, j), at(i + 1, j), at(i, j + 1)], [at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)])
    ]
    return vertices, np.array(faces)
