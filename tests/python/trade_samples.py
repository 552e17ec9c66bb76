"""A tiny scene to trade, and what a run of it returns."""

TINY = """
format = 1
name = "tiny"
bodies.block.geometry = { kind = "bowl", half_width = 0.5, bottom = 0.0, rise = 0.2, top = 0.8 }
bodies.block.mesh = { order = [2, 2, 2], elements = [2, 2, 1] }
contacts.floor = { slave = "block.w0", plane = { normal = [0, 0, 1] }, friction = 0.3 }
supports.top = { face = "block.w1" }
stages = [{ name = "press", steps = 2, motions.top.translate = [0, 0, -0.2] },
          { name = "drag", steps = 2, motions.top.translate = [0.05, 0, 0] }]
"""


def numbers(force=((1.0, 0.0, 0.0),) * 4, cpu=1.0, **more):
    """What a run returns, of the tiny scene's four load steps."""
    return {
        "time": [0.5, 1.0, 1.5, 2.0],
        "force": [[list(f) for f in force]],
        "moment": [[[0.0, 0.0, 0.0]] * 4],
        "displacement": [[[0.0, 0.0, -0.1], [0.0, 0.0, -0.2], [0.0, 0.0, -0.4], [0.0, 0.0, -0.3]]],
        "area": [[0.1, 0.2, 0.2, 0.3]],
        "pressure": [1.0, 3.0],
        "traction": [0.0, 0.0],
        "cells": [0.25, 0.75],
        "gap": [0.001],
        "counts": [2],
        "images": 1,
        "unknowns": 27.0,
        "solves": 4.0,
        "cuts": 0.0,
        "phases": [0.0] * 5,
        "cpu_seconds": cpu,
    } | more
