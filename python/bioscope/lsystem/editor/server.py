"""The server of the editor: the page, and its WebSocket."""

from __future__ import annotations

import asyncio
import contextlib
from typing import TYPE_CHECKING

from bioscope import _engine, environments
from bioscope.errors import BioscopeError, FormatError
from bioscope.live.door import (
    MALFORMED,
    REFUSED,
    Door,
    page_file,
    received,
    refusal,
    same_origin,
)
from bioscope.live.messages import Join, encode
from bioscope.lsystem.editor import messages
from bioscope.lsystem.editor.document import Document
from bioscope.lsystem.editor.growing import MOST_MODULES, STRING_SHOWN
from bioscope.lsystem.editor.workshop import Workshop
from bioscope.lsystem.specimen import palette_beside

if TYPE_CHECKING:
    from collections.abc import Callable

    from starlette.applications import Starlette
    from starlette.requests import Request
    from starlette.responses import Response
    from starlette.websockets import WebSocket

_JOIN_WITHIN = 10.0
_MOST_PAGES = 8
TOO_MANY = 1013
"""Code with which a page is asked to try again later, because many are open."""


class Editor:
    """A document and the pages that edit it."""

    def __init__(self, document: Document, token: str | None, hosts: set[str] | None) -> None:
        self.document = document
        self.token = token
        self.hosts = hosts
        self._pages = 0

    def app(self) -> Starlette:
        """Return the web application."""
        from starlette.applications import Starlette
        from starlette.routing import Route, WebSocketRoute

        def page(request: Request) -> Response:
            return page_file(request, "editor.html", self.hosts)

        files = [Route(path, page) for path in ("/", "/index.html")]
        return Starlette(routes=[*files, WebSocketRoute("/stream", self._serve)])

    async def _serve(self, websocket: WebSocket) -> None:
        if not same_origin(websocket, self.hosts):
            await websocket.close(REFUSED)
            return
        await websocket.accept()
        if self._pages >= _MOST_PAGES:
            await websocket.close(TOO_MANY, "Close another page of this editor first.")
            return
        self._pages += 1
        try:
            if await self._joined(websocket):
                await Page(websocket, self.document).run()
        finally:
            self._pages -= 1
            with contextlib.suppress(Exception):
                await websocket.close()

    async def _joined(self, websocket: WebSocket) -> bool:
        """Wait for a fitting `join` as the first message."""
        try:
            command = messages.decode(await asyncio.wait_for(received(websocket), _JOIN_WITHIN))
        except (FormatError, TimeoutError, ConnectionError):
            command = None
        if not isinstance(command, Join):
            refused: tuple[int, str] | None = (MALFORMED, "expected join first")
        else:
            refused = refusal(self.token, command.token, command.version)
        if refused is not None:
            with contextlib.suppress(Exception):
                await websocket.close(*refused)
        return refused is None


class Page:
    """One page that edits: it has its own text, saved or not."""

    def __init__(self, websocket: WebSocket, document: Document) -> None:
        self._websocket = websocket
        self._document = document
        self._saved = document.read()
        self._workshop = Workshop(str(document.path), palette_beside(document.path))
        self._outgoing: asyncio.Queue[bytes] = asyncio.Queue(4)

    async def run(self) -> None:
        """Answer until the page goes."""
        await self._outgoing.put(self._hello())
        jobs = (self._receive(), self._send(), self._grow())
        tasks = [asyncio.ensure_future(job) for job in jobs]
        _, pending = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        for task in pending:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)

    def _hello(self) -> bytes:
        return encode(
            "hello",
            version=_engine.VERSION,
            file=self._document.title,
            savable=self._document.savable,
            text=self._saved,
            environments=environments.names(),
            most_modules=MOST_MODULES,
            most_letters=STRING_SHOWN,
        )

    async def _receive(self) -> None:
        while True:
            try:
                command = messages.decode(await received(self._websocket))
            except ConnectionError:
                return
            except FormatError as error:
                await self._websocket.close(MALFORMED, str(error)[:100])
                return
            match command:
                case messages.Grow():
                    self._workshop.ask(command)
                case messages.Save(text=text):
                    await self._outgoing.put(self._save(text))
                case Join():
                    pass

    def _save(self, text: str) -> bytes:
        try:
            self._document.save(text, self._saved)
        except (BioscopeError, OSError) as error:
            return encode("notice", level="error", text=f"Not saved: {error}")
        self._saved = text
        return encode("saved", text=text)

    async def _send(self) -> None:
        while True:
            await self._websocket.send_bytes(await self._outgoing.get())

    async def _grow(self) -> None:
        async with contextlib.aclosing(self._workshop.answers()) as answers:
            async for answer in answers:
                await self._outgoing.put(answer)


def edit(
    name: str | None = None,
    *,
    host: str = "127.0.0.1",
    port: int = 8766,
    token: str | None = None,
    open_browser: bool = True,
    say: Callable[..., None] = print,
) -> None:
    """Serve a page that edits an L-system beside its plant, until interrupted.

    Parameters
    ----------
    name
        See `document.Document`.
    host, port, token, say
        See `bioscope.live.door.Door`.
    open_browser
        Whether to open the page.

    Raises
    ------
    InvalidValueError
        If there is no such model, or the address cannot be served.
    """
    document = Document(name)
    door = Door(host, port, token, say)
    say(f"editing {document.path if document.savable else document.title}")
    say(f"editor at {door.address}  (Ctrl-C ends it)")
    app = Editor(document, token, door.hosts).app()
    door.serve(app, messages.LARGEST_MESSAGE, open_browser=open_browser)
