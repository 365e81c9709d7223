"""Every experiment by name. Its module is imported when it is asked for."""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from typing import cast

from hapticd.experiments.experiment import Experiment
from hapticd.problem import Problem

CATALOGUE: Mapping[str, str] = {
    "stiffness-bode": "hapticd.experiments.stiffness_bode:EXPERIMENT",
    "stiffness-ellipse": "hapticd.experiments.stiffness_ellipse:EXPERIMENT",
    "force-direction": "hapticd.experiments.force_direction:EXPERIMENT",
    "spring-vs-current": "hapticd.experiments.spring_vs_current:EXPERIMENT",
    "workspace-force": "hapticd.experiments.workspace_force:EXPERIMENT",
    "wall-contact": "hapticd.experiments.wall_contact:EXPERIMENT",
    "friction": "hapticd.experiments.friction:EXPERIMENT",
    "brake-release": "hapticd.experiments.brake_release:EXPERIMENT",
    "stability-map": "hapticd.experiments.stability_map:EXPERIMENT",
}
"""Import strings, in the order of the papers."""


def experiment(name: str) -> Experiment:
    """The experiment of this name. ``Problem`` (experiment-not-found) lists those there are."""
    if name not in CATALOGUE:
        detail = f"There is no experiment {name!r}."
        hint = f"Choose one of {', '.join(CATALOGUE)}."
        raise Problem("experiment-not-found", detail, hint=hint, allowed=list(CATALOGUE))
    return load(CATALOGUE[name])


def load(import_string: str) -> Experiment:
    """The experiment at ``module:name``."""
    module, _, attribute = import_string.partition(":")
    return cast(Experiment, getattr(importlib.import_module(module), attribute))
