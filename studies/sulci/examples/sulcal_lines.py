"""The longest sulcus of the average brain: its line by the Reeb graph, its length, and a label file for other tools."""

from pathlib import Path
from tempfile import mkdtemp

from surfexp.anatomy.fsaverage5 import fsaverage5
from surfexp.io.label_files import read_labels, write_labels
from surfexp_studies.sulci.sulcal_lines import sulcal_line
from surfexp_studies.sulci.sulcal_regions import sulcal_regions

mesh = fsaverage5("left", "pial").mesh
regions = sulcal_regions(mesh)
lines = [sulcal_line(mesh, regions == k) for k in range(6)]
longest = max((line for line in lines if line.chain), key=lambda line: line.lengths["line with ends"])
print(", ".join(f"{name} {length:.0f} mm" for name, length in longest.lengths.items()))
path = Path(mkdtemp()) / "lh.sulci.annot"
write_labels(path, regions + 1, ["unknown", *(f"region {k + 1}" for k in range(regions.max() + 1))])
print(f"{path.name}: {len(read_labels(path)[1])} labels")
