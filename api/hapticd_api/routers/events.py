"""What happened: the persistent event log."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Query

from hapticd.events import Event
from hapticd.snapshot import Report
from hapticd_api.dependencies import StationDep

router = APIRouter(prefix="/api/v1/events", tags=["events"])

PAGE_DEFAULT = 100
PAGE_MAX = 1000


class EventPage(Report):
    """Some events, oldest first. Ask again with `after = last_id` for what follows."""

    events: list[Event]
    last_id: int
    oldest_kept_id: int | None


@router.get("", operation_id="list_events", summary="Events")
async def list_events(
    station: StationDep,
    after: Annotated[int, Query(ge=0, description="Only events with a greater id")] = 0,
    limit: Annotated[int, Query(ge=1, le=PAGE_MAX)] = PAGE_DEFAULT,
) -> EventPage:
    """Events after a given one, oldest first. Ids rise also across restarts: a watcher can resume."""
    events = station.events.after(after, limit)
    last_id = events[-1].id if events else after
    return EventPage(events=events, last_id=last_id, oldest_kept_id=station.events.oldest_id)
