"""Packed files are measured before they are opened: a bomb takes no memory, and what people measured passes."""

from __future__ import annotations

import gzip
import io
import resource
import struct
import zipfile
from pathlib import Path

import nibabel
import numpy as np
import pytest

from surfexp.io.map_files import read_maps
from surfexp.io.reading import read_mesh_file
from surfexp.io.unpacked_sizes import ALWAYS_READ, check_unpacked

GIGABYTE = 1 << 30


def packed_zeros(path: Path, head: bytes, size: int) -> None:
    with gzip.open(path, "wb", compresslevel=1) as stream:
        stream.write(head)
        for _ in range(size >> 24):
            stream.write(bytes(1 << 24))


@pytest.fixture(scope="module")
def bomb(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("bombs") / "map.npz"
    header = io.BytesIO()
    np.lib.format.write_array_header_1_0(header, {"descr": "<f8", "fortran_order": False, "shape": (GIGABYTE // 8,)})
    with (
        zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive,
        archive.open("map.npy", "w") as at,
    ):
        at.write(header.getvalue())
        for _ in range(64):
            at.write(bytes(1 << 24))
    return path


@pytest.mark.parametrize("read", [read_maps, read_mesh_file])
def test_an_archive_that_unpacks_to_a_thousand_times_its_size_is_refused_unopened(read, bomb: Path) -> None:
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    assert bomb.stat().st_size < 8 << 20
    with pytest.raises(ValueError, match=r"unpacked it has over .* the most that is read of a file of"):
        read(bomb)
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 100 << 10


@pytest.mark.parametrize("packed", [False, True])
def test_an_array_that_announces_more_than_there_is_makes_no_room(tmp_path: Path, packed: bool) -> None:
    header = io.BytesIO()
    np.lib.format.write_array_header_1_0(header, {"descr": "<f8", "fortran_order": False, "shape": (1 << 40,)})
    path = tmp_path / ("map.npz" if packed else "map.npy")
    if packed:
        with zipfile.ZipFile(path, "w") as archive:
            archive.writestr("map.npy", header.getvalue() + bytes(80))
    else:
        path.write_bytes(header.getvalue() + bytes(80))
    with pytest.raises(ValueError, match="an array announces 8,796,093,022,208 bytes"):
        read_maps(path)


def test_packed_volumes_are_measured_too(tmp_path: Path) -> None:
    path = tmp_path / "map.mgz"
    packed_zeros(path, struct.pack(">7i", 1, 1 << 26, 1, 1, 1, 3, 0) + bytes(256), ALWAYS_READ + (1 << 24))
    with pytest.raises(ValueError, match="unpacked it has over"):
        read_maps(path)
    image = nibabel.Nifti1Image(np.zeros((40, 1, 1), np.float32), np.eye(4))
    path = tmp_path / "map.nii.gz"
    nibabel.save(image, path)
    assert read_maps(path)["map"].shape == (40,)
    data = bytearray(gzip.decompress(path.read_bytes()))
    packed_zeros(path, bytes(data), ALWAYS_READ + (1 << 24))
    with pytest.raises(ValueError, match="unpacked it has over"):
        read_maps(path)
    struct.pack_into("<3h", data, 42, 30000, 30000, 30000)
    path.write_bytes(gzip.compress(bytes(data)))
    with pytest.raises(ValueError, match="its header says 108,000,000,000,000 bytes of data"):
        read_maps(path)


def test_what_was_measured_passes(tmp_path: Path) -> None:
    np.savez_compressed(tmp_path / "map.npz", thickness=np.zeros(200_000))
    assert read_maps(tmp_path / "map.npz")["thickness"].shape == (200_000,)
    check_unpacked(ALWAYS_READ, 1)
    check_unpacked(3 * ALWAYS_READ, ALWAYS_READ)
