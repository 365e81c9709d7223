"""The same function over many items on all cores."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from typing import TypeVar

Item = TypeVar("Item")
Result = TypeVar("Result")


def parallel_map(
    function: Callable[[Item], Result], items: Iterable[Item], each: Callable[[int, int], None]
) -> list[Result]:
    """``function`` of every item, in the order of the items whatever the order they finish in.

    Threads, because the core lets go of the interpreter while it simulates. ``each`` is told after every item
    how many are done and how many there are; what it raises, or a function raises, ends the map once the
    items already begun are done.
    """
    everything = list(items)
    with ThreadPoolExecutor(os.cpu_count() or 1, thread_name_prefix="experiment") as pool:
        futures = [pool.submit(function, item) for item in everything]
        try:
            _watch(futures, each)
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise
        return [future.result() for future in futures]


def _watch(futures: list[Future[Result]], each: Callable[[int, int], None]) -> None:
    pending = set(futures)
    while pending:
        done, pending = wait(pending, return_when=FIRST_COMPLETED)
        for future in done:
            future.result()
        each(len(futures) - len(pending), len(futures))
