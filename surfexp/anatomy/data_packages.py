"""Packages of the index that carry data which does not come with this project: which files, and what they must contain."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from functools import cache
from importlib.util import find_spec
from pathlib import Path

from surfexp.extras import MissingExtra


@dataclass(frozen=True)
class DataPackage:
    """A package that somebody installs for the data in it; nothing of it is copied.

    Parameters
    ----------
    module : str
        As it is imported; it is found without importing it.
    requirement : str
        What to install, with the version whose files were seen.
    terms : str
        One sentence on who may use the data, and where that is written.
    experiments : tuple of str
        Experiments that read it.
    files : dict of str to str
        SHA-256 by path below the package's folder.
    """

    module: str
    requirement: str
    terms: str
    experiments: tuple[str, ...]
    files: dict[str, str]

    def folder(self) -> Path | None:
        """Return where the package is installed, None where it is not."""
        found = find_spec(self.module)
        places = None if found is None else found.submodule_search_locations
        return None if not places else Path(next(iter(places)))

    def file(self, path: str) -> Path:
        """Return one of the files, checked.

        Raises
        ------
        MissingExtra
            If the package is not installed.
        ValueError
            If the file is missing or is another one than was seen.
        """
        folder = self.folder()
        if folder is None:
            raise MissingExtra(
                f"{path} is in {self.requirement}, which is not installed: pip install '{self.requirement}'"
            )
        place = folder / path
        if fault := _fault(place, self.files[path]):
            raise ValueError(f"{path} of {self.module} {fault}: pip install --force-reinstall '{self.requirement}'")
        return place

    def faults(self) -> list[str]:
        """Return a line for each file that is missing or is another one than was seen; empty without the package."""
        folder = self.folder()
        if folder is None:
            return []
        checked = {path: _fault(folder / path, digest) for path, digest in self.files.items()}
        return [f"{path} {fault}" for path, fault in checked.items() if fault]


@cache
def _fault(place: Path, digest: str) -> str:
    if not place.is_file():
        return "is missing"
    with place.open("rb") as stream:
        found = hashlib.file_digest(stream, "sha256").hexdigest()
    return "" if found == digest else f"has the SHA-256 {found[:12]}..., not {digest[:12]}..."


MAPS, SURFACES = "datasets/matrices/main_group", "datasets/surfaces"
RUN = "datasets/preprocessing/sub-010188_ses-02_task-rest_acq-AP_run-01"

BRAINSPACE = DataPackage(
    "brainspace",
    "brainspace==0.3.0",
    "The package is under the BSD-3-Clause licence and states no other terms for its data. Its maps are means over people of "
    "the Human Connectome Project (Vos de Wael et al. 2018), whose terms of use have to be read before they are passed on.",
    ("smoothing_race_measured", "geometric_modes_measured"),
    {
        f"{MAPS}/conte69_32k_thickness.csv": "b46f7735b689f452e780773fba476285814f53bc4b2008b4d562d81e76c0c99b",
        f"{MAPS}/conte69_32k_t1wt2w.csv": "00dc813bbf81bfa248584f0bdef513cbe65df5e671ee3541504fb2458880851e",
        f"{MAPS}/conte69_32k_curvature.csv": "90d3d6c7c34be96a7ba2093f944c2e437e84944ca13c5be12cb92185ce7b222c",
        f"{MAPS}/conte69_32k_fc_gradient0.csv": "13b8bf912dc543204c1653b3f6832fe54c4962bfcb54e9f101baec58b985d888",
        f"{MAPS}/conte69_32k_fc_gradient1.csv": "e8bbd5faec4d3da3c3e3a9755c8164fd7a7c6d51fd001cdd0c34e4eaca412e48",
        f"{MAPS}/conte69_32k_mpc_gradient0.csv": "d014755cc0d5c2e7db8798d5679f9978657ee30435a2ce6d47bc0a06a586b5e5",
        f"{MAPS}/conte69_32k_mpc_gradient1.csv": "d77732ba571af609a9f9788c4b5f982d6c1c7442387198093326f2fb13ce9cf8",
        f"{SURFACES}/conte69_32k_lh.gii": "227a092f5001d570f331428c22847b23cbced535578dd713b9739e6b9b0e2225",
        f"{SURFACES}/conte69_32k_lh_mask.csv": "d1c0fdd77ac51a4ccb975a4b513312dbdafd3447f24ebd0f4079642369145b6a",
        f"{SURFACES}/conte69_32k_lh_sphere.gii": "1846b053f870405466776d004d714cc1da0cec7361761c65a864782dd09f30a8",
        f"{SURFACES}/conte69_32k_rh.gii": "3279b4c7f26f0f8919a44f7179653c6c1df112907180395ca69bc63ac234a032",
        f"{SURFACES}/conte69_32k_rh_mask.csv": "28c423e3b516eda485ffb2d5f0b63533f6c1088f9b14ac42a4e4184f7a290393",
        f"{SURFACES}/conte69_32k_rh_sphere.gii": "1a898433a9f1070e4e0435d4db966776ecc3291bfcd444efc7910aeffb91561c",
        f"{RUN}.fsa5.lh.mgz": "8e1a7ceb56b7f9fc5b5c2de2db5c7f978a3b1d6c86e3b7eb251b3c262bbfaafc",
        f"{RUN}.fsa5.rh.mgz": "896b76a739beebf19d6da5190169519c02bd82cc2ff71d9adcfa28a118747d10",
        f"{RUN}_confounds.txt": "d94687049887a352d073887e8ccd0c580ddd3f2350df5c9d960c8dfc2278d858",
    },
)
PACKAGES = {package.module: package for package in (BRAINSPACE,)}
