"""Who may come in, and where: what all servers of pages share."""

from __future__ import annotations

import errno
import hmac
import ipaddress
import socket
import threading
import webbrowser
from pathlib import Path
from typing import TYPE_CHECKING
from urllib.parse import quote, urlsplit

from bioscope import _engine
from bioscope.errors import InvalidValueError

if TYPE_CHECKING:
    from collections.abc import Callable

    from starlette.applications import Starlette
    from starlette.requests import Request
    from starlette.responses import Response
    from starlette.websockets import WebSocket

PAGE = Path(__file__).parent / "page"
_PORTS_TO_TRY = 50
REFUSED, MALFORMED, OTHER_VERSION = 4001, 4000, 4002
"""Codes with which a page's connection is closed."""


def page_file(request: Request, name: str, allowed: set[str] | None) -> Response:
    """Answer with a built file of the page; `allowed` are the host names answered to."""
    from starlette.responses import PlainTextResponse
    from starlette.responses import Response as Answer

    if allowed is not None and request.url.hostname not in allowed:
        return PlainTextResponse("unknown host", 421)
    path = PAGE / name
    if not path.is_file():
        text = "The page was not built: run `make setup` in the checkout, or install the wheel."
        return PlainTextResponse(text, 503)
    kind = "text/html; charset=utf-8" if name.endswith(".html") else "text/javascript"
    headers = {"Cache-Control": "no-cache", "X-Content-Type-Options": "nosniff"}
    return Answer(path.read_bytes(), media_type=kind, headers=headers)


def same_origin(websocket: WebSocket, allowed: set[str] | None) -> bool:
    """Whether the page came from this server; programs that are no browsers send no origin."""
    host = websocket.headers.get("host", "")
    if allowed is not None and urlsplit(f"//{host}").hostname not in allowed:
        return False
    origin = websocket.headers.get("origin")
    return origin is None or urlsplit(origin).netloc == host


def refusal(token: str | None, given: str | None, version: str) -> tuple[int, str] | None:
    """Return code and reason why a page may not join; none if it may."""
    if token is not None and not hmac.compare_digest((given or "").encode(), token.encode()):
        return REFUSED, "This world asks for a token: add ?token=… to the address."
    if version != _engine.VERSION:
        text = f"The page is of version {version}, the world of {_engine.VERSION}: reload."
        return OTHER_VERSION, text
    return None


async def received(websocket: WebSocket) -> str | bytes:
    """Return the next message; raise `ConnectionError` when the page has gone."""
    message = await websocket.receive()
    if message["type"] != "websocket.receive":
        raise ConnectionError
    text: str | bytes = message.get("text") or message.get("bytes") or ""
    return text


def is_loopback(host: str) -> bool:
    """Whether an address can be reached from this machine only."""
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def listening(host: str, port: int, say: Callable[..., None]) -> socket.socket:
    """Return a socket that listens at the port, or at the next free one.

    Raises
    ------
    InvalidValueError
        If the address cannot be listened at.
    """
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    for candidate in range(port, min(port + _PORTS_TO_TRY, 65536)):
        listener = socket.socket(family, socket.SOCK_STREAM)
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            listener.bind((host, candidate))
            listener.listen()
        except OSError as error:
            listener.close()
            if error.errno == errno.EADDRINUSE:
                continue
            raise InvalidValueError(f"--host {host} --port {candidate}: {error.strerror}") from None
        if candidate != port:
            say(f"port {port} is in use: took {candidate}")
        return listener
    raise InvalidValueError(f"--port {port}: this and the next {_PORTS_TO_TRY - 1} are in use")


class Door:
    """An open address, and the names under which it answers.

    Parameters
    ----------
    host, port, token
        Where to listen; a port in use gives way to the next free one. Addresses beyond this machine
        need a token, which pages must know.
    say
        Called with messages.

    Raises
    ------
    InvalidValueError
        For an address beyond this machine without a token, or one that cannot be listened at.
    """

    def __init__(self, host: str, port: int, token: str | None, say: Callable[..., None]) -> None:
        if not is_loopback(host) and not token:
            raise InvalidValueError(f"--host {host}: expected --token too, for others can reach it")
        self.hosts = {host, "localhost", "127.0.0.1", "::1"} if is_loopback(host) else None
        """The host names that are answered to; none for any."""
        self._listener = listening(host, port, say)
        shown = f"[{host}]" if ":" in host else host
        self.address = f"http://{shown}:{self._listener.getsockname()[1]}/"
        if token:
            self.address += f"?token={quote(token)}"

    def serve(self, app: Starlette, largest_message: int, *, open_browser: bool) -> None:
        """Serve an application until interrupted; messages of pages are bounded, in bytes."""
        import uvicorn

        config = uvicorn.Config(
            app,
            log_level="warning",
            ws_max_size=largest_message,
            ws_per_message_deflate=False,
            timeout_graceful_shutdown=1,
        )
        if open_browser:
            threading.Timer(0.5, webbrowser.open, [self.address]).start()
        uvicorn.Server(config).run(sockets=[self._listener])
