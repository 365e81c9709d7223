"""Every kind of problem, with what causes it, what to check and what cures it.

The API serves each at ``/problems/<slug>``, so that the link in an error works without a network.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class ProblemType:
    """One kind of problem. ``status`` is the HTTP status it maps to."""

    slug: str
    status: int
    title: str
    cause: str
    check: str
    fix: str
    retryable: bool = False


_TYPES = (
    # The request itself
    ProblemType(
        "invalid-document",
        422,
        "The document is not valid",
        "A field is missing, has the wrong type, or lies outside its range. Numbers must be finite.",
        "Read the pointer: it names the field. The schema is in /openapi.json.",
        "Correct the field named by the pointer and send the document again.",
    ),
    ProblemType(
        "unknown-field",
        422,
        "The document has a field that does not exist",
        "Unknown fields are refused, because a misspelt one would otherwise be ignored in silence.",
        "Compare the field named by the pointer with the schema in /openapi.json.",
        "Correct the spelling or leave the field out.",
    ),
    ProblemType(
        "malformed-json",
        400,
        "The body is not JSON",
        "The body could not be parsed, or it holds NaN or an infinity, which JSON does not have.",
        "Run the body through a JSON checker.",
        "Send well-formed JSON with finite numbers.",
    ),
    ProblemType(
        "unsupported-media-type",
        415,
        "The body must be JSON",
        "Writes accept application/json alone, so that no web page can send one without asking first.",
        "Look at the request's Content-Type header.",
        "Send the header Content-Type: application/json.",
    ),
    ProblemType(
        "body-too-large",
        413,
        "The body is too large",
        "Request bodies are limited to 1 MB.",
        "A scene holds at most 256 walls, which is far below the limit.",
        "Send a smaller document.",
    ),
    ProblemType(
        "host-not-allowed",
        421,
        "The daemon does not answer to this host name",
        "The Host header is not in the allow-list, which protects against DNS rebinding.",
        "Look at the address in the request.",
        "Use the address the daemon printed at start.",
    ),
    ProblemType(
        "origin-not-allowed",
        403,
        "Writes from this origin are refused",
        "The Origin header names another site. A page of another site must not move a device.",
        "Look at the page that sent the request.",
        "Use a page that the daemon serves, or a client that sends no Origin header.",
    ),
    ProblemType(
        "route-not-found",
        404,
        "There is nothing at this address",
        "No resource has this path.",
        "GET /api/v1 lists the links; /docs shows every route.",
        "Correct the path.",
    ),
    ProblemType(
        "method-not-allowed",
        405,
        "This resource does not know this verb",
        "The path exists, the verb does not.",
        "The Allow header lists the verbs.",
        "Use one of the allowed verbs.",
    ),
    ProblemType(
        "revision-stale",
        412,
        "The document has changed since you read it",
        "If-Match names a revision that is no longer the present one: somebody edited in between.",
        "GET the document: its ETag is the present revision.",
        "Read it again, repeat the edit on what you read, and send it with the new ETag.",
    ),
    ProblemType(
        "idempotency-key-reused",
        422,
        "The idempotency key belongs to another request",
        "An Idempotency-Key marks one request, so that it can be repeated; this one marked another body.",
        "Compare the request with the one that was first sent with this key.",
        "Make a new key for each new request.",
    ),
    # Things that are not there
    ProblemType(
        "device-not-found",
        404,
        "There is no such device",
        "No device with this id is configured.",
        "GET /api/v1/devices lists them.",
        "Use a configured id, or add the device to the configuration and restart.",
    ),
    ProblemType(
        "wall-not-found",
        404,
        "There is no such wall",
        "The device's scene has no wall with this id.",
        "GET the scene's walls.",
        "Use the id of a wall in the scene, or PUT the wall to make it.",
    ),
    ProblemType(
        "fault-not-found",
        404,
        "There is no such fault",
        "No fault has this name, or the device has not latched it.",
        "GET the device's faults.",
        "Acknowledge a fault that is listed.",
    ),
    ProblemType(
        "signal-unknown",
        422,
        "There is no such signal",
        "A subscription names a signal that the tick record does not have.",
        "The welcome message and GET /api/v1 list the signals.",
        "Use names from the list in allowed.",
    ),
    # The scene
    ProblemType(
        "wall-exists",
        409,
        "A wall with this id exists",
        "The request asked to make a new wall.",
        "GET the wall.",
        "PUT the wall to replace it, or choose another id.",
    ),
    ProblemType(
        "dimension-mismatch",
        422,
        "The vector has the wrong length for this device",
        "A device with two coordinates takes vectors of two numbers, one with three takes three.",
        "GET the device: dof is the length of its vectors.",
        "Send vectors of that length.",
    ),
    ProblemType(
        "too-many-walls",
        422,
        "The scene has too many walls",
        "The control loop holds a fixed number of walls so that its tick stays bounded.",
        "Count the walls of the scene.",
        "Send at most 256 walls.",
    ),
    # The device
    ProblemType(
        "interlock-open",
        409,
        "An interlock keeps the device from this state",
        "Something must be true before the device may be enabled, and is not yet.",
        "Read interlocks: each says why it is open and what closes it.",
        "Close the interlocks listed, then ask again.",
    ),
    ProblemType(
        "state-refused",
        409,
        "The device cannot go from its state to that one",
        "The state machine has no such step.",
        "current_state is the state now, allowed lists the states that can be reached from it.",
        "Go through one of the allowed states.",
    ),
    ProblemType(
        "device-offline",
        409,
        "The device is offline",
        "Its servo process is not running or has not started yet.",
        "GET the device: health says why. The supervisor restarts the servo by itself.",
        "Wait until the device is no longer offline, then ask again.",
        retryable=True,
    ),
    ProblemType(
        "servo-silent",
        504,
        "The servo did not answer in time",
        "The request was handed to the servo, and no acknowledgement came back. It may still take effect.",
        "GET the device for its state; see /api/v1/system/realtime for late ticks.",
        "Read the state before sending the request again.",
        retryable=True,
    ),
    ProblemType(
        "servo-busy",
        503,
        "The servo's request queue is full",
        "More requests arrived than the loop takes in at its bounded number a tick.",
        "Look for a client that writes in a tight loop.",
        "Send the request again in a moment.",
        retryable=True,
    ),
    ProblemType(
        "epoch-stale",
        409,
        "The right to write has passed to somebody else",
        "The servo has seen a newer lease than the one this request was sent under.",
        "Ask who holds the lease.",
        "Take the lease again, then repeat the request.",
    ),
    ProblemType(
        "not-a-twin",
        409,
        "This device is not a twin",
        "A simulated hand and injected faults exist on twins alone; this device is driven by hardware.",
        "GET the device: twin is false.",
        "Use a device whose driver is twin.",
    ),
    ProblemType(
        "storage-failed",
        500,
        "The change is in force but could not be written to disk",
        "The state directory is full, read-only or not writable.",
        "Run hapticd doctor: it checks the directories.",
        "Make room or fix the permissions, then send the document again. Until then a restart forgets it.",
        retryable=True,
    ),
    # Experiments and jobs
    ProblemType(
        "experiment-not-found",
        404,
        "There is no such experiment",
        "No experiment has this name.",
        "hapticd experiment list, or GET /api/v1/experiments.",
        "Use one of the names in allowed.",
    ),
    ProblemType(
        "parameter-unknown",
        422,
        "The experiment has no such parameter",
        "The name is neither a parameter of the experiment nor a key of the device models it uses.",
        "hapticd experiment show NAME, or GET /api/v1/experiments/{name}, lists every parameter.",
        "Use one of the names in allowed.",
    ),
    ProblemType(
        "parameter-invalid",
        422,
        "The parameter cannot have this value",
        "The value has the wrong type, lies outside the parameter's range, or makes no sense in the model.",
        "hapticd experiment show NAME, or GET /api/v1/experiments/{name}, gives unit, default and range.",
        "Set a value in the range.",
    ),
    ProblemType(
        "experiment-simulated-only",
        409,
        "The experiment runs on a simulated device alone",
        "It needs what no real device offers: other hardware, or the same hand every time.",
        "GET /api/v1/experiments: on_device says which run on a device.",
        "Leave the device out, and the experiment runs on its own twin.",
    ),
    ProblemType(
        "experiment-failed",
        500,
        "The experiment did not come to an end",
        "The process that ran it died, or a device was lost while it was used.",
        "The detail says what happened; the daemon's log has more.",
        "Run it again with the same seed; report it if it fails again.",
    ),
    ProblemType(
        "device-not-enabled",
        409,
        "The device is not enabled",
        "An experiment on a device moves it, so somebody must have enabled it first, and it stays enabled.",
        "GET the device: state and interlocks.",
        "Enable the device, then start the experiment again.",
    ),
    ProblemType(
        "device-lent",
        409,
        "The device is lent to an experiment",
        "While an experiment uses the device, nobody else changes what it renders.",
        "GET /api/v1/jobs: the running job names the device.",
        "Wait until the job has ended, or cancel it with DELETE; disabling and the E-stop work at any time.",
        retryable=True,
    ),
    ProblemType(
        "library-missing",
        500,
        "A Python library is missing",
        "Figures and traces need libraries that the daemon itself does without.",
        "The detail names the library.",
        "Run pip install 'hapticd[experiments]'.",
    ),
    ProblemType(
        "job-not-found",
        404,
        "There is no such job",
        "No job has this id, or it is so old that it was forgotten.",
        "GET /api/v1/jobs lists those there are.",
        "Use the id from the Location that started the job.",
    ),
    ProblemType(
        "job-ended",
        409,
        "The job has ended",
        "A job that has ended cannot be cancelled.",
        "GET the job: state says how it ended.",
        "Nothing to do.",
    ),
    ProblemType(
        "job-file-not-found",
        404,
        "The job has no such file",
        "The job has not ended yet, failed, or never made a file of this name.",
        "GET the job: files lists those there are.",
        "Use a name from files.",
    ),
    ProblemType(
        "too-many-jobs",
        503,
        "Too many jobs are waiting",
        "Jobs run one after the other; only a few may wait.",
        "GET /api/v1/jobs.",
        "Cancel a job that waits, or send the request again later.",
        retryable=True,
    ),
    # The daemon
    ProblemType(
        "config-invalid",
        500,
        "The configuration is not valid",
        "A key is unknown, missing, or has a value outside its range. Nothing is ignored in silence.",
        "Read the detail: it names file and key.",
        "Correct the key and start again; hapticd doctor checks a configuration without starting.",
    ),
    ProblemType(
        "directory-unusable",
        500,
        "A directory of the daemon cannot be used",
        "It does not exist and cannot be made, or cannot be written.",
        "Run hapticd doctor, or ls -ld on the directory in the detail.",
        "Fix its permissions, or name another one under [paths].",
    ),
    ProblemType(
        "already-running",
        500,
        "Another daemon serves these devices",
        "Two front processes must not command the same servos.",
        "Look for another hapticd run with the same runtime directory.",
        "Stop the other daemon, or give this one its own [paths] runtime_dir and state_dir.",
    ),
    ProblemType(
        "address-in-use",
        500,
        "The address is taken",
        "Another program listens on this host and port.",
        "Run ss -ltnp to see which.",
        "Stop it, or choose another port with --port or [api] port.",
    ),
    ProblemType(
        "stopping",
        503,
        "The daemon is stopping",
        "Forces are being faded out; no change is taken any more.",
        "Nothing to check.",
        "Send the request again once the daemon has restarted.",
        retryable=True,
    ),
    ProblemType(
        "internal-error",
        500,
        "The daemon failed at this request",
        "An error that nobody foresaw. The device is not affected: it is run by another process.",
        "The daemon's log has the trace.",
        "Report it with the log.",
    ),
)

PROBLEM_TYPES: Mapping[str, ProblemType] = {kind.slug: kind for kind in _TYPES}
