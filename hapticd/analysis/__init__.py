"""Mathematics of the devices for analysis, in numpy over the core's bindings: nothing here runs in a tick."""
