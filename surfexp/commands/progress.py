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
        reported: set[str] = set()
        while True:
            running = process.poll() is None
            for node in nodes:
                if node.key not in reported and event_path(results, node.kind, node.key).exists():
                    reported.add(node.key)
                    console.print(
                        f"[{len(reported)}/{len(nodes)}] {node.kind}/{node.plugin}", markup=False, highlight=False
                    )
            if not running:
                return
            time.sleep(0.1)
    with Live(console=console, refresh_per_second=5, transient=True) as live:
        while process.poll() is None:
            live.update(_view(nodes, results))
            time.sleep(0.2)


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
