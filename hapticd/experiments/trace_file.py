"""A trace as Parquet, each column with its unit."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hapticd.experiments.experiment import Outcome
from hapticd.experiments.library import require
from hapticd.experiments.unit import unit_of

Table = NDArray[Any] | Mapping[str, NDArray[np.float64]]


def write_traces(outcome: Outcome, stem: Path, facts: Mapping[str, str]) -> list[Path]:
    """Writes ``stem``-<name>.parquet for every trace. ``Problem`` (library-missing).

    Columns carry ``unit`` in their metadata, the file ``facts`` and the name of the trace.
    """
    return [
        _write(table, stem.with_name(f"{stem.name}-{name}.parquet"), {**facts, "trace": name})
        for name, table in outcome.traces.items()
    ]


def _write(table: Table, file: Path, facts: Mapping[str, str]) -> Path:
    pyarrow, parquet = require("pyarrow"), require("pyarrow.parquet")
    columns = {name: _column(pyarrow, np.asarray(table[name])) for name in _names(table)}
    fields = [
        pyarrow.field(name, column.type, metadata={"unit": unit_of(name)}) for name, column in columns.items()
    ]
    schema = pyarrow.schema(fields, metadata=dict(facts))
    parquet.write_table(
        pyarrow.table(list(columns.values()), schema=schema), file, compression="zstd", version="2.6"
    )
    return file


def _names(table: Table) -> list[str]:
    return list(table.dtype.names or ()) if isinstance(table, np.ndarray) else list(table)


def _column(pyarrow: Any, values: NDArray[Any]) -> Any:
    """One column; of shape (n, k) each row is a list of k."""
    flat = pyarrow.array(np.ascontiguousarray(values).reshape(-1))
    return flat if values.ndim == 1 else pyarrow.FixedSizeListArray.from_arrays(flat, values.shape[1])
