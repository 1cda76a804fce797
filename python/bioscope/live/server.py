"""The server of the live view: the page, and its WebSocket."""

from __future__ import annotations

import asyncio
import contextlib
from typing import TYPE_CHECKING, Any

from bioscope.errors import BioscopeError, FormatError
from bioscope.live import messages
from bioscope.live.door import (
    MALFORMED,
    REFUSED,
    Door,
    page_file,
    received,
    refusal,
    same_origin,
)
from bioscope.live.feed import Feed
from bioscope.live.inspection import inspection
from bioscope.live.messages import bundle, encode
from bioscope.live.session import Session

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from starlette.applications import Starlette
    from starlette.requests import Request
    from starlette.responses import Response
    from starlette.websockets import WebSocket

    from bioscope.world import World

INSPECTIONS_PER_SECOND = 10
_MESSAGES_QUEUED = 256
_JOIN_WITHIN = 10.0


class Client:
    """One page: its own camera and selection; slow ones miss frames, and nobody waits for them."""

    def __init__(self, socket_: WebSocket) -> None:
        self.socket = socket_
        self.wake = asyncio.Event()
        self.messages: asyncio.Queue[bytes] = asyncio.Queue(_MESSAGES_QUEUED)
        self.feed = Feed()
        self.steered = 0
        """Whom the page steers; 0 for nobody."""

    def tell(self, message: bytes) -> None:
        """Queue a message; drop the oldest if the page does not keep up."""
        if self.messages.full():
            self.messages.get_nowait()
        self.messages.put_nowait(message)
        self.wake.set()


