"""The live view inside a notebook, and for worlds made by a program."""

from __future__ import annotations

import contextlib
import threading
import time
from typing import TYPE_CHECKING, Any

from bioscope.errors import BioscopeError, MissingExtraError
from bioscope.live import messages
from bioscope.live.door import PAGE
from bioscope.live.feed import Feed
from bioscope.live.inspection import inspection
from bioscope.live.messages import encode
from bioscope.live.server import INSPECTIONS_PER_SECOND, serve
from bioscope.live.session import Session

if TYPE_CHECKING:
    from bioscope.world import World


def show(world: World, *, height: int = 560) -> Any:
    """Show a world: as a widget inside a notebook, else in the browser until Ctrl-C.

    Raises
    ------
    MissingExtraError
        Inside a notebook without the extra `notebook`.
    """
    if not in_notebook():
        return serve(world)
    return widget(world, height=height)


def in_notebook() -> bool:
    """Whether this runs inside a notebook's kernel."""
    try:
        from IPython import get_ipython
    except ImportError:
        return False
    shell = get_ipython()
    return shell is not None and type(shell).__name__ != "TerminalInteractiveShell"


def widget(world: World, *, height: int = 560) -> Any:
    """Return an anywidget that shows the world live; needs no port."""
    try:
        import anywidget
        import traitlets
    except ImportError:
        raise MissingExtraError("world.show() in a notebook", "notebook") from None
    script = PAGE / "widget.js"
    if not script.is_file():
        raise BioscopeError("the page was not built: run `make setup` in the checkout")

    class LiveView(anywidget.AnyWidget):  # type: ignore[misc]
        """A world, live, in a notebook's cell."""

        _esm = script.read_text(encoding="utf-8")
        height = traitlets.Int(560).tag(sync=True)

    view = LiveView(height=height)
    view.watch = Watch(world, view)
    return view


class Watch:
    """Carries the stream between a session and a widget."""

    def __init__(self, world: World, view: Any) -> None:
        self._view = view
        self._feed = Feed()
        self._joined = False
        self._lock = threading.RLock()
        self.session = Session(world, world.seed, self._from_session)
        view.on_msg(self._from_page)
        self.session.start()
        threading.Thread(target=self._inspect, daemon=True).start()

    def close(self) -> None:
        """Stop the world."""
        self.session.close()

    def _send(self, *parts: bytes) -> None:
        with self._lock:
            self._view.send({}, buffers=list(parts))

    def _from_session(self, message: bytes | None) -> None:
        with self._lock:
            if not self._joined:
                return
            parts = self._feed.due(self.session.snapshot) if message is None else [message]
            if parts:
                self._send(*parts)

    def _from_page(self, _view: Any, content: Any, _buffers: Any) -> None:
        import msgspec

        try:
            command = messages.decode(msgspec.json.encode(content))
        except BioscopeError as error:
            self._send(encode("notice", level="error", text=str(error)))
            return
        match command:
            case messages.Join():
                self._join()
            case messages.Seen():
                self._feed.seen()
            case messages.Select():
                self._feed.select(command)
            case messages.Inspected():
                self._feed.inspecting = False
            case messages.Annotations(on=on):
                self._feed.annotations = on
                self.session.annotations = int(on)
            case _:
                self.session.command(command, self._send)

    def _join(self) -> None:
        """Greet the page before the session's thread can send it anything else."""
        with self._lock:
            self._feed, self._joined = Feed(), True
            session = self.session
            self._send(*session.greeting(), *self._feed.due(session.snapshot))

    def _inspect(self) -> None:
        while not self.session.closed:
            time.sleep(1 / INSPECTIONS_PER_SECOND)
            feed = self._feed
            if not feed.selected.id or feed.inspecting:
                continue
            selected = feed.selected
            with contextlib.suppress(BioscopeError):
                message = inspection(self.session.world, selected)
                if selected is feed.selected:
                    feed.inspecting = True
                    self._send(message)
