"""Threads with tools of their own: who has one works, whoever else takes long."""

import threading
from contextlib import nullcontext

from isomortar.harness.crew import Crew


def test_one_item_that_takes_long_holds_up_no_other():
    others, last = threading.Event(), 50

    def work(_, item):
        if item == 0:
            return others.wait(10.0)
        if item == last:
            others.set()
        return True

    with Crew([nullcontext(), nullcontext()]) as crew:
        assert [done for _, done in crew.each(work, list(range(last + 1)))] == [True] * (last + 1)


def test_items_are_made_a_few_ahead():
    made = []

    def items():
        for item in range(100):
            made.append(item)
            yield item

    with Crew([nullcontext(), nullcontext()]) as crew:
        found = crew.each(lambda _, item: item, items())
        assert [next(found)[1] for _ in range(3)] == [0, 1, 2]
        assert len(made) < 10
