"""Boxes around what was drawn between two marks `D`, as definitions of their own."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from bioscope.lsystem.animation.animation import Animation
    from bioscope.lsystem.animation.vectors import Vector


def capture(animation: Animation) -> None:
    """Make a definition of one cube around what was drawn since the first mark."""
    bounds = animation.frame.bounds(animation.captured or 0)
    if animation.captured is None or bounds is None:
        animation.remark("'D' 21 without a 'D' 20 before it, or with nothing drawn between them")
        return
    text = boxed(*bounds)
    animation.frame.proxies.append(text)
    number = len(animation.frame.proxies)
    animation.produced[f"box{number}.{animation.frame.number:04d}.lm"] = text
    animation.captured = None


def boxed(low: Vector, high: Vector) -> str:
    """Return a definition of one cube with these corners."""
    middle = [(a + b) / 2 for a, b in zip(low, high, strict=True)]
    size = [b - a for a, b in zip(low, high, strict=True)]
    start = low[0], middle[1], middle[2]
    move = " ".join(f"({_postfix(one)})" for one in start)
    cube = " ".join(f"({_postfix(one)})" for one in size)
    return f"Axiom\nf () () () (2) {move}\nc () () () () {cube}\nProductions\nEndProductions\n"


def _postfix(number: float) -> str:
    """Return a number as an expression, which has neither sign nor exponent."""
    text = f"{abs(number):.17f}".rstrip("0").rstrip(".")
    return f"{text}_" if number < 0 else text
