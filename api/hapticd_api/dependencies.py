"""What routes ask for: the station, one of its devices, the headers of a conditional request."""

from __future__ import annotations

from typing import Annotated

from fastapi import Depends, Header, Path, Query
from starlette.requests import HTTPConnection

from hapticd.device import Device
from hapticd.edit_terms import Terms
from hapticd.station import Station


def station_of(connection: HTTPConnection) -> Station:
    """The station this application serves."""
    station: Station = connection.app.state.station
    return station


StationDep = Annotated[Station, Depends(station_of)]


def _device(
    device_id: Annotated[str, Path(description="Id of a configured device", examples=["phantom"])],
    station: StationDep,
) -> Device:
    return station.device(device_id)


DeviceDep = Annotated[Device, Depends(_device)]

WallId = Annotated[str, Path(description="Id of a wall in the scene", examples=["floor"])]
IfMatch = Annotated[
    str | None,
    Header(description="Change only if the scene still has this ETag", examples=['"7"']),
]
IfNoneMatch = Annotated[
    str | None,
    Header(description="Answer 304 if the scene still has this ETag; on a PUT, `*` makes a new wall only"),
]
DryRun = Annotated[bool, Query(description="Validate and predict, change nothing")]
Force = Annotated[
    bool, Query(description="Let walls in over their stability budget; passivity then bounds them")
]


def _terms(if_match: IfMatch = None, dry_run: DryRun = False, force: Force = False) -> Terms:
    return Terms(if_match=if_match, dry_run=dry_run, force=force)


EditTerms = Annotated[Terms, Depends(_terms)]
