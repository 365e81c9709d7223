"""A front that enables the device and then sends scenes as fast as it can, until it is killed.

``python -m tests.servo.dying_front REGION`` prints one line once the device is enabled.
"""

from __future__ import annotations

import itertools
import json
import sys

from hapticd import _core
from hapticd.flat_wall import rigid_plane
from tests.servo.rig import enable

WALLS = [rigid_plane([0.0, 0.0, 1.0], -0.5, key=key) for key in range(256)]


def main(region: str) -> None:
    front = _core.Front(region)
    enable(front)
    print("enabled", flush=True)
    for revision in itertools.count(1):
        scene = {
            "revision": revision,
            "fade_s": 0.01,
            "mapping": "transpose",
            "stiffness": "pose",
            "allocation": "motor_only",
            "walls": WALLS,
        }
        front.heartbeat()
        try:
            front.send(json.dumps({"type": "scene", "scene": scene}))
        except BlockingIOError:
            continue


if __name__ == "__main__":
    main(sys.argv[1])
