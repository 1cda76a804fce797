"""Fishing: a line with a baited hook."""

from __future__ import annotations

from bioscope.populations.native import Asked


class FishingLine(Asked):
    """A line with a baited hook that is lowered into the water and hauled when something bites.

    The bait is food for whoever knows its species as food. The first to take it hangs on the hook
    by its mouth (event `hooked`: the fish, the hook), struggles, is hauled, and is gone when it
    comes out of the water (event `caught`). After X. Tu, "Artificial animals for computer
    animation", 1996, section 8.2.

    Parameters
    ----------
    place
        x and z at which it is lowered, metres.
    bait
        Species of its bait in the scene; `bait` if not given.
    **parameters
        `start`, `depth`, `sinking`, `hauling`, `thickness`; see `World.parameters`.
    """

    def __init__(
        self,
        place: tuple[float, float] = (0.0, 0.0),
        *,
        bait: str = "bait",
        **parameters: float,
    ) -> None:
        super().__init__("fishing_line", {"place": place, "bait": bait}, parameters)
