"""hapticd: the service that owns a haptic device."""
