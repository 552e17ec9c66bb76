"""Benches that work at the same time, and results in the order of the work."""

from __future__ import annotations

import queue
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import ExitStack
from pathlib import Path
from types import TracebackType
from typing import TypeVar

from isomortar.harness.mutants.bench import Bench

_Item = TypeVar("_Item")
_Result = TypeVar("_Result")


class Pool:
    """`jobs` benches, each with a thread. A context manager: at its end, also by an error, all measuring processes are gone."""

    def __init__(self, package: Path, cases: Path, folder: Path, jobs: int) -> None:
        self._jobs = jobs
        self._stack = ExitStack()
        self._free: queue.SimpleQueue[Bench] = queue.SimpleQueue()
        for i in range(jobs):
            self._free.put(self._stack.enter_context(Bench(package, cases, folder / f"bench{i + 1}")))
        self._threads = ThreadPoolExecutor(jobs)

    def __enter__(self) -> Pool:
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None) -> None:
        self._threads.shutdown(wait=False, cancel_futures=True)
        self._stack.close()

    def work(self, function: Callable[[Bench, _Item], _Result], items: Iterable[_Item]) -> Iterator[tuple[_Item, _Result]]:
        """Every item with what the function makes of it on a bench, in order; a few items ahead of what was asked for."""

        def task(item: _Item) -> _Result:
            bench = self._free.get()
            try:
                return function(bench, item)
            finally:
                self._free.put(bench)

        waiting: deque[tuple[_Item, Future[_Result]]] = deque()
        try:
            for item in items:
                waiting.append((item, self._threads.submit(task, item)))
                if len(waiting) > 2 * self._jobs:
                    first, future = waiting.popleft()
                    yield first, future.result()
            while waiting:
                first, future = waiting.popleft()
                yield first, future.result()
        finally:
            for _, future in waiting:
                future.cancel()
