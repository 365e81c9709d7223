"""A progress bar on standard error."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.markup import escape
from rich.progress import BarColumn, TaskProgressColumn, TextColumn, TimeElapsedColumn
from rich.progress import Progress as Bars

from hapticd.experiments.progress import Report


@contextmanager
def progress_bar(console: Console, title: str) -> Iterator[Report]:
    """What to tell the progress to. Without a terminal nothing is shown."""
    columns = (
        TextColumn("{task.fields[title]}"),
        BarColumn(),
        TaskProgressColumn(),
        TimeElapsedColumn(),
        TextColumn("[dim]{task.description}[/]"),
    )
    with Bars(*columns, console=console, transient=True, disable=not console.is_terminal) as bars:
        task = bars.add_task("", total=1.0, title=title)
        yield lambda fraction, doing: bars.update(task, completed=fraction, description=escape(doing))
