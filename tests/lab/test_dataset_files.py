"""A folder, a pattern and a table of the same files are the same collection, and a bad table is refused by its line."""

from __future__ import annotations

import csv
import io
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from surfexp.commands.command_line import main
from surfexp.io.writing import write_mesh
from surfexp.lab.composition.launch import launch
from surfexp.lab.errors import UserError
from surfexp.lab.experiment.dataset_files import is_of_files, items_of_files, name_of_dataset, unused_columns
from surfexp.lab.plan.plan import Plan
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.torus import torus

FILES = ("ball0.off", "ball1.off", "ring0.off", "ring1.off")


@pytest.fixture
def bodies(working_folder: Path) -> Path:
    folder = working_folder / "bodies"
    folder.mkdir()
    for number in (0, 1):
        write_mesh(folder / f"ball{number}.off", icosphere(1, 1.0 + number).mesh)
        write_mesh(folder / f"ring{number}.off", torus(8 + number, 6).mesh)
    rows = "".join(f"bodies/{name},{name[:4]},{name[:-4]}\n" for name in FILES)
    (working_folder / "bodies.csv").write_text(f"path,class,group\n{rows}")
    return folder


def test_folder_pattern_and_table_are_one_dataset(bodies: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = items_of_files(bodies)
    assert [item["label"] for item in folder] == ["ball ball0", "ball ball1", "ring ring0", "ring ring1"]
    assert items_of_files(bodies / "*.off") == items_of_files(Path("bodies.csv")) == folder
    rings = items_of_files(bodies.parent / "bod*" / "ring?.off")
    assert [item["label"] for item in rings] == ["ring ring0", "ring ring1"]
    monkeypatch.chdir("/")  # the paths of a table are from its own folder
    assert items_of_files(bodies.parent / "bodies.csv") == folder


def test_capitals_in_names_are_no_other_files(bodies: Path) -> None:
    (bodies / "ball0.off").rename(bodies / "ball0.OFF")
    (bodies / "ring1.off").rename(bodies / "Ring1.Off")
    assert len(items_of_files(bodies)) == len(items_of_files(bodies, ["*.off"])) == 4
    assert len(items_of_files(bodies.parent, ["bodies/r*.off"])) == 2
    assert len(items_of_files(bodies, ["[b]*.off"])) == 1, "who chooses among letters is taken at that word"


@pytest.mark.parametrize("source", ["bodies", "bodies/", "bodies.csv", "bodies/*.off"])
def test_each_stands_behind_datasets_as_it_is(bodies: Path, source: str) -> None:
    plans: list[Plan] = []
    launch(["experiment=retrieval", f"datasets.bodies={source}"], plans.append)
    paths = {
        node.options["path"] for node in plans[0].nodes.values() if node.kind == "surface" and node.plugin == "file"
    }
    assert {Path(str(path)).name for path in paths} == set(FILES)
    assert is_of_files(source) and name_of_dataset(Path(source)) == "bodies"


TEXT = st.text(st.characters(exclude_categories=["C", "Zl", "Zp"]), min_size=1, max_size=12).map(str.strip).filter(bool)


@given(
    st.lists(st.tuples(TEXT, TEXT, TEXT, st.floats(allow_nan=False, allow_infinity=False)), min_size=1, max_size=5),
    st.sampled_from(",;\t"),
    st.sampled_from(["utf-8", "utf-8-sig"]),
    st.sampled_from(["\n", "\r\n"]),
)
def test_what_a_spreadsheet_writes_is_read_back(
    tmp_path_factory: pytest.TempPathFactory, rows: list[tuple], separator: str, encoding: str, line_end: str
) -> None:
    table = tmp_path_factory.mktemp("tables") / "t.csv"
    text = io.StringIO()
    writer = csv.writer(text, delimiter=separator, lineterminator=line_end)
    writer.writerow(["path", "class", "group", "label", "level", "surface.scale"])
    for place, (name, group, label, level) in enumerate(rows):
        writer.writerow([f"s{place}.off", name, group, f"{place} {label}", level, 2.5])
    table.write_text(text.getvalue(), encoding=encoding, newline="")
    expected = [
        {
            **{"label": f"{place} {label}", "class": name, "group": group, "level": level},
            "surface": {"name": "file", "path": str(table.resolve().parent / f"s{place}.off"), "scale": "2.5"},
        }
        for place, (name, group, label, level) in enumerate(rows)
    ]
    assert items_of_files(table) == expected


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "has no column 'path'; its columns are none"),
        ("file,class\na.off,x\n", "has no column 'path'; its columns are file, class"),
        ("path,class\n", "the table has no row"),
        ("path,class\n\n,x\n", "line 3: there is no path"),
        ("path,class\na.off,x,y\n", "line 2: 3 cells for 2 columns"),
        ("path,class,class\na.off,x,y\n", "has the column 'class' twice"),
        ("path,surface.path\na.off,b.off\n", "has the column 'surface.path', write path"),
        ("path,level\na.off,high\n", "the level of a.off is 'high': write a finite number"),
        ("path,level\na.off,nan\n", "write a finite number"),
        ("path\na.off\na.off\n", "two files are called 'a', a.off and a.off"),
        ('path\n"a.off\n', "line 2: unexpected end of data"),
        (b"path\n\xff\xfe\n", "cannot be read: 'utf-8' codec"),
    ],
)
def test_a_bad_table_is_refused_in_one_line(
    working_folder: Path, capsys: pytest.CaptureFixture[str], text: str | bytes, words: str
) -> None:
    (working_folder / "t.csv").write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(UserError) as refused:
        items_of_files(Path("t.csv"))
    assert words in str(refused.value)
    assert main(["collect", "t.csv"]) == 2
    said = capsys.readouterr().err
    assert words in said and len(said.splitlines()) == 1


@pytest.mark.parametrize(
    ("source", "words"),
    [
        ("nowhere", "unknown dataset 'nowhere'"),
        ("nowhere.csv", "cannot be read"),
        ("no*.off", "is called no*.off"),
        ("x" * 300, "unknown dataset"),
    ],
)
def test_a_dataset_that_is_not_there(bodies: Path, source: str, words: str) -> None:
    with pytest.raises(UserError) as refused:
        launch(["experiment=retrieval", f"datasets.bodies={source}"], [].append)
    assert words in str(refused.value)


def test_columns_that_say_nothing_are_named(bodies: Path, capsys: pytest.CaptureFixture[str]) -> None:
    table = bodies.parent / "bodies.csv"
    head, rest = table.read_text().split("\n", 1)
    table.write_text("\n".join([head + ",age,sex", *(row + ",31,f" for row in rest.split())]))
    assert unused_columns(table) == ["age", "sex"]
    assert main(["collect", "bodies.csv", "--to", "mine"]) == 0
    said = capsys.readouterr().out
    assert "columns that say nothing here: age, sex" in said and "4 of 4 files are items: ball 2, ring 2" in said
