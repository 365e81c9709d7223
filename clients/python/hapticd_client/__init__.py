"""Python client of hapticd."""
