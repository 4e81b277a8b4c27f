"""What `clean` removes lies below the results folder itself: no link is followed or taken away."""

from __future__ import annotations

from pathlib import Path

import pytest

from surfexp.commands.command_line import main


def test_clean_follows_no_link(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    results, elsewhere = tmp_path / "results", tmp_path / "elsewhere"
    (elsewhere / "spectrum/key").mkdir(parents=True)
    (elsewhere / "spectrum/key/result.npz").write_bytes(b"mine")
    (elsewhere / "empty").mkdir()
    results.mkdir()
    (results / "store").symlink_to(elsewhere)
    main(["clean", "--all", "--yes", "--results", str(results)])
    assert (elsewhere / "empty").is_dir()
    assert (elsewhere / "spectrum/key/result.npz").read_bytes() == b"mine"
    assert "left alone: 1" in capsys.readouterr().err


def test_clean_leaves_a_link_among_results(tmp_path: Path) -> None:
    results, elsewhere = tmp_path / "results", tmp_path / "elsewhere"
    elsewhere.mkdir()
    (elsewhere / "mine").write_bytes(b"mine")
    (results / "store/spectrum/old").mkdir(parents=True)
    (results / "store/spectrum/old/broken").symlink_to("nowhere")
    (results / "store/spectrum/linked").symlink_to(elsewhere)
    assert main(["clean", "--all", "--yes", "--results", str(results)]) == 0
    assert (elsewhere / "mine").exists()
    assert not (results / "store/spectrum/old").exists()
    assert (results / "store/spectrum/linked").is_symlink()
