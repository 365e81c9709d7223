"""Numpy reference of the equations, written from the papers without a look at the core."""
