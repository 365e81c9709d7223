"""Tables of simulated-stable stiffness: made in the background, kept on disk."""

from __future__ import annotations

import hashlib
import json
import logging
import queue
import threading
from collections.abc import Callable
from dataclasses import asdict
from functools import partial
from pathlib import Path

from hapticd import _core
from hapticd.analysis.settling_child import settling_table_apart
from hapticd.analysis.settling_table import Abandoned, SettlingTable, settling_table
from hapticd.model import Model

FORMAT = 2
"""Goes up when the simulation changes, so that older tables are made again."""

MOST_DUE = 4
"""Tables waiting to be made; more are not taken up until asked for again."""

_log = logging.getLogger(__name__)

Entry = tuple[Model, float, int]
"""Model with its overrides, rate in Hz, ticks of delay beyond one."""


class SettlingLibrary:
    """Tables by model, rate and delay. Without a directory they live in memory alone.

    ``keep`` says whether what is simulated is written to the directory, or only what is there is read.

    May be asked from any thread. Nothing is simulated until somebody asks for it.
    """

    def __init__(self, directory: Path | None = None, *, keep: bool = True) -> None:
        self._directory = directory
        self._keep = keep
        self._tables: dict[str, SettlingTable | None] = {}
        self._due: queue.SimpleQueue[Entry] = queue.SimpleQueue()
        self._asked: set[str] = set()
        self._lock = threading.Lock()
        self._thread: threading.Thread | None = None
        self._open = False

    def open(self) -> None:
        """From now on ``prepare`` prepares."""
        self._open = True

    def find(self, model: Model, rate_hz: float, ticks: int) -> SettlingTable | None:
        """The table if there is one, without simulating."""
        key = key_of(model, rate_hz, ticks)
        with self._lock:
            if key not in self._tables and (stored := self._load(key)) is not None:
                self._tables[key] = stored
            return self._tables.get(key)

    def table(self, model: Model, rate_hz: float, ticks: int) -> SettlingTable | None:
        """The table, simulated here if need be: seconds of work. None when the model cannot be simulated."""
        found = self.find(model, rate_hz, ticks)
        if found is not None:
            return found
        return self._keep_made((model, rate_hz, ticks), lambda: settling_table(model, rate_hz, ticks))

    def prepare(self, model: Model, rate_hz: float, ticks: int) -> None:
        """Has the table made in the background, once. Returns at once; does nothing unless open."""
        key = key_of(model, rate_hz, ticks)
        if self.find(model, rate_hz, ticks) is not None:
            return
        with self._lock:
            if key in self._asked or not self._open or self._due.qsize() >= MOST_DUE:
                return
            self._asked.add(key)
            self._due.put((model, rate_hz, ticks))
            if self._thread is None:
                self._thread = threading.Thread(target=self._work, name="settling", daemon=True)
                self._thread.start()

    def close(self) -> None:
        """Abandons what is being simulated; within one run of the twin."""
        with self._lock:
            self._open = False
            thread = self._thread
        if thread is not None:
            thread.join()

    def _work(self) -> None:
        while self._open:
            try:
                entry = self._due.get(timeout=0.2)
            except queue.Empty:
                with self._lock:
                    if self._due.empty():
                        self._thread = None
                        return
                continue
            self._keep_made(entry, partial(settling_table_apart, *entry, lambda: self._open))

    def _keep_made(self, entry: Entry, make: Callable[[], SettlingTable]) -> SettlingTable | None:
        key, made = key_of(*entry), None
        try:
            made = make()
        except Abandoned:
            return None
        except ValueError as error:
            _log.warning("The stability of %s is not simulated: %s", entry[0].name, error)
        with self._lock:
            self._tables[key] = made
        if made is not None and self._keep:
            self._store(key, made)
        return made

    def _load(self, key: str) -> SettlingTable | None:
        if self._directory is None:
            return None
        try:
            document = json.loads((self._directory / f"{key}.json").read_text(encoding="utf-8"))
            return SettlingTable(
                tuple(document["damping_n_s_per_m"]),
                tuple(document["stiffness_n_per_m"]),
                document["bound_m"],
            )
        except (OSError, ValueError, KeyError, TypeError):
            return None  # not there, or not whole: it is made again

    def _store(self, key: str, table: SettlingTable) -> None:
        if self._directory is None:
            return
        part = self._directory / f"{key}.{threading.get_native_id()}.part"
        try:
            self._directory.mkdir(mode=0o700, parents=True, exist_ok=True)
            part.write_text(json.dumps(asdict(table)), encoding="utf-8")
            part.replace(self._directory / f"{key}.json")
        except OSError as error:
            _log.warning("A stability table was not kept: %s", error)


def key_of(model: Model, rate_hz: float, ticks: int) -> str:
    """Name of a table: changes with anything that could change what is simulated."""
    facts = (FORMAT, _core.build_info()["version"], model.device_json, model.twin_json, rate_hz, ticks)
    return hashlib.blake2b(repr(facts).encode(), digest_size=16).hexdigest()
