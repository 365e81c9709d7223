"""A device, as everything above the loop sees it."""

from __future__ import annotations

import asyncio
import time
from collections.abc import AsyncIterator, Callable, Mapping
from contextlib import asynccontextmanager, suppress
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any

import numpy as np

from hapticd.admission import Admission
from hapticd.analysis.device_stability import DeviceStability
from hapticd.analysis.measured_delay import command_delay_ticks, exchange_s, loop_delay_s
from hapticd.analysis.settling_library import SettlingLibrary
from hapticd.channel import Channel, Link
from hapticd.config import DeviceConfig
from hapticd.device_report import Attachment, DeviceReporter, in_force
from hapticd.edit_terms import PLAIN, Terms
from hapticd.events import EventLog
from hapticd.frame import Records
from hapticd.granter import NO_ADMISSIONS, Granter
from hapticd.hand import HandScript, Hold, flat_script
from hapticd.injection import Injection
from hapticd.loan import Loan
from hapticd.misses import Misses
from hapticd.model import Model
from hapticd.problem import Problem
from hapticd.reading import Reading, records_of
from hapticd.realtime import Miss, RealtimeReport, realtime_report
from hapticd.reasons import fault_bits, faults
from hapticd.record import record_dtype
from hapticd.refusal import refusal
from hapticd.scene import Scene
from hapticd.scene_editor import SceneEditor
from hapticd.scene_result import GrantedWall, SceneResult
from hapticd.scene_store import SceneStore
from hapticd.servo_event import kind_of, message_of
from hapticd.snapshot import DESIRED_STATES, Applied, DeviceSnapshot
from hapticd.vector import AXES
from hapticd.wall import Wall

if TYPE_CHECKING:
    from hapticd._core import ServoEvent, ServoStatus

NOT_STARTED = "Its servo has not started yet."


@dataclass(frozen=True)
class TickBatch:
    """Ticks read from the loop: ``records`` is a structured array of ``record_dtype()``, shape (n,).

    ``first`` is the number of its first tick, ``lost`` the ticks between ``since`` and it that are gone.
    """

    records: Records
    first: int
    lost: int


