"""All plugins described by another process: whatever a file does when it is imported, the rest of the tool works.

`python -m surfexp.lab.registry.contained FOLDER FAULTS` writes lines of JSON: the name of each file before it is loaded,
and at the end the description. What is found out is remembered by the state of the files, so this runs when one has
changed.
"""

from __future__ import annotations

import contextlib
import json
import os
import resource
import select
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

from surfexp.lab.errors import UserError
from surfexp.lab.memory_limit import LEAST_FOR_NUMERICS, require_memory

# for one file, on a busy machine; an import of torch takes ten
SECONDS = 120.0
MEMORY = 8 * 2**30


def contained_description(working_folder: Path) -> dict[str, Any]:
    """Return the description of all plugins; a file that ends its process or does not end is among the broken ones.

    Raises
    ------
    UserError
        If two plugins have one name, or no file can be loaded at all.
    """
    faults: dict[str, str] = {}
    while True:
        answer, file, reason = _ask(working_folder, faults)
        if answer is not None:
            return answer | {"contained": list(faults)}
        if not file or file in faults:
            raise UserError(f"plugins cannot be described: the process that loads them {reason}")
        faults[file] = f"plugin file {file}: when it is imported, it {reason}; it is left alone until it changes"


def _ask(working_folder: Path, faults: dict[str, str]) -> tuple[dict[str, Any] | None, str, str]:
    """Return the description, or the file that was being loaded and what became of the process."""
    require_memory(LEAST_FOR_NUMERICS)
    command = [sys.executable, "-P", "-m", "surfexp.lab.registry.contained", str(working_folder), json.dumps(faults)]
    process = subprocess.Popen(  # noqa: S603, this interpreter, this package, no shell
        command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, start_new_session=True
    )
    assert process.stdout is not None  # noqa: S101, narrows a type
    file, waiting, deadline = "", b"", time.monotonic() + SECONDS
    try:
        while select.select([process.stdout], [], [], max(0.0, deadline - time.monotonic()))[0]:
            if not (received := os.read(process.stdout.fileno(), 2**20)):
                with contextlib.suppress(subprocess.TimeoutExpired):
                    return None, file, _end(process.wait(max(0.0, deadline - time.monotonic())))
                break
            *lines, waiting = (waiting + received).split(b"\n")
            for message in map(json.loads, lines):
                if "refused" in message:
                    raise UserError(message["refused"])
                if "description" in message:
                    return message["description"], "", ""
                file, deadline = message["file"], time.monotonic() + SECONDS
        return None, file, f"takes longer than {SECONDS:g} s"
    finally:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.stdout.close()
        process.wait()


def _end(code: int) -> str:
    if code >= 0:
        return f"ends the process with exit status {code}"
    return f"is ended by signal {-code} ({signal.Signals(-code).name})"


def main(working_folder: Path, faults: dict[str, str]) -> None:
    """Answer on what was standard output; what plugins print goes nowhere."""
    answers, nowhere = os.dup(1), os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    os.dup2(nowhere, 2)
    resource.setrlimit(resource.RLIMIT_DATA, (MEMORY, MEMORY))

    def answer(**message: Any) -> None:
        text = json.dumps(message, default=str).encode() + b"\n"
        while text:
            text = text[os.write(answers, text) :]

    from surfexp.lab.registry.description import describe_all
    from surfexp.lab.registry.folders import sources
    from surfexp.lab.registry.imported import imported_from_elsewhere

    try:
        found = describe_all(working_folder, faults, lambda file: answer(file=file))
        answer(description=found | {"imported": imported_from_elsewhere(sources(working_folder))})
    except UserError as error:
        answer(refused=str(error))
    os._exit(0)  # threads and exit handlers that plugins have started do not matter


if __name__ == "__main__":
    main(Path(sys.argv[1]), json.loads(sys.argv[2]))
