"""The reproduction: every experiment run and written up on one page."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from hapticd.experiments.carry_out import Finished, Order, carry_out
from hapticd.experiments.catalogue import CATALOGUE, experiment
from hapticd.experiments.claims_table import share
from hapticd.experiments.experiment import Experiment
from hapticd.experiments.jitter import SPREAD
from hapticd.experiments.misprints import MISPRINTS
from hapticd.experiments.parameter_value import shown
from hapticd.experiments.progress import Progress
from hapticd.experiments.settings import resolve

PAGE = "reproduction.md"
IMAGES = Path("images") / "reproduction"
MARKS = {"holds": "✓ holds", "fails": "✗ fails", "undecidable": "? undecidable"}

OF_DRAWS: Mapping[str, Mapping[str, Any]] = {"stability-map": {"columns": 13, "rows": 12}}
"""What is set in the draws of experiments that take minutes."""

INTRODUCTION = """# The papers on the twins

Each claim of the two papers, what the twin of the device shows, and how often that stays so when
everything the papers leave open is off by up to {spread:.0%}. WN: Wilson & Niemeyer, *Improved Multi-DOF
Haptics With Spring Drive Amplifiers*. KS: Kwon & Song, on the hybrid haptic device. This page is generated:

```sh
hapticd experiment reproduce --draws {draws} --seed {seed}
```
"""


def reproduce(
    out: Path, draws: int, seed: int, progress: Progress, names: Sequence[str] | None = None
) -> Path:
    """Runs the experiments, each ``draws`` times more under jitter, and writes the page into ``out``.

    ``names`` are those that are run, by default all.
    """
    names = list(CATALOGUE) if names is None else names
    sections: list[str] = []
    reports: list[Mapping[str, Any]] = []
    for index, name in enumerate(names):
        part = progress.part(index / len(names), (index + 1) / len(names))
        chosen = experiment(name)
        finished = _run(chosen, draws, seed, out / IMAGES, part)
        reports.append(finished.document)
        sections.append("\n".join(_section(chosen, finished.document)))
    introduction = INTRODUCTION.format(spread=SPREAD, draws=draws, seed=seed)
    page = out / PAGE
    page.write_text(
        "\n".join([introduction, *_overview(reports), "", *sections, *_misprints()]) + "\n", encoding="utf-8"
    )
    return page


def _run(chosen: Experiment, draws: int, seed: int, images: Path, progress: Progress) -> Finished:
    images.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as directory:
        of_draws = resolve(chosen, OF_DRAWS.get(chosen.name, {}))
        order = Order(chosen, resolve(chosen, {}), seed, draws, Path(directory), of_draws=of_draws)
        finished = carry_out(order, progress)
        shutil.copy(Path(directory) / f"{chosen.name}.png", images)
    return finished


def _overview(reports: Sequence[Mapping[str, Any]]) -> Iterator[str]:
    yield "| experiment | source | holds | fails | undecidable |"
    yield "|---|---|---|---|---|"
    for report in reports:
        verdicts = [claim["verdict"] for claim in report["claims"]]
        counts = " | ".join(str(verdicts.count(verdict)) for verdict in MARKS)
        yield f"| [{report['experiment']}](#{report['experiment']}) | {_cell(report['source'])} | {counts} |"


def _section(chosen: Experiment, report: Mapping[str, Any]) -> Iterator[str]:
    yield f"## {chosen.name}\n"
    yield f"{chosen.title} ({chosen.source}). `hapticd experiment run {chosen.name}` repeats it.\n"
    yield f"![{chosen.title}]({(IMAGES / f'{chosen.name}.png').as_posix()})\n"
    yield "| claim | source | paper | twin | verdict | holds under jitter |"
    yield "|---|---|---|---|---|---|"
    tallies = {(entry["claim"], entry["source"]): entry for entry in report.get("jitter", ())}
    for claim in report["claims"]:
        verdict = MARKS[claim["verdict"]] + (f": {claim['reason']}" if claim.get("reason") else "")
        cells = [claim["claim"], claim["source"], claim["expected"], claim["measured"], verdict]
        cells.append(share(tallies.get((claim["claim"], claim["source"]))))
        yield _line(cells)
    yield ""
    uncertain = [parameter.name for parameter in chosen.parameters if parameter.uncertain]
    drawn = ", ".join(f"`{name}`" for name in (*uncertain, *chosen.uncertain))
    yield f"Drawn: {drawn}.\n" if drawn else "Nothing about it is uncertain, so nothing is drawn.\n"
    if coarser := OF_DRAWS.get(chosen.name):
        values = ", ".join(f"`{name}={shown(value)}`" for name, value in coarser.items())
        yield f"In the draws {values}.\n"


def _misprints() -> Iterator[str]:
    yield "## What the papers print wrongly or leave open\n"
    yield "| place | kind | paper | here |"
    yield "|---|---|---|---|"
    for entry in MISPRINTS:
        yield _line((entry.where, entry.kind, entry.printed, entry.here))


def _line(cells: Sequence[str]) -> str:
    return f"| {' | '.join(_cell(cell) for cell in cells)} |"


def _cell(text: str) -> str:
    """``text`` fit for a cell of a table."""
    return text.replace("|", "\\|").replace("\n", " ")
