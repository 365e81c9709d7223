"""cyclictest of Debian's rt-tests, as the yardstick of the same run."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager

from tests.bench.durations import Durations

HISTOGRAM_US = 20_000
MISSING = "cyclictest is missing: run 'apt install rt-tests' to see the yardstick."


class Cyclictest:
    """One run beside whatever is measured."""

    def __init__(self, rate_hz: int, seconds: int, priority: int) -> None:
        self._command = [
            *("cyclictest", "--mlockall", "--quiet", "--threads=1"),
            *(f"--priority={priority}", f"--interval={1_000_000 // rate_hz}"),
            *(f"--duration={seconds}", f"--histogram={HISTOGRAM_US}"),
        ]
        self.durations: Durations | None = None
        self.why = MISSING

    @contextmanager
    def running(self) -> Iterator[None]:
        """Runs while the block runs; the block must last at least as long."""
        if shutil.which(self._command[0]) is None:
            yield
            return
        process = subprocess.Popen(self._command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        try:
            yield
        finally:
            text, _ = process.communicate(timeout=30)
        if process.returncode == 0:
            self.durations = parse(text)
        else:
            self.why = f"cyclictest: {text.strip().splitlines()[-1]}"

    def row(self) -> str:
        """Its line of the page, or why there is none."""
        if self.durations is None:
            return f"  {self.why}"
        return self.durations.row("cyclictest, same priority, same run")


def parse(text: str) -> Durations:
    """The histogram cyclictest prints: a line a microsecond, then comments with maxima and overflows."""
    counts = [
        int(line.split()[1]) for line in text.splitlines() if line[:1].isdigit() and len(line.split()) == 2
    ]
    maximum = next(line for line in text.splitlines() if line.startswith("# Max Latencies:"))
    edges_ns = tuple((us + 1) * 1e3 for us in range(len(counts)))
    return Durations(edges_ns, tuple(counts), int(maximum.split(":")[1]) * 1e3)
