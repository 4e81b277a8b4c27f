"""The console of tables and live views: names and words of others steer nothing."""

from __future__ import annotations

from collections.abc import Iterable

from rich import console
from rich.segment import Segment

from surfexp.commands.terminal import plain_text


class Console(console.Console):
    """Rich's console, whose text has its control codes written out; its own codes and styles pass."""

    def render(
        self, renderable: console.RenderableType, options: console.ConsoleOptions | None = None
    ) -> Iterable[Segment]:
        """See rich."""
        for segment in super().render(renderable, options):
            yield segment if segment.control else segment._replace(text=plain_text(segment.text))
