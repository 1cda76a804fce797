"""The door of the room: which writer for which file."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from bioscope.errors import InvalidValueError
from bioscope.export.take import Take

if TYPE_CHECKING:
    from os import PathLike

    from bioscope.world import World

Say = Callable[[str], object]

PROFILES = {
    "default": "What the format's own tools read: usdview, Houdini, Omniverse, three.js.",
    "unity": "For importers that read neither PointInstancers nor sampled points: one prim each.",
}
"""What can be asked for besides the suffix, and for whom it is."""


def export_world(
    world: World,
    path: str | PathLike[str],
    seconds: float,
    frames_per_second: float = 24.0,
    *,
    say: Say = print,
    profile: str | None = None,
) -> None:
    """Let a world run for `seconds` and write all that can be seen of it to a file.

    Parameters
    ----------
    world
        What to export; it is `seconds` older afterwards.
    path
        A name that ends in .usdc, .usda or .glb. USD files have their pictures beside them in
        NAME_textures, and takes of more than ten seconds their samples in NAME_clips; whole or
        not there.
    seconds, frames_per_second
        Length of the take, and how often it is sampled.
    say
        Called with one-line notices, such as what a format cannot hold.
    profile
        One of `PROFILES`; `default` if not given.

    Raises
    ------
    InvalidValueError
        For another suffix, profile, length or rate.
    MissingExtraError
        For USD without the extra `usd`.
    LimitError
        If a .glb would become too large.
    OSError
        If the folder does not exist or the disk is full.
    """
    target = Path(path)
    if profile is not None and profile not in PROFILES:
        known = ", ".join(PROFILES)
        raise InvalidValueError(f"profile = {profile}: expected one of {known}")
    take = Take(world, seconds, frames_per_second)
    suffix = target.suffix.lower()
    if suffix == ".glb":
        from bioscope.export.gltf.writer import write_glb

        write_glb(take, target, say)
    elif suffix in (".usdc", ".usda"):
        from bioscope.export.usd.writer import write_usd

        write_usd(take, target, say, profile or "default")
    else:
        raise InvalidValueError(f"{target}: expected a name that ends in .usdc, .usda or .glb")
    say(f"{target}: {take.frame_count} frames, {seconds:g} s")