class Device:
    """One configured device. Every coroutine raises ``Problem`` where the device refuses.

    Belongs to the event loop's thread. The supervisor attaches and detaches the link to its servo.
    """

    def __init__(
        self,
        config: DeviceConfig,
        model: Model,
        store: SceneStore,
        events: EventLog,
        settling: SettlingLibrary | None = None,
    ) -> None:
        self.device_id: str = config.id
        self.model: Model = model
        self.model_name: str = model.name
        self.dof: int = model.dof
        self.driver: str = config.driver
        self.is_twin: bool = config.is_twin
        self.rate_hz: float = config.rate_hz
        self.stability = DeviceStability(model, config.rate_hz, self._delay_s, settling or SettlingLibrary())
        self._reporter = DeviceReporter(config, model)
        self._granter = Granter.of_model(model)
        self._events = events
        self._editor = SceneEditor(
            config.id,
            model,
            store,
            events,
            send=self._send_scene,
            stability=self.stability,
            grant=self.granted_walls,
        )
        self._hand: HandScript = Hold(type="hold")
        self._link: Link | None = None
        self._channel: Channel | None = None
        self._why_offline: str | None = NOT_STARTED
        self._attachments = 0
        self._misses = Misses()
        self._told_until_ns = 0
        self._estop_owed = False
        self._restored = False

    # State -------------------------------------------------------------------------------------

    def snapshot(self) -> DeviceSnapshot:
        """Everything about the device at this instant."""
        attachment = Attachment(self._why_offline, self._attachments, self._pid)
        return self._reporter.snapshot(
            self._editor, attachment, self._reading(), self._status(), estop=self.estop
        )

    async def set_desired(self, desired: str) -> Applied:
        """Asks for ``enabled``, ``disabled`` or ``paused``.

        ``Problem``: interlock-open, state-refused, device-offline.
        """
        if desired not in DESIRED_STATES:
            raise Problem(
                "invalid-document", f"{desired!r} is not a state one can ask for.", allowed=DESIRED_STATES
            )
        limits = self._reporter.limits
        fade_s = limits.ramp_s if desired == "enabled" else limits.fade_s
        return await self._apply({"type": "desired", "desired": desired}, fade_s)

    @property
    def estop(self) -> bool:
        """Whether the E-stop is latched, in the servo or for the next one."""
        reading = self._reading()
        return self._estop_owed or (reading is not None and reading.flags.estop)

    async def engage_estop(self) -> Applied | None:
        """Latches the E-stop: outputs are zero from that tick on. Idempotent.

        None without a servo, which drives nothing: the next one is told before anything else.
        """
        if self._channel is None:
            self._estop_owed = True
            return None
        return await self._apply({"type": "estop"})

    async def acknowledge_estop(self) -> Applied | None:
        """Clears the latched E-stop; None where it only waited for a servo.

        ``Problem``: interlock-open while its input is open, device-offline when nothing waited.
        """
        owed, self._estop_owed = self._estop_owed, False
        if self._channel is None and owed:
            return None
        return await self._apply({"type": "estop_ack"})

    async def acknowledge_fault(self, slug: str) -> Applied:
        """Clears one latched fault; it latches anew while its cause lasts. ``Problem``: fault-not-found."""
        reading = self._reading()
        latched = [fault.id for fault in faults(reading.integer("faults"))] if reading else []
        if slug not in latched:
            detail = f"{self.device_id} has not latched a fault {slug!r}."
            raise Problem("fault-not-found", detail, device_id=self.device_id, allowed=latched)
        return await self._apply({"type": "fault_ack", "faults": fault_bits()[slug]})

    # Scene -------------------------------------------------------------------------------------

    @property
    def scene(self) -> Scene:
        return self._editor.scene

    @property
    def scene_etag(self) -> str:
        return self._editor.etag

    async def edit_scene(self, change: Callable[[Scene], Scene], terms: Terms = PLAIN) -> SceneResult:
        """Puts what ``change`` makes of the present scene in force; no other edit comes between."""
        return await self._editor.edit(change, terms)

    async def replace_scene(self, scene: Scene, terms: Terms = PLAIN) -> SceneResult:
        """Puts another scene in force, whole at one tick, faded so that no force steps."""
        return await self._editor.replace(scene, terms)

    def get_wall(self, wall_id: str) -> Wall:
        """The wall of this id. ``Problem``: wall-not-found."""
        return self._editor.wall(wall_id)

    def granted_walls(
        self, scene: Scene, admissions: Mapping[str, Admission] = NO_ADMISSIONS
    ) -> list[GrantedWall]:
        """What each enabled wall of a scene comes to at the present pose."""
        reading = self._reading()
        k_c = reading.number("stiffness_n_per_m") if reading else None
        return self._granter.walls(scene, k_c, admissions)

    async def put_wall(self, wall: Wall, terms: Terms = PLAIN, *, create_only: bool = False) -> SceneResult:
        """Adds a wall, or replaces its namesake. ``Problem`` (wall-exists) instead when ``create_only``."""
        return await self._editor.put_wall(wall, terms, create_only=create_only)

    async def change_wall(
        self, wall_id: str, change: Callable[[Wall], Wall], terms: Terms = PLAIN
    ) -> SceneResult:
        """Puts what ``change`` makes of a wall in its place. ``Problem``: wall-not-found."""
        return await self._editor.change_wall(wall_id, change, terms)

    async def delete_wall(self, wall_id: str, terms: Terms = PLAIN) -> SceneResult:
        """Takes a wall away. ``Problem``: wall-not-found."""
        return await self._editor.delete_wall(wall_id, terms)

    # Twin --------------------------------------------------------------------------------------

    @property
    def hand(self) -> HandScript:
        """What the twin's hand was last told. ``Problem``: not-a-twin."""
        self._require_twin()
        return self._hand

    async def set_hand(self, script: HandScript) -> Applied:
        """Tells the twin's hand what to do. ``Problem``: not-a-twin, dimension-mismatch, device-lent."""
        self._require_twin()
        self._editor.check_not_lent()
        applied = await self._apply({"type": "hand", "script": flat_script(script, self.dof)})
        self._hand = script
        return applied

    async def inject(self, injection: Injection) -> Applied:
        """Injects a fault into the twin. ``Problem``: not-a-twin."""
        self._require_twin()
        return await self._apply({"type": "inject", "injection": injection.model_dump()})

    # Loan --------------------------------------------------------------------------------------

    @asynccontextmanager
    async def lent(self, to: str) -> AsyncIterator[Loan]:
        """Lends the device: meanwhile the scene and the hand are the holder's, and edits are refused.

        Afterwards, however that comes about, scene and hand are as before. State and E-stop stay everybody's.
        ``Problem`` (device-lent) while somebody else has it.
        """
        await self._editor.lend(to)
        loan = Loan(self._apply, self._editor.next_revision)
        try:
            yield loan
        finally:
            loan.end()
            self._editor.take_back()
            await asyncio.shield(self._put_back(loan))

    async def _put_back(self, loan: Loan) -> None:
        # A device that is gone is told everything when it comes back.
        with suppress(Problem):
            await self._editor.send_present(lambda: loan.scene_changed, self._reporter.limits.fade_s)
            if loan.hand_changed:
                await self.set_hand(self._hand)

    # Ticks -------------------------------------------------------------------------------------

    def realtime(self) -> RealtimeReport | None:
        """Scheduling really obtained, histograms, misses. None before the servo's first status."""
        status = self._status()
        return realtime_report(self.device_id, self.rate_hz, status, self._misses.recent) if status else None

    @property
    def joint_angles_rad(self) -> list[float] | None:
        """Joint angles of the newest tick, (3,); None while offline."""
        reading = self._reading()
        return None if reading is None else reading.vector("joint_position_rad", AXES)

    def _delay_s(self) -> float:
        # A twin lives a whole tick under each command, however long its exchange takes to compute.
        measured = 0.0 if self.is_twin else exchange_s(self._status())
        return loop_delay_s(self.rate_hz, measured, command_delay_ticks(self.model))

    def head(self) -> int:
        """Ticks published so far; 0 while offline."""
        return self._link.head() if self._link else 0

    def read(self, since: int, limit: int) -> TickBatch:
        """At most ``limit`` ticks from ``since`` on. Empty while offline."""
        if self._link is None:
            return TickBatch(np.empty(0, record_dtype()), since, 0)
        raw, first, lost = self._link.read(since, limit)
        return TickBatch(records_of(raw), first, lost)

    # Servo -------------------------------------------------------------------------------------

    def attach(self, link: Link) -> None:
        """Takes a servo's link into use."""
        self._link = link
        self._channel = Channel(self.device_id, link)
        self._why_offline = None
        self._attachments += 1
        self._restored = False
        self._misses = Misses()
        started = datetime.fromtimestamp(link.info()["started_utc_ns"] / 1e9, UTC)
        self._told_until_ns = self._events.loop_told_until_ns(self.device_id, started)

    def detach(self, why: str) -> None:
        """Lets go of the link: the device is offline, and waiting requests end with a problem."""
        if self._channel is not None:
            self._channel.close(why)
            self._estop_owed = self.estop
        self._link, self._channel = None, None
        self._why_offline = why

    def explain_absence(self, why: str | None) -> None:
        """Says why the device does not answer its servo; None when it does."""
        self._why_offline = why

    async def restore(self) -> None:
        """Gives the servo what it does not know: E-stop, hand and scene. Nothing to do costs nothing.

        A latched E-stop does not end with the servo that latched it, only by its acknowledgement. The scene
        is also sent again when the loop renders another revision, as after an edit nobody acknowledged.
        """
        if self._estop_owed and await self.engage_estop():
            self._estop_owed = False
        if self._editor.is_lent:
            return
        if self.is_twin and not self._restored:
            await self.set_hand(self._hand)
        await self._editor.send_present(lambda: not (self._restored and self.scene_in_force))
        self._restored = True

    @property
    def scene_in_force(self) -> bool:
        """Whether the loop renders the present revision."""
        return in_force(self._editor, self._reading())

    def tell_servo_events(self) -> None:
        """Moves what the servo told into the event log."""
        for event in self._link.events() if self._link else ():
            # A servo that outlived a front still keeps what that front has already told.
            if event["t_mono_ns"] > self._told_until_ns:
                self._tell(event)
        if summary := self._misses.summary(time.monotonic_ns()):
            self._events.append("servo.miss", f"{self.device_id} {summary}", device_id=self.device_id)

    def _tell(self, event: ServoEvent) -> None:
        if event["kind"] == "miss":
            self._misses.note(Miss.of(event))
            return
        if event["kind"] == "passivity":
            wall_id = self._editor.wall_id(event["details"]["wall"])
            event = {**event, "details": {**event["details"], "wall": wall_id}}
        self._events.append(
            kind_of(event),
            message_of(self.device_id, event),
            device_id=self.device_id,
            tick=event["tick"],
            t_mono_ns=event["t_mono_ns"],
            details=event["details"],
        )

    def _require_twin(self) -> None:
        if not self.is_twin:
            detail = f"{self.device_id} is driven by {self.driver}, not by a twin."
            raise Problem("not-a-twin", detail, device_id=self.device_id)

    @property
    def _pid(self) -> int | None:
        return self._link.info()["pid"] if self._link else None

    def _reading(self) -> Reading | None:
        return Reading.of(self._link.latest()) if self._link else None

    def _status(self) -> ServoStatus | None:
        return self._link.status() if self._link else None

    async def _apply(self, request: Mapping[str, Any], fade_s: float = 0.0) -> Applied:
        if self._channel is None:
            detail = f"{self.device_id} is offline. {self._why_offline}"
            raise Problem("device-offline", detail, device_id=self.device_id, current_state="offline")
        ack = await self._channel.request(request)
        if ack["result"] != "applied":
            raise refusal(self.device_id, request["type"], ack)
        reading = self._reading()
        clamped = reading.limits if reading else []
        return Applied(tick=ack["tick"], t_mono_ns=ack["t_mono_ns"], fade_s=fade_s, clamped=clamped)

    async def _send_scene(self, flat: Mapping[str, Any], fade_s: float) -> Applied | None:
        if self._channel is None:
            return None
        return await self._apply({"type": "scene", "scene": flat}, fade_s)
