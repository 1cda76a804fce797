"""The contour page: a mesh of deformable contours that locks to the outline of a pictured fish."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bioscope.live.door import Door, page_file

if TYPE_CHECKING:
    from collections.abc import Callable

    from starlette.requests import Request
    from starlette.responses import Response

_LARGEST_MESSAGE = 1024
"""Bytes; the page sends none."""


def serve(*, port: int = 8775, open_browser: bool = True, say: Callable[..., None] = print) -> None:
    """Serve the contour page to this machine until interrupted.

    Parameters
    ----------
    port
        Where to listen; a port in use gives way to the next free one.
    open_browser
        Whether to open the page in the browser.
    say
        Called with messages.
    """
    from starlette.applications import Starlette
    from starlette.routing import Route

    door = Door("127.0.0.1", port, None, say)

    def page(request: Request) -> Response:
        return page_file(request, "contour.html", door.hosts)

    say(f"contours at {door.address} (Ctrl+C ends)")
    app = Starlette(routes=[Route("/", page)])
    door.serve(app, _LARGEST_MESSAGE, open_browser=open_browser)
