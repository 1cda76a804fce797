"""What one page is sent: only what it lacks, and no more frames than it can draw."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bioscope.live.messages import Select

if TYPE_CHECKING:
    from bioscope.live.session import Snapshot

FRAMES_UNDER_WAY = 2


class Feed:
    """Keeps account of what a page has."""

    def __init__(self) -> None:
        self.annotations = False
        self.selected = Select(0)
        """Whom the page inspects."""
        self.inspecting = False
        """Whether an inspection is under way that the page has not shown yet."""
        self._known: set[int] = set()
        self._revision = -1
        self._number = -1
        self._under_way = 0

    def select(self, selected: Select) -> None:
        """Note whom the page inspects from now on."""
        self.selected, self.inspecting = selected, False

    def seen(self) -> None:
        """Note that the page has drawn a frame."""
        self._under_way = max(0, self._under_way - 1)

    def due(self, now: Snapshot) -> list[bytes]:
        """Return the messages that bring the page up to date; none while it is busy or has all."""
        if now.number == self._number or self._under_way >= FRAMES_UNDER_WAY:
            return []
        messages = []
        if now.revision != self._revision or not self._known.issuperset(now.assets):
            messages += [asset for key, asset in now.assets.items() if key not in self._known]
            messages.append(now.layout)
            self._known, self._revision = set(now.assets), now.revision
        self._number = now.number
        self._under_way += 1
        messages.append(now.annotated if self.annotations else now.frame)
        return messages
