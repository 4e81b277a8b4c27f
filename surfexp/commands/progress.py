"""The live view: stages done, running and waiting, and what a long stage says of itself."""

from __future__ import annotations

import subprocess
import time
from collections import Counter
from pathlib import Path

from rich.console import Console, Group
from rich.live import Live
from rich.progress_bar import ProgressBar
from rich.text import Text

from surfexp.workflow import store
from surfexp.workflow.outcome import event_path
from surfexp.workflow.plan import Node

console = Console(stderr=True)


def follow(process: subprocess.Popen[bytes], nodes: list[Node], results: Path) -> None:
    """Show the stages of a running Snakemake process until it ends: live in a terminal, else a line a finished stage."""
    if not console.is_terminal:
        waiting = nodes
        while True:
            running, began = process.poll() is None, time.process_time()
            ended = {node.key for node in waiting if event_path(results, node.kind, node.key).exists()}
            for number, node in enumerate(
                (node for node in waiting if node.key in ended), len(nodes) - len(waiting) + 1
            ):
                console.print(f"[{number}/{len(nodes)}] {node.kind}/{node.plugin}", markup=False, highlight=False)
            waiting = [node for node in waiting if node.key not in ended]
            if not running:
                return
            _pause(0.1, began)
    with Live(console=console, refresh_per_second=5, transient=True) as live:
        while process.poll() is None:
            began = time.process_time()
            live.update(_view(nodes, results))
            _pause(0.2, began)


def _pause(seconds: float, began: float) -> None:
    """Wait until the next look, which takes a tenth of the processor at most however many stages there are."""
    time.sleep(min(max(seconds, 10.0 * (time.process_time() - began)), 2.0))


def _view(nodes: list[Node], results: Path) -> Group:
    done = {node.key for node in nodes if store.is_done(results, node.kind, node.key)}
    failed = {n.key for n in nodes if n.key not in done and event_path(results, n.kind, n.key).exists()}
    lines = []
    for node in nodes:
        try:
            message = event_path(results, node.kind, node.key).with_suffix(".progress").read_text()
            lines.append(Text(f"  {node.kind}/{node.plugin}: {message}"))
        except OSError:
            continue
    waiting = Counter(node.kind for node in nodes if node.key not in done | failed)
    state = (
        f"{len(done)} done, {len(lines)} running, {sum(waiting.values()) - len(lines)} waiting, {len(failed)} failed"
    )
    return Group(ProgressBar(total=len(nodes), completed=len(done) + len(failed)), Text(state), *lines)
