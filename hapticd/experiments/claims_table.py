"""The claims of a run as a table for people."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from rich.markup import escape
from rich.table import Table

MARKS = {"holds": "[green]✓[/]", "fails": "[bold red]✗[/]", "undecidable": "[yellow]?[/]"}


def claims_table(report: Mapping[str, Any]) -> Table:
    """Each claim with its verdict; with how often it holds where the run was jittered."""
    tallies = {(entry["claim"], entry["source"]): entry for entry in report.get("jitter", ())}
    table = Table(box=None, pad_edge=False, header_style="bold")
    for header in ("", "Claim", "Source", "Expected", "Measured"):
        table.add_column(header, overflow="fold")
    if tallies:
        table.add_column("Holds", justify="right")
    for claim in report["claims"]:
        row = [MARKS[claim["verdict"]], *_cells(claim)]
        if tallies:
            row.append(share(tallies.get((claim["claim"], claim["source"]))))
        table.add_row(*row)
    return table


def share(tally: Mapping[str, Any] | None) -> str:
    """How often a claim held, in words; a dash where nothing was drawn or could be decided."""
    if tally is None or tally["undecidable"] == tally["draws"]:
        return "–"
    undecided = f", {tally['undecidable']} undecidable" if tally["undecidable"] else ""
    return f"{tally['holds']} of {tally['draws']}{undecided}"


def _cells(claim: Mapping[str, Any]) -> list[str]:
    measured = escape(claim["measured"])
    if claim.get("reason"):
        measured += f"\n[dim]{escape(claim['reason'])}[/]"
    return [escape(claim["claim"]), escape(claim["source"]), escape(claim["expected"]), measured]
