"""The live view: stages done, running and waiting, what a long stage says of itself, and how long the rest may take."""

from __future__ import annotations

import subprocess
import time
from collections import defaultdict
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path
from statistics import fmean

from rich.console import Group
from rich.live import Live
from rich.padding import Padding
from rich.progress_bar import ProgressBar
from rich.text import Text

from surfexp.commands.console import Console
from surfexp.commands.stage_words import stage_words
from surfexp.lab.plan.outcome import event_path, read_event
from surfexp.lab.plan.plan import Node

console = Console(stderr=True)
# running stages that the live view shows
MOST_LINES = 12
# after which a stage that says nothing is worth a word
SILENCE = 600.0


class Progress:
    """What is known of the stages of a run while it goes on.

    Parameters
    ----------
    nodes : dict of str to Node
        All stages of the plan, among which options differ.
    shown : list of Node
        The stages of this run.
    results : path
    """

    def __init__(self, nodes: Mapping[str, Node], shown: list[Node], results: Path) -> None:
        self.shown, self.results = shown, results
        self.words = stage_words(nodes, shown)
        self.began = time.monotonic()
        self.started: dict[str, float] = {}
        self.waiting = {node.key: node for node in shown}
        self.failed = 0
        self.warned: set[str] = set()
        self.seconds: dict[str, list[float]] = defaultdict(list)

    def ended(self) -> list[str]:
        """Return a line for each stage that has ended since the last call: its number, name, words and seconds."""
        lines = []
        for node in [node for node in self.waiting.values() if event_path(self.results, node.kind, node.key).exists()]:
            event = read_event(self.results, node.kind, node.key)
            del self.waiting[node.key]
            number = len(self.shown) - len(self.waiting)
            spent = event.get("seconds")
            if isinstance(spent, int | float):
                self.seconds[f"{node.kind}/{node.plugin}"].append(float(spent))
            self.failed += bool(event.get("failure"))
            end = "failed" if event.get("failure") else f"{spent:.1f} s" if isinstance(spent, int | float) else ""
            lines.append("  ".join(filter(None, [f"[{number}/{len(self.shown)}] {self.named(node)}", end])))
        return lines

    def named(self, node: Node) -> str:
        """Return kind, plugin and what tells the stage from others of its plugin."""
        return "  ".join(filter(None, [f"{node.kind}/{node.plugin}", self.words.get(node.key, "")]))

    def running(self) -> list[str]:
        """Return a line for each stage at work: its name, how long it has run, and what it says of itself."""
        lines = []
        now = time.monotonic()
        for node in self.waiting.values():
            try:
                said = event_path(self.results, node.kind, node.key).with_suffix(".progress").read_text()
            except OSError:
                continue
            spent = now - self.started.setdefault(node.key, now)
            parts = [self.named(node), clock(spent), said.removeprefix("started")]
            lines.append("  ".join(filter(None, parts)))
        return lines

    def silent(self) -> list[str]:
        """Return a warning for each stage that has said nothing for ten minutes, once."""
        lines = []
        for node in self.waiting.values():
            place = event_path(self.results, node.kind, node.key).with_suffix(".progress")
            with suppress(OSError):
                if node.key not in self.warned and time.time() - place.stat().st_mtime > SILENCE:
                    self.warned.add(node.key)
                    lines.append(
                        f"surfexp: warning: {self.named(node)}: no progress for {SILENCE / 60:.0f} minutes; Ctrl-C ends "
                        "the run, the same command continues it, resources.time=SECONDS limits a stage"
                    )
        return lines

    def remaining(self) -> float | None:
        """Return how long the rest may take, in seconds, at the pace so far; None before it can be said.

        Stages of a plugin take what those before took on average, others what all took; as many go at once as until now.
        """
        known = [spent for several in self.seconds.values() for spent in several]
        elapsed = time.monotonic() - self.began
        if len(known) < 3 or not sum(known) or elapsed < 2.0:
            return None
        mean = fmean(known)
        plugins = [f"{node.kind}/{node.plugin}" for node in self.waiting.values()]
        work = sum(fmean(self.seconds[plugin]) if plugin in self.seconds else mean for plugin in plugins)
        return work * elapsed / sum(known)

    def state(self) -> str:
        """Return one line: how many stages are done and failed, how long it took, how long it may take."""
        done = len(self.shown) - len(self.waiting) - self.failed
        left = self.remaining()
        parts = [f"{done} of {len(self.shown)} done"] + ([f"{self.failed} failed"] if self.failed else [])
        parts.append(clock(time.monotonic() - self.began))
        return ", ".join(parts + ([f"about {clock(left)} more"] if left is not None else []))


def follow(
    process: subprocess.Popen[bytes],
    nodes: Mapping[str, Node],
    shown: list[Node],
    results: Path,
    notices: Callable[[], list[str]] = list,
) -> None:
    """Show the stages of a running Snakemake process until it ends: live in a terminal, else a line a finished stage.

    `notices` gives lines to print besides; it is asked again and again.
    """
    progress = Progress(nodes, shown, results)
    if console.is_terminal:
        with Live(console=console, refresh_per_second=5, transient=True) as live:
            while process.poll() is None:
                began = time.process_time()
                progress.ended()
                for line in [*progress.silent(), *notices()]:
                    live.console.print(line, markup=False, highlight=False, soft_wrap=True)
                live.update(_view(progress))
                _pause(0.2, began)
        return
    running = True
    while running:
        running, began = process.poll() is None, time.process_time()
        for line in [*progress.ended(), *progress.silent(), *notices()]:
            console.print(line, markup=False, highlight=False, soft_wrap=True)
        if running:
            _pause(0.1, began)


def clock(seconds: float) -> str:
    """Return a duration as minutes and seconds, or hours and minutes."""
    whole = round(seconds)
    return f"{whole // 60}:{whole % 60:02d}" if whole < 3600 else f"{whole // 3600} h {whole % 3600 // 60:02d} min"


def _pause(seconds: float, began: float) -> None:
    """Wait until the next look, which takes a tenth of the processor at most however many stages there are."""
    time.sleep(min(max(seconds, 10.0 * (time.process_time() - began)), 2.0))


def _view(progress: Progress) -> Group:
    lines = progress.running()
    more = [f"and {len(lines) - MOST_LINES} more"] if len(lines) > MOST_LINES else []
    ended = len(progress.shown) - len(progress.waiting)
    # which ends its line, as the bar alone does not
    bar = Padding(ProgressBar(total=len(progress.shown), completed=ended), 0)
    shown = [Text(f"  {line}", no_wrap=True, overflow="ellipsis") for line in [*lines[:MOST_LINES], *more]]
    return Group(bar, Text(progress.state()), *shown)
