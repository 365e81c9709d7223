"""Drivers of hapticd, one folder per device family."""
