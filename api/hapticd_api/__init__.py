"""HTTP and WebSocket API of hapticd."""
