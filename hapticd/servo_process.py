"""The servo process of one device: started, watched and stopped by the front."""

from __future__ import annotations

import asyncio
import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from hapticd.config import DeviceConfig
from hapticd.model import Model

ORPHAN_EXIT_S = 10.0
"""How long a servo outlives its front: long enough for a new front to attach, and then it is gone."""

TERMINATE_S = 2.5
"""How long a servo may take to fade out and exit before it is killed: its own bound is 2 s."""

LOG_TAIL_CHARS = 400

PROGRAM = (sys.executable, "-m", "hapticd.servo")
"""What is started; the configuration file follows."""


class ServoProcess:
    """One device's servo, with its configuration, region and log in the runtime directory."""

    def __init__(
        self, config: DeviceConfig, model: Model, runtime_dir: Path, program: Sequence[str] = PROGRAM
    ) -> None:
        self._program = program
        self.region = runtime_dir / f"{config.id}.shm"
        self._config_file = runtime_dir / f"{config.id}.json"
        self._log_file = runtime_dir / f"{config.id}.log"
        self._config_text = json.dumps(_servo_config(config, model, self.region), indent=1)
        self._process: asyncio.subprocess.Process | None = None

    @property
    def pid(self) -> int | None:
        """Process id while it runs."""
        return self._process.pid if self._process and self._process.returncode is None else None

    def configured_alike(self) -> bool:
        """Whether a servo started by an earlier front from this directory had this configuration."""
        try:
            return self._config_file.read_text(encoding="utf-8") == self._config_text
        except FileNotFoundError:
            # A service manager started it, from a file of its own.
            return True

    async def launch(self) -> None:
        """Starts the process. ``OSError`` when it cannot be started."""
        self._config_file.write_text(self._config_text, encoding="utf-8")
        # A file, not a pipe: a servo whose front died must not die of a broken pipe while it fades out.
        with self._log_file.open("wb") as log:
            # A session of its own: Ctrl-C at the terminal goes to the front alone, which fades forces out
            # first.
            self._process = await asyncio.create_subprocess_exec(
                *self._program,
                str(self._config_file),
                stdin=asyncio.subprocess.DEVNULL,
                stdout=log,
                stderr=log,
                start_new_session=True,
            )

    def ending(self) -> str | None:
        """How the process ended; None while it runs or when there is none."""
        code = self._process.returncode if self._process else None
        if code is None:
            return None
        how = f"was killed by signal {-code}" if code < 0 else f"exited with code {code}"
        return f"Its servo {how}. {self.last_words()}".rstrip()

    async def terminate(self) -> bool:
        """Asks the process to fade out and exit, and kills it if it does not. Whether it went by itself."""
        process = self._process
        if process is None or process.returncode is not None:
            return True
        process.terminate()
        try:
            await asyncio.wait_for(process.wait(), TERMINATE_S)
        except TimeoutError:
            process.kill()
            await process.wait()
            return False
        return True

    def last_words(self) -> str:
        """The last line of its log, as a sentence; empty when there is none."""
        try:
            lines = self._log_file.read_text(encoding="utf-8", errors="replace").strip().splitlines()
        except OSError:
            return ""
        return f"Its log ends: {lines[-1][-LOG_TAIL_CHARS:]}" if lines else ""


def _servo_config(config: DeviceConfig, model: Model, region: Path) -> dict[str, Any]:
    return {
        "device_id": config.id,
        "device_model": json.loads(model.device_json),
        "twin_model": json.loads(model.twin_json) if config.is_twin else None,
        "driver": config.driver,
        "options": config.options,
        "rate_hz": config.rate_hz,
        "realtime": config.realtime,
        "priority": config.priority,
        "cpu": config.cpu,
        "region": str(region),
        "seed": config.seed,
        "orphan_exit_s": ORPHAN_EXIT_S,
    }