class Live:
    """A session and the pages that watch it."""

    def __init__(self, world: World | str, seed: int, token: str | None = None) -> None:
        self._loop: asyncio.AbstractEventLoop | None = None
        self.clients: set[Client] = set()
        self.token = token
        self.session = Session(world, seed, self._from_session)

    def _from_session(self, message: bytes | None) -> None:
        """Pass on what the session publishes, from its thread to the server's."""
        loop = self._loop
        if loop is not None and not loop.is_closed():
            with contextlib.suppress(RuntimeError):
                loop.call_soon_threadsafe(self._to_all, message)

    def _to_all(self, message: bytes | None) -> None:
        for client in self.clients:
            if message is None:
                client.wake.set()
            else:
                client.tell(message)

    def app(self, hosts: Iterable[str] | None) -> Starlette:
        """Return the web application; `hosts` are the names it answers to, none for any."""
        from starlette.applications import Starlette
        from starlette.routing import Route, WebSocketRoute

        allowed = None if hosts is None else set(hosts)

        def page(request: Request) -> Response:
            return page_file(request, request.url.path.strip("/") or "index.html", allowed)

        async def stream(websocket: WebSocket) -> None:
            await self._serve(websocket, allowed)

        @contextlib.asynccontextmanager
        async def lifespan(_: Starlette) -> Any:
            self._loop = asyncio.get_running_loop()
            self.session.start()
            yield
            self.session.close()

        files = [Route(path, page) for path in ("/", "/index.html", "/widget.js")]
        return Starlette(routes=[*files, WebSocketRoute("/stream", stream)], lifespan=lifespan)

    # One page's connection.

    async def _serve(self, websocket: WebSocket, allowed: set[str] | None) -> None:
        if not same_origin(websocket, allowed):
            await websocket.close(REFUSED)
            return
        await websocket.accept()
        client = Client(websocket)
        try:
            if not await self._joined(client):
                return
            self.clients.add(client)
            tasks = [
                asyncio.ensure_future(job)
                for job in (self._receive(client), self._send(client), self._inspect(client))
            ]
            _, pending = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
            for task in pending:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)
        finally:
            self.clients.discard(client)
            self._count_annotations()
            if client.steered:
                # Nobody is left to steer it.
                self.session.command(messages.Steer(client.steered, None), lambda _: None)
            with contextlib.suppress(Exception):
                await websocket.close()

    async def _joined(self, client: Client) -> bool:
        """Wait for a fitting `join` as the first message."""
        command: object = None
        try:
            text = await asyncio.wait_for(received(client.socket), _JOIN_WITHIN)
            command = messages.decode(text)
        except (FormatError, TimeoutError) as error:
            await self._refuse(client, MALFORMED, f"expected join first: {error}")
            return False
        except ConnectionError:
            return False
        if not isinstance(command, messages.Join):
            await self._refuse(client, MALFORMED, "expected join first")
            return False
        refused = refusal(self.token, command.token, command.version)
        if refused is not None:
            await self._refuse(client, *refused)
            return False
        for message in self.session.greeting():
            client.tell(message)
        return True

    async def _refuse(self, client: Client, code: int, text: str) -> None:
        with contextlib.suppress(Exception):
            await client.socket.send_bytes(encode("notice", level="error", text=text))
            await client.socket.close(code)

    async def _receive(self, client: Client) -> None:
        loop = asyncio.get_running_loop()

        def answer(message: bytes) -> None:
            with contextlib.suppress(RuntimeError):
                loop.call_soon_threadsafe(client.tell, message)

        while True:
            try:
                command = messages.decode(await received(client.socket))
            except ConnectionError:
                return
            except FormatError as error:
                await self._refuse(client, MALFORMED, str(error))
                return
            match command:
                case messages.Join():
                    pass
                case messages.Seen():
                    client.feed.seen()
                    client.wake.set()
                case messages.Select():
                    client.feed.select(command)
                case messages.Inspected():
                    client.feed.inspecting = False
                case messages.Steer(id=steered, steering=steering):
                    client.steered = 0 if steering is None else steered
                    self.session.command(command, answer)
                case messages.Annotations(on=on):
                    client.feed.annotations = on
                    self._count_annotations()
                case _:
                    self.session.command(command, answer)

    def _count_annotations(self) -> None:
        self.session.annotations = sum(client.feed.annotations for client in self.clients)

    async def _send(self, client: Client) -> None:
        while True:
            await client.wake.wait()
            client.wake.clear()
            while not client.messages.empty():
                await client.socket.send_bytes(client.messages.get_nowait())
            due = client.feed.due(self.session.snapshot)
            if due:
                await client.socket.send_bytes(bundle(due))

    async def _inspect(self, client: Client) -> None:
        loop = asyncio.get_running_loop()
        while True:
            await asyncio.sleep(1 / INSPECTIONS_PER_SECOND)
            feed = client.feed
            if not feed.selected.id or feed.inspecting:
                continue
            world, selected = self.session.world, feed.selected
            with contextlib.suppress(BioscopeError):
                message = await loop.run_in_executor(None, inspection, world, selected)
                if selected is feed.selected:
                    feed.inspecting = True
                    client.tell(message)


def serve(
    world: World | str,
    *,
    seed: int = 0,
    host: str = "127.0.0.1",
    port: int = 8765,
    token: str | None = None,
    open_browser: bool = True,
    say: Callable[..., None] = print,
) -> None:
    """Serve the live view until interrupted.

    Parameters
    ----------
    world, seed
        A world, or the name or path of one and its seed.
    host, port, token
        Where to listen; a port in use gives way to the next free one. Addresses beyond this machine
        need a token, which pages must know.
    open_browser
        Whether to open the page.
    say
        Called with messages.

    Raises
    ------
    InvalidValueError
        For an address beyond this machine without a token, or one that cannot be listened at.
    """
    door = Door(host, port, token, say)
    live = Live(world, seed, token)
    say(f"{live.session.world.title}: seed {live.session.world.seed}")
    say(f"live at {door.address}  (Ctrl-C ends it)")
    door.serve(live.app(door.hosts), messages.LARGEST_MESSAGE, open_browser=open_browser)
