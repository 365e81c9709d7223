"""The application: middleware, routes and errors put together over one station."""

from __future__ import annotations

from fastapi import Depends, FastAPI
from prometheus_client import CollectorRegistry, Gauge, ProcessCollector
from starlette.middleware import Middleware

from hapticd.station import Station
from hapticd_api import docs_page, errors, openapi, page_files
from hapticd_api.body import BodyGuard
from hapticd_api.device_metrics import DeviceMetrics
from hapticd_api.gate import Gate
from hapticd_api.idempotency import Idempotency
from hapticd_api.query import refuse_unknown_query
from hapticd_api.release import release
from hapticd_api.request_metrics import RequestMetrics
from hapticd_api.response_headers import ResponseHeaders
from hapticd_api.routers import (
    analysis,
    asyncapi,
    devices,
    estop,
    events,
    experiments,
    faults,
    health,
    interlocks,
    jobs,
    metrics,
    model,
    problems,
    root,
    scene,
    state,
    system,
    twin,
    walls,
)
from hapticd_api.stream import endpoint

_RESOURCES = (
    *(devices, model, state, interlocks, estop, faults, scene, walls, twin, events),
    *(analysis, experiments, jobs),
    *(root, system, asyncapi, health, metrics, problems),
)
_PAGES_AND_STREAMS = (openapi, docs_page, page_files, endpoint)


def create_app(station: Station) -> FastAPI:
    """The HTTP and WebSocket API over `station`, which the caller starts and stops."""
    registry = CollectorRegistry()
    ProcessCollector(registry=registry)
    registry.register(DeviceMetrics(station))
    app = FastAPI(
        title="hapticd",
        version=release(),
        openapi_url=None,  # a route of our own serves it
        middleware=_middleware(station, registry),
    )
    app.state.station = station
    app.state.streams = Gauge("hapticd_stream_clients", "Open WebSockets", registry=registry)
    app.state.registry = registry
    for resource in _RESOURCES:
        app.include_router(resource.router, dependencies=[Depends(refuse_unknown_query)])
    for module in _PAGES_AND_STREAMS:
        app.include_router(module.router)
    errors.install(app)
    return app


def _middleware(station: Station, registry: CollectorRegistry) -> list[Middleware]:
    """Outermost first: all is counted, then who asks is checked, then what is sent, then if it is new."""
    return [
        Middleware(ResponseHeaders),
        Middleware(RequestMetrics, registry=registry),
        Middleware(Gate, hosts=frozenset({station.config.api.host})),
        Middleware(BodyGuard),
        Middleware(Idempotency),
    ]
