"""``make bench``: one page of figures, the same every time."""

from __future__ import annotations

import argparse
import os
import platform
import subprocess

from tests.bench import loaded_loop, serial_loop

CORE = "hapticd/core/Cargo.toml"
EXAMPLES = ("hapticd-control:tick_bench", "hapticd-twin:twin_speed")


def main() -> None:
    """Prints the page section by section, as the figures come in."""
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--seconds", type=int, default=60, help="length of each loaded run")
    seconds = arguments.parse_args().seconds
    print(
        f"{platform.platform()}, {os.cpu_count()} processors, Python {platform.python_version()}\n",
        flush=True,
    )
    for example in EXAMPLES:
        print(_example(*example.split(":")), flush=True)
    for rate_hz in (1000, 4000):
        print(loaded_loop.measure(rate_hz, seconds) + "\n", flush=True)
    print(serial_loop.measure(seconds), flush=True)


def _example(package: str, name: str) -> str:
    """What an example of the Rust core prints."""
    command = ["cargo", "run", "--quiet", "--release", "--locked", "--manifest-path", CORE]
    done = subprocess.run(
        [*command, "--package", package, "--example", name], check=True, capture_output=True, text=True
    )
    return done.stdout


if __name__ == "__main__":
    main()
