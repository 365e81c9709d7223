"""How a stream learns that the daemon is stopping: from the last event, after every force has faded out."""

from __future__ import annotations

from hapticd.events import EventLog
from hapticd_api.stream.close import CloseCode
from hapticd_api.stream.connection import Closing

STOPPED = "daemon.stopped"


async def until_stopped(events: EventLog) -> None:
    """Waits for the last event. Raises `Closing` (1001)."""
    with events.subscribe() as feed:
        while (event := await feed.next()) is not None:
            if event.kind == STOPPED:
                raise Closing(CloseCode.SHUTDOWN)
