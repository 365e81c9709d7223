"""HTTP and WebSocket API of hapticd."""

from hapticd_api.app import create_app

__all__ = ["create_app"]
