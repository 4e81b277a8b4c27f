"""What stages have imported and compiled, loaded by the process that forks them: later stages have it from birth.

A stage tells names, and nothing else: compiled code is read from the checked files of `numba_cache`, and never compiled
here, where a stage would wait for it.
"""

from __future__ import annotations

import contextlib
import gc
import importlib
import json
import socket
import sys
from collections.abc import Iterable, Iterator
from typing import Any

from numba.core.caching import FunctionCache
from numba.core.compiler_lock import global_compiler_lock
from numba.core.dispatcher import Dispatcher
from numba.core.registry import cpu_target
from numba.core.sigutils import normalize_signature

from surfexp.lab.registry.folders import STUDIES

LONGEST = 1 << 17
# what starts no thread when it is imported: a process that forks has one
PACKAGES = frozenset({"surfexp", STUDIES, "numpy", "scipy", "matplotlib", "PIL"})


class Recall:
    """What stages say, a message each that arrives whole or not at all, and what of it this process has loaded."""

    def __init__(self) -> None:
        self.here, self.there = socket.socketpair(socket.AF_UNIX, socket.SOCK_DGRAM)
        self.here.setblocking(False)
        self.there.setblocking(False)
        cpu_target.target_context.refresh()  # a third of a second, which each stage would take by itself
        self.modules: set[str] = set()
        self.dispatchers: list[Any] = []  # a stage that looked through all modules would copy them
        self.known: set[tuple[str, ...]] = set()
        self._settle()

    def tell(self) -> None:
        """In a stage: name what it has loaded and this process had not."""
        modules = [name for name in sys.modules if name not in self.modules]
        names: list[tuple[str, ...]] = [(name,) for name in modules]
        names += [name for name in _names([*self.dispatchers, *_dispatchers(modules)]) if name not in self.known]
        if names:
            with contextlib.suppress(OSError):  # what is not told is loaded again by the next stage
                self.there.send(json.dumps(names).encode())

    def learn(self) -> None:
        """Load what stages have named, where it is in the files."""
        while True:
            try:
                names = [tuple(map(str, name)) for name in json.loads(self.here.recv(LONGEST))]
            except BlockingIOError:
                return
            except (TypeError, ValueError):  # a plugin can write there too
                continue
            for name in names:
                if name not in self.known:
                    self.known.add(name)
                    with contextlib.suppress(Exception):  # what cannot be loaded here, stages load or compile again
                        _load(*name)
            self._settle()

    def _settle(self) -> None:
        new = [name for name in sys.modules if name not in self.modules]
        self.modules.update(new)
        self.dispatchers.extend(_dispatchers(new))
        self.known.update(_names(self.dispatchers))
        gc.collect()
        gc.freeze()  # pages that no collection touches stay shared


def _dispatchers(modules: Iterable[str]) -> Iterator[Any]:
    """The functions that are compiled on demand and stand in one of these modules by their own names."""
    for name in modules:
        for value in list(getattr(sys.modules[name], "__dict__", {}).values()):
            # by type: isinstance asks the value for its class too, and an object of a C library may raise at that
            if issubclass(type(value), Dispatcher) and value.py_func.__module__ == name:
                yield value


def _names(dispatchers: Iterable[Any]) -> Iterator[tuple[str, str, str]]:
    """Module, function and signature of all code that is loaded."""
    for dispatcher in dispatchers:
        for signature in dispatcher.overloads:
            yield dispatcher.py_func.__module__, dispatcher.py_func.__qualname__, str(signature)


def _load(module: str, function: str = "", signature: str = "") -> None:
    """Import a module, or load a function of one for one signature from its file as numba does before it compiles."""
    if not function:
        if module.partition(".")[0] in PACKAGES:
            importlib.import_module(module)
        return
    dispatcher: Any = getattr(sys.modules.get(module), function, None)
    cache = getattr(dispatcher, "_cache", None)
    if not isinstance(cache, FunctionCache):
        return
    with global_compiler_lock:
        for known in cache._cache_file._load_index():
            arguments = normalize_signature(known[0])[0]
            if str(arguments) == signature and tuple(arguments) not in dispatcher.overloads:
                code = cache.load_overload(known[0], dispatcher.targetctx)
                if code is not None:
                    dispatcher.targetctx.insert_user_function(code.entry_point, code.fndesc, [code.library])
                    dispatcher.add_overload(code)
