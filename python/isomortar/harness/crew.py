"""Threads that work at the same time, each with a tool of its own: a measuring process, a copy of the program."""

from __future__ import annotations

import queue
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import AbstractContextManager, ExitStack
from types import TracebackType
from typing import Any, Generic, TypeVar

Tool = TypeVar("Tool", bound=AbstractContextManager[Any])
_Item = TypeVar("_Item")
_Result = TypeVar("_Result")


class Crew(Generic[Tool]):
    """A thread for each of some tools. A context manager: where an error ends it, Ctrl-C too, the tools end first and work with them."""

    def __init__(self, tools: Sequence[Tool]) -> None:
        self._tools = ExitStack()
        self._free: queue.SimpleQueue[Tool] = queue.SimpleQueue()
        for tool in tools:
            self._free.put(self._tools.enter_context(tool))
        self._threads = ThreadPoolExecutor(len(tools))
        self._size = len(tools)

    def __enter__(self) -> Crew[Tool]:
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None) -> None:
        if kind:
            self._threads.shutdown(wait=False, cancel_futures=True)
            self._tools.close()
        self._threads.shutdown()
        self._tools.close()

    def submit(self, function: Callable[[Tool, _Item], _Result], item: _Item) -> Future[_Result]:
        """Call a function with a tool that is free, and an item."""
        return self._threads.submit(self._call, function, item)

    def each(self, function: Callable[[Tool, _Item], _Result], items: Iterable[_Item]) -> Iterator[tuple[_Item, _Result]]:
        """Every item with what the function makes of it, in order.

        Items of a sequence wait for tools alone, and one that takes long holds up no other; what makes its items on demand is asked for a
        few more than were taken.
        """
        most = len(items) if isinstance(items, Sequence) else 2 * self._size
        waiting: deque[tuple[_Item, Future[_Result]]] = deque()
        try:
            for item in items:
                waiting.append((item, self.submit(function, item)))
                if len(waiting) > most:
                    first, future = waiting.popleft()
                    yield first, future.result()
            while waiting:
                first, future = waiting.popleft()
                yield first, future.result()
        finally:
            for _, future in waiting:
                future.cancel()

    def _call(self, function: Callable[[Tool, _Item], _Result], item: _Item) -> _Result:
        tool = self._free.get()
        try:
            return function(tool, item)
        finally:
            self._free.put(tool)
