"""The file of MLflow's database: made whole or not at all, and set aside where it cannot be used.

MLflow makes its tables by going through all versions that it ever had, which takes seconds and leaves a file that is of
no use when it is interrupted. So they are made once for a user, and a results folder gets a copy.
"""

from __future__ import annotations

import shutil
import sqlite3
import tempfile
from contextlib import closing, suppress
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from urllib.parse import quote

from surfexp.io.replacing import replacing
from surfexp.lab.user_cache import fault, user_cache

SECONDS_TO_WAIT = 30.0


@dataclass(frozen=True)
class Schema:
    """The tables of a database, and the version that MLflow says they have."""

    tables: frozenset[str]
    version: str


def prepare(database: Path) -> str:
    """Make a database without runs where there is none, and in place of one that cannot be used.

    Parameters
    ----------
    database : Path
        Its folder exists.

    Returns
    -------
    str
        What was wrong with the one that stood there and under which name it is kept, in one line; "" if nothing was.

    Raises
    ------
    OSError
        If the folder cannot be written.
    """
    with tempfile.TemporaryDirectory(prefix="surfexp-") as folder:
        empty = _empty_database(Path(folder))
        said = ""
        if database.exists():
            if not (reason := unusable(database, schema(empty))):
                return ""
            kept = _free_name(database)
            database.rename(kept)
            _set_journals_aside(database, kept)
            said = f"{database} {reason}: it is kept as {kept.name}, and runs are recorded in a new one"
        else:
            _set_journals_aside(database, _free_name(database))
        with replacing(database) as temporary:
            shutil.copyfile(empty, temporary)
    return said


def _set_journals_aside(database: Path, kept: Path) -> None:
    """Move what SQLite would play back into the next file of this name: the journal goes with its database."""
    for suffix in ("-journal", "-wal", "-shm"):
        with suppress(FileNotFoundError):
            database.with_name(database.name + suffix).rename(kept.with_name(kept.name + suffix))


def unusable(database: Path, expected: Schema) -> str:
    """Why MLflow cannot work with a database; "" where it can, or where another process is writing to it."""
    try:
        present = schema(database)
        with closing(_opened(database)) as connection:
            (found,) = connection.execute("PRAGMA quick_check(1)").fetchone()
    except sqlite3.Error as error:
        return "" if "locked" in str(error) else f"is no database that can be read ({error})"
    if found != "ok":
        return f"is damaged ({' '.join(found.split())[:80]})"
    if present.version != expected.version:
        return f"is of another version of MLflow ({present.version})" if present.version else "is half made"
    missing = sorted(expected.tables - present.tables)
    return f"is half made (without {missing[0]})" if missing else ""


def _whole(database: Path) -> bool:
    """Whether SQLite can read all of a database."""
    with suppress(sqlite3.Error), closing(_opened(database)) as connection:
        return bool(connection.execute("PRAGMA quick_check(1)").fetchone() == ("ok",))
    return False


def schema(database: Path) -> Schema:
    """Return the tables and the version of a database; sqlite3.Error if it is none."""
    with closing(_opened(database)) as connection:
        tables = frozenset(
            name for (name,) in connection.execute("SELECT name FROM sqlite_master WHERE type = 'table'")
        )
        versions = connection.execute("SELECT version_num FROM alembic_version").fetchall() if _STATE in tables else []
    return Schema(tables, ", ".join(sorted(str(row[0]) for row in versions)))


_STATE = "alembic_version"


def _opened(database: Path) -> sqlite3.Connection:
    """Open a database that exists; writable, for SQLite may have to undo what an interrupted process left."""
    return sqlite3.connect(f"file:{quote(str(database))}?mode=rw", uri=True, timeout=SECONDS_TO_WAIT)


def _empty_database(folder: Path) -> Path:
    """Return a database without runs: the user's own, made where it is missing; in `folder` where none can be kept."""
    kept = user_cache("mlflow")
    keeps = not fault(kept)
    file = kept / f"{version('mlflow')}.db"
    if keeps and file.exists() and _whole(file):
        return file
    made = folder / "mlflow.db"
    _make(made)
    if not keeps:
        return made
    with replacing(file) as temporary:
        shutil.copyfile(made, temporary)
    return file


def _make(database: Path) -> None:
    """Let MLflow make its tables; the experiment "Default", which names the folder, is made anew where it is used."""
    try:
        from mlflow.store.tracking.sqlalchemy_store import SqlAlchemyStore

        store = SqlAlchemyStore(f"sqlite:///{database}", str(database.parent))
        store.engine.dispose()
    except (ImportError, AttributeError):  # of a version with other insides; its client makes them when it is asked
        from mlflow.tracking import MlflowClient

        MlflowClient(f"sqlite:///{database}").search_experiments()
    with closing(sqlite3.connect(database)) as connection:
        connection.execute("DELETE FROM experiments")
        connection.commit()


def _free_name(database: Path) -> Path:
    names = (database.with_name(f"{database.name}.set-aside-{number}") for number in range(1, 10**6))
    return next(name for name in names if not name.exists())
