"""MLflow's database: a copy of one that was made once, and whatever cannot be used is set aside and said."""

from __future__ import annotations

import shutil
import sqlite3
from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path

import pytest

from audits.benchmarks.synthetic_results import fill, plan_of, sweep
from surfexp.commands import finishing
from surfexp.lab.plan.plan import Plan
from surfexp.records import database_file, tracking
from surfexp.records.database_file import prepare, schema, unusable


@pytest.fixture(scope="module")
def cache(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """A user's cache of its own, with the empty database in it."""
    folder = tmp_path_factory.mktemp("cache")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_CACHE_HOME", str(folder))
        prepare(folder / "first.db")
        yield folder


@pytest.fixture
def database(tmp_path: Path, cache: Path) -> Path:
    assert prepare(tmp_path / "mlflow.db") == ""
    return tmp_path / "mlflow.db"


def plan_with_results(results: Path) -> Plan:
    plan = plan_of(sweep(2), results)
    fill(plan, results)
    (results / "views").mkdir(exist_ok=True)
    (results / "views" / "metrics.csv").write_text("leaf\n")
    return plan


def test_a_copy_is_what_mlflow_makes(database: Path, tmp_path: Path) -> None:
    from mlflow.store.tracking.sqlalchemy_store import SqlAlchemyStore

    own = tmp_path / "own.db"
    SqlAlchemyStore(f"sqlite:///{own}", str(tmp_path)).engine.dispose()
    assert schema(database) == schema(own)
    SqlAlchemyStore(f"sqlite:///{database}", "file:///somewhere").engine.dispose()
    with closing(sqlite3.connect(database)) as connection, closing(sqlite3.connect(own)) as other:
        counted = [f"SELECT count(*) FROM {name}" for name in sorted(schema(own).tables)]  # noqa: S608, its own tables
        counts = [[one.execute(query).fetchone() for query in counted] for one in (connection, other)]
        places = connection.execute("SELECT artifact_location FROM experiments").fetchall()
    assert counts[0] == counts[1]
    assert places == [("file:///somewhere/0",)]


def test_it_is_made_once_for_a_user(database: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(database_file, "_make", lambda path: pytest.fail("made again"))
    assert prepare(tmp_path / "another.db") == "" and schema(tmp_path / "another.db") == schema(database)


def test_a_cache_that_others_can_write_or_that_is_damaged_is_not_used(
    database: Path, cache: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    made: list[Path] = []
    monkeypatch.setattr(database_file, "_make", lambda path: (made.append(path), shutil.copyfile(database, path)))
    (kept,) = (cache / "surfexp" / "mlflow").glob("*.db")
    sound = kept.read_bytes()
    kept.write_bytes(sound[: len(sound) // 2])
    prepare(tmp_path / "second.db")
    assert len(made) == 1 and kept.read_bytes() == sound
    kept.parent.chmod(0o777)
    try:
        prepare(tmp_path / "third.db")
    finally:
        kept.parent.chmod(0o700)
    assert len(made) == 2 and schema(tmp_path / "third.db") == schema(database)


def truncated(file: Path) -> None:
    file.write_bytes(file.read_bytes()[:20000])


def half_made(file: Path) -> None:
    with closing(sqlite3.connect(file)) as connection:
        connection.execute("DROP TABLE latest_metrics")
        connection.commit()


def without_a_version(file: Path) -> None:
    with closing(sqlite3.connect(file)) as connection:
        connection.execute("DELETE FROM alembic_version")
        connection.commit()


def of_another_version(file: Path) -> None:
    with closing(sqlite3.connect(file)) as connection:
        connection.execute("UPDATE alembic_version SET version_num = 'abc'")
        connection.commit()


def told(plan: Plan, results: Path) -> tuple[str, ...]:
    recording = tracking.record(plan, results)
    recording.attach(results / "views")
    return recording.said


@pytest.mark.parametrize(
    ("damage", "reason"),
    [
        (truncated, "malformed"),
        (half_made, "half made (without latest_metrics)"),
        (without_a_version, "half made"),
        (of_another_version, "another version of MLflow (abc)"),
        (lambda file: file.write_bytes(b""), "half made"),
        (lambda file: file.write_bytes(b"no database" * 1000), "not a database"),
    ],
)
def test_what_cannot_be_used_is_set_aside_and_recorded_again(
    database: Path, tmp_path: Path, damage: Callable[[Path], None], reason: str
) -> None:
    plan = plan_with_results(tmp_path)
    assert told(plan, tmp_path) == ()
    damage(database)
    bytes_before = database.read_bytes()
    (line,) = told(plan, tmp_path)
    assert reason in line and "kept as mlflow.db.set-aside-1" in line and "\n" not in line
    assert (tmp_path / "mlflow.db.set-aside-1").read_bytes() == bytes_before
    assert told(plan, tmp_path) == ()
    with closing(sqlite3.connect(database)) as connection:
        assert connection.execute("SELECT count(*) FROM runs").fetchone() == (3,)


def test_a_database_that_another_process_writes_stays(database: Path) -> None:
    with closing(sqlite3.connect(database, timeout=0, isolation_level=None)) as connection:
        connection.execute("BEGIN EXCLUSIVE")
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(database_file, "SECONDS_TO_WAIT", 0.05)
            assert unusable(database, schema_of_others(database)) == ""
        connection.execute("ROLLBACK")
    assert prepare(database) == ""


def schema_of_others(database: Path) -> database_file.Schema:
    return database_file.Schema(frozenset({"runs"}), "any")


def test_what_an_interrupted_writer_left_is_undone_not_set_aside(database: Path, tmp_path: Path) -> None:
    """Another process died within a transaction: its journal is hot, the pages in the file are half written."""
    with closing(sqlite3.connect(database, isolation_level=None)) as connection:
        connection.execute("PRAGMA cache_size = 1")
        connection.execute("BEGIN IMMEDIATE")
        rows = [(f"{k:032d}",) for k in range(3000)]
        connection.executemany("INSERT INTO alembic_version VALUES (?)", rows)
        copy = tmp_path / "died.db"
        shutil.copyfile(database, copy)
        shutil.copyfile(f"{database}-journal", f"{copy}-journal")
        connection.execute("ROLLBACK")
    assert copy.read_bytes() != database.read_bytes()
    assert prepare(copy) == "" and schema(copy) == schema(database)


@pytest.mark.parametrize("deleted", [True, False])
def test_a_journal_is_never_played_into_another_database(database: Path, tmp_path: Path, deleted: bool) -> None:
    """A writer died within a transaction, and its database was deleted or damaged since; its journal is hot."""
    with closing(sqlite3.connect(database, isolation_level=None)) as connection:
        connection.execute("PRAGMA cache_size = 1")
        connection.execute("BEGIN IMMEDIATE")
        connection.executemany("INSERT INTO alembic_version VALUES (?)", [(f"{k:032d}",) for k in range(3000)])
        copy = tmp_path / "results" / "mlflow.db"
        copy.parent.mkdir()
        shutil.copyfile(f"{database}-journal", f"{copy}-journal")
        connection.execute("ROLLBACK")
    if not deleted:
        copy.write_bytes(b"no database" * 1000)
    empty = database.read_bytes()
    assert ("no database" in prepare(copy)) != deleted
    assert copy.read_bytes() == empty and schema(copy) == schema(database) and copy.read_bytes() == empty
    kept = "mlflow.db.set-aside-1-journal" if deleted else "mlflow.db.set-aside-1"
    assert {"mlflow.db", kept} <= {file.name for file in copy.parent.iterdir()}
    assert not Path(f"{copy}-journal").exists()


def test_a_copy_that_is_interrupted_leaves_no_database(
    cache: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupted(source: Path, target: Path) -> None:
        target.write_bytes(source.read_bytes()[:1000])
        raise KeyboardInterrupt

    monkeypatch.setattr(shutil, "copyfile", interrupted)
    with pytest.raises(KeyboardInterrupt):
        prepare(tmp_path / "mlflow.db")
    monkeypatch.undo()
    assert not list(tmp_path.iterdir())


def test_a_deleted_experiment_is_restored(database: Path, tmp_path: Path) -> None:
    from mlflow.tracking import MlflowClient

    plan = plan_with_results(tmp_path)
    told(plan, tmp_path)
    client = MlflowClient(tracking.tracking_uri(tmp_path))
    experiment = client.get_experiment_by_name(plan.settings.experiment)
    assert experiment is not None
    client.delete_experiment(experiment.experiment_id)
    (line,) = told(plan, tmp_path)
    assert line == f"experiment {plan.settings.experiment!r} was deleted in MLflow: it is restored"
    assert len(client.search_runs([experiment.experiment_id])) == 3


@pytest.mark.parametrize("part", ["surfexp.records.tracking.record", "surfexp.report.page.write_report"])
def test_neither_the_report_nor_mlflow_stops_a_run(
    cache: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], part: str
) -> None:
    plan = plan_with_results(tmp_path)
    path = plan.write(tmp_path)
    with monkeypatch.context() as patch:
        patch.setattr(part, lambda *_: 1 / 0)
        finishing.finish(path, plan)
    (line,) = [line for line in capsys.readouterr().err.splitlines() if line.startswith("surfexp:")]
    assert "(ZeroDivisionError: division by zero); results are kept, the same command tries again" in line
    finishing.finish(path, plan)
    assert "surfexp:" not in capsys.readouterr().err and (tmp_path / "mlflow.db").exists()
