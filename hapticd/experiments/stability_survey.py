"""Every point of a stability map on the twin, a row at a time, resumable."""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hapticd import _core
from hapticd.analysis.settling import Contact, bound_m, push
from hapticd.experiments.run import Run
from hapticd.experiments.stability_sheet import Sheet

FORMAT = 1
"""Goes up when what is kept changes."""

ROWS_AT_ONCE = 4
"""Rows between two saves: some seconds of work."""

SETTLED, CYCLING, UNSTABLE = 0, 1, 2
"""At rest in the wall; moving in it without leaving; leaving it, or stopped by a fault."""


@dataclass(frozen=True)
class Survey:
    """What became of every point; arrays are (rows, columns). ``motion_m`` is peak to peak at the end."""

    sheet: Sheet
    bound_m: float
    motion_m: NDArray[np.float64]
    outcome: NDArray[np.int64]

    def settled(self) -> NDArray[np.bool_]:
        """Where the tip came to rest."""
        return np.asarray(self.outcome == SETTLED)


@dataclass(frozen=True)
class Trial:
    """How every point is tried. ``share`` of the device's largest force is the push."""

    rate_hz: float
    share: float
    passivity: bool


def surveyed(run: Run, sheet: Sheet, trial: Trial, until: float) -> Survey:
    """Pushes into the wall at every point of the sheet.

    Rows that an earlier run with the same parameters finished are read from ``run.state_dir``.
    """
    columns, rows = len(sheet.across), len(sheet.up)
    rest_m = bound_m(sheet.loop_at(*sheet.points()[0]))
    kept = _Kept(run.state_dir, _key(run, sheet, trial))
    done = kept.load()

    def one(point: tuple[float, float]) -> Contact:
        return push(
            sheet.model_at(*point),
            trial.rate_hz,
            run.seed,
            share=trial.share,
            law=sheet.law_at(*point),
            passivity=trial.passivity,
        )

    begin = len(done)
    for first in range(begin, rows, ROWS_AT_ONCE):
        last = min(first + ROWS_AT_ONCE, rows)
        points = sheet.points()[first * columns : last * columns]
        found = run.map(one, points, doing="pushing", until=until * last / rows)
        for row in range(last - first):
            contacts = found[row * columns : (row + 1) * columns]
            done.append([[c.motion_m, float(_outcome(c, rest_m))] for c in contacts])
        kept.save(done)
    kept.forget()
    table = np.array(done)
    return Survey(sheet, rest_m, table[..., 0], table[..., 1].astype(np.int64))


def _outcome(contact: Contact, rest_m: float) -> int:
    if contact.settled(rest_m):
        return SETTLED
    return CYCLING if contact.touching and not contact.faulty else UNSTABLE


def _key(run: Run, sheet: Sheet, trial: Trial) -> str:
    """Name of what is kept: changes with anything that could change a point."""
    corner = sheet.model_at(*sheet.points()[0])
    facts = (
        FORMAT,
        _core.build_info()["version"],
        (corner.device_json, corner.twin_json),
        (sheet.across.tolist(), sheet.up.tolist(), run.seed),
        (trial, sorted(sheet.law_at(*sheet.points()[0]).items())),
    )
    return hashlib.blake2b(repr(facts).encode(), digest_size=16).hexdigest()


class _Kept:
    """Finished rows on disk, written whole or not at all."""

    def __init__(self, directory: Path | None, key: str) -> None:
        self._file = None if directory is None else directory / f"stability-map-{key}.json"

    def load(self) -> list[list[list[float]]]:
        if self._file is None or not self._file.exists():
            return []
        try:
            rows: list[list[list[float]]] = json.loads(self._file.read_text(encoding="utf-8"))
        except ValueError:
            return []  # cut short by a crash of the machine: begun again
        return rows

    def save(self, rows: list[list[list[float]]]) -> None:
        if self._file is None:
            return
        self._file.parent.mkdir(parents=True, exist_ok=True)
        part = self._file.with_suffix(".part")
        part.write_text(json.dumps(rows), encoding="utf-8")
        part.replace(self._file)

    def forget(self) -> None:
        """A map that is whole need not be resumed."""
        if self._file is not None:
            self._file.unlink(missing_ok=True)
