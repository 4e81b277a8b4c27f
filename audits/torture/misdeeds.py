"""Plugin files that misbehave when they are imported, and plugins that misbehave when they run."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path

from audits.torture.case import HUNG, REFUSED, RIGHT, WRONG, Ended, clear
from audits.torture.laboratory import run, working_folder
from surfexp.lab.registry import contained
from surfexp.lab.registry.contained import contained_description

REGISTER = "from surfexp.lab.registry.registry import register\n"
IMPORT: dict[str, str | bytes] = {
    "exit 0": "import os\nos._exit(0)",
    "exit 3": "import os\nos._exit(3)",
    "sys.exit": "import sys\nsys.exit(0)",
    "SystemExit with text": "raise SystemExit('bye')",
    "KeyboardInterrupt": "raise KeyboardInterrupt",
    "GeneratorExit": "raise GeneratorExit",
    "an exception without text": "raise Exception",
    "an exception of 10,000 characters": "raise ValueError('x' * 10_000)",
    "an exception of many lines": "raise ValueError('\\n' * 50 + 'x')",
    "an exception that cannot be shown": "class E(Exception):\n    def __str__(self):\n        raise E\nraise E",
    "recursion": "def f():\n    f()\nf()",
    "division": "1 / 0",
    "no Python": "def f(:",
    "bytes of Latin 1": b"# \xe9\nx = 1",
    "null bytes": b"x = 1\x00",
    "tabs and spaces": "if True:\n\tx = 1\n        y = 2",
    "a missing package": "import no_such_package_at_all",
    "a missing name": "from surfexp.contract.arrays import no_such_name",
    "a circular import": "from surfexp.plugins.surface import icosphere as x\nimport itself",
    "SIGKILL": "import os, signal\nos.kill(os.getpid(), signal.SIGKILL)",
    "SIGTERM": "import os, signal\nos.kill(os.getpid(), signal.SIGTERM)",
    "SIGINT": "import os, signal\nos.kill(os.getpid(), signal.SIGINT)",
    "SIGSTOP": "import os, signal\nos.kill(os.getpid(), signal.SIGSTOP)",
    "abort": "import os\nos.abort()",
    "a segmentation fault": "import ctypes\nctypes.string_at(0)",
    "memory": "x = bytearray(1 << 40)",
    "a wait": "import threading\nthreading.Event().wait()",
    "a loop": "while True:\n    pass",
    "closed files": "import os\nos.closerange(0, 4096)",
    "closed files and a loop": "import os\nos.closerange(0, 4096)\nwhile True:\n    pass",
    "no kind": REGISTER + "@register('surfaces', 'x')\ndef x():\n    '''X.'''",
    "a number for a name": REGISTER + "@register('surface', 3)\ndef x():\n    '''X.'''",
    "an option without a type": REGISTER + "@register('surface', 'x1')\ndef x(size=1.0):\n    '''X.'''",
    "no annotations": REGISTER + "@register('surface', 'x2')\ndef x(surface):\n    '''X.'''",
    "no docstring": REGISTER + "@register('surface', 'x3')\ndef x():\n    pass",
    "an unknown input": REGISTER
    + "@register('surface', 'x4')\ndef x(a: 'Nothing'):\n    '''X.'''",
    "output of a megabyte": "print('x' * 10**6)",
    "output like an answer": "import sys\nsys.stdout.write('{\"refused\": \"everything\"}\\n')\nsys.stdout.flush()",
    "a thread": "import threading, time\nthreading.Thread(target=time.sleep, args=(60,)).start()",
    "a handler at the end": "import atexit, time\natexit.register(time.sleep, 60)",
    "a process": "import subprocess\nsubprocess.Popen(['sleep', '60'])",
    "no signals": "import signal\nsignal.signal(signal.SIGTERM, signal.SIG_IGN)",
    "another working folder": "import os\nos.chdir('/')",
    "a changed environment": "import os\nos.environ.clear()",
    "a warning": "import warnings\nwarnings.warn('x' * 5000)",
    "no recursion left": "import sys\nsys.setrecursionlimit(50)",
}  # fmt: skip
RUN = {
    "an exception": "raise ValueError('no')",
    "an exception without text": "raise ValueError",
    "exit 0": "import os; os._exit(0)",
    "sys.exit": "import sys; sys.exit(0)",
    "SIGKILL": "import os, signal; os.kill(os.getpid(), signal.SIGKILL)",
    "a segmentation fault": "import ctypes; ctypes.string_at(0)",
    "closed files": "import os; os.closerange(3, 4096); raise ValueError('no')",
    "NaN": "return replace(icosphere(1), mesh=TriangleMesh(np.full((42, 3), np.nan), icosphere(1).mesh.faces))",
    "objects": "return replace(icosphere(1), scalars={'x': np.array([object()] * 42)})",
    "another length": "return replace(icosphere(1), scalars={'x': np.zeros(7)})",
    "nothing": "return None",
    "a number": "return 3",
    "an infinite metric": "return replace(icosphere(1), metrics={'area': float('inf')})",
    "a metric of text": "return replace(icosphere(1), metrics={'area': 'large'})",
    "output of a megabyte": "print('x' * 10**6); return icosphere(1)",
    "markup in notes": "return replace(icosphere(1), notes=('[/b]<script>',))",
}
HEAD = '''"""A plugin."""

from dataclasses import replace

import numpy as np

from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.lab.registry.registry import register


@register("surface", "{name}")
def plugin() -> Surface:
    """A surface."""
    {body}
'''
SECONDS = 20.0
TRIED = """# @package _global_
experiment: tried
target: surface
title: A plugin on trial
figures: []
grid: {surface: [{name: case}, {name: icosphere, levels: 1}]}
"""


def misdeeds(every: int = 1) -> Iterator[Ended]:
    """Import every file at once beside a good one; then run each plugin, or one of so many."""
    yield from _imports()
    for name, body in list(RUN.items())[::every]:
        yield _run(name, body)


def _imports() -> Iterator[Ended]:
    with working_folder() as folder:
        place = folder / "plugins" / "surface"
        place.mkdir(parents=True)
        (place / "good.py").write_text(HEAD.format(name="good", body="return icosphere(1)"))
        for number, source in enumerate(IMPORT.values()):
            content = source if isinstance(source, bytes) else source.encode()
            (place / f"case_{number}.py").write_bytes(content + b"\n")
        contained.SECONDS = SECONDS
        found = contained_description(folder)
        known = {item["name"] for item in found["plugins"]}
        said = {Path(file).stem: text for file, text in found["broken"].items()}
        for number, name in enumerate(IMPORT):
            text = said.get(f"case_{number}")
            if not {"good", "icosphere"} <= known:
                yield Ended("plugin, imported", name, WRONG, "the others are not described any more")
            elif text is None:
                yield Ended("plugin, imported", name, RIGHT, "")
            else:
                wrong = clear(text)
                yield Ended("plugin, imported", name, WRONG if wrong else REFUSED, wrong or text)


def _run(name: str, body: str) -> Ended:
    with working_folder() as folder:
        place = folder / "plugins" / "surface"
        place.mkdir(parents=True)
        (place / "case.py").write_text(HEAD.format(name="case", body=body))
        (folder / "conf" / "experiment" / "tried.yaml").write_text(TRIED)
        done = run(folder, "run", "experiment=tried", seconds=120.0)
        shutil.rmtree(folder / "results" / "cache", ignore_errors=True)
        if done.code is None:
            return Ended("plugin, run", name, HUNG, "the run did not end")
        lines = [line for line in done.error.splitlines() if "surface/case" in line]
        if "Traceback" in done.error:
            return Ended("plugin, run", name, WRONG, done.error[-300:])
        if done.code == 0:
            return Ended("plugin, run", name, RIGHT, "")
        if done.code != 1 or not lines:
            return Ended("plugin, run", name, WRONG, f"exit {done.code}: {done.error[-300:]}")
        wrong = clear(lines[0])
        return Ended("plugin, run", name, WRONG if wrong else REFUSED, wrong or lines[0])
