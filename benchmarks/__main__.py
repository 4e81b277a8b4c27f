"""`python -m benchmarks [--quick] [NAME ...]`: run lines, print them, and write BENCHMARKS.md after a whole run."""

from __future__ import annotations

import argparse
import importlib
import time

from benchmarks import ROOT
from benchmarks.gap_curves import gap_curves
from benchmarks.line import Line
from benchmarks.table import conditions, describe, page
from surfexp.figures.encode import encode_png

PICTURE = ROOT / "docs" / "gap_against_time.png"

SECTIONS = {
    "Variational image processing": ("denoising", "segmentation", "parametrization", "scaling", "threads"),
    "Laplace-Beltrami eigen-geometry": ("eigenpairs", "eigenpairs_range", "nodal_domains", "assembly"),
    "Skeletons": ("skeleton",),
    "Spectral distances": ("embedding",),
    "What a user waits for": ("waiting",),
}


def main() -> None:
    """Run the groups that are named, all by default."""
    names = [name for group in SECTIONS.values() for name in group]
    parser = argparse.ArgumentParser(prog="benchmarks", description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"groups of lines: {', '.join(names)}")
    parser.add_argument("--quick", action="store_true", help="small sizes, to see that all runs; writes nothing")
    options = parser.parse_args()
    for unknown in set(options.names) - set(names):
        parser.error(f"group {unknown!r} is unknown, choose from {', '.join(names)}")
    print(conditions())
    sections: dict[str, list[Line]] = {}
    compilation: dict[str, float] = {}
    for heading, groups in SECTIONS.items():
        for name in groups:
            if options.names and name not in options.names:
                continue
            group = importlib.import_module(f"benchmarks.{name}")
            begin = time.process_time()
            group.warm_up()
            compilation[name] = time.process_time() - begin
            found = group.lines(options.quick)
            sections.setdefault(heading, []).extend(found)
            print("\n".join(describe(line) for line in found), flush=True)
    if not options.names and not options.quick:
        PICTURE.write_bytes(encode_png(gap_curves().pixels))
        (ROOT / "BENCHMARKS.md").write_text(page(sections, compilation), encoding="utf-8")


if __name__ == "__main__":
    main()
