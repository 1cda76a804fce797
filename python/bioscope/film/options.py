"""What a film is to be."""

from __future__ import annotations

import re

import msgspec

from bioscope.errors import InvalidValueError

RENDERERS = ("preview", "path")
_LARGEST_SIDE = 8192


class FilmOptions(msgspec.Struct, frozen=True, kw_only=True):
    """What a film is to be; see `bioscope film --help`."""

    seconds: float
    """Length of the film, which is world time."""
    size: tuple[int, int] = (1280, 720)
    """Width and height in pixels, both even."""
    frames_per_second: float = 30.0
    renderer: str = "preview"
    """`preview` (rasterizer) or `path` (path tracing)."""
    camera: str | None = None
    """A camera of the world; the world's own shot list if none."""
    samples: int = 64
    """Samples per pixel of the path tracer."""

    def __post_init__(self) -> None:
        if self.renderer not in RENDERERS:
            known = " or ".join(RENDERERS)
            raise InvalidValueError(f"renderer = {self.renderer}: expected {known}")
        if any(side % 2 or not 16 <= side <= _LARGEST_SIDE for side in self.size):
            width, height = self.size
            raise InvalidValueError(
                f"size = {width}x{height}: expected even numbers from 16 to {_LARGEST_SIDE}"
            )
        if not 1 <= self.frames_per_second <= 240:
            raise InvalidValueError(f"fps = {self.frames_per_second}: expected 1 to 240")
        if not 0 < self.seconds <= 24 * 3600:
            raise InvalidValueError(f"seconds = {self.seconds}: expected more than 0, up to a day")

    @property
    def frame_count(self) -> int:
        """Number of pictures."""
        return max(1, round(self.seconds * self.frames_per_second))


def parse_size(text: str) -> tuple[int, int]:
    """Return width and height from a text such as 1280x720.

    Raises
    ------
    InvalidValueError
        For anything else.
    """
    match = re.fullmatch(r"(\d{1,5})x(\d{1,5})", text)
    if not match:
        raise InvalidValueError(f"size = {text}: expected WIDTHxHEIGHT, such as 1280x720")
    return int(match[1]), int(match[2])
