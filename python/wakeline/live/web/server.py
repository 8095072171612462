"""The web server of a session: the page, its two streams, status, and the Signal K Radar API.

A page gets the picture as JSON and the echoes as octets, each over a separate WebSocket. Nothing
is queued for a client: it is sent what is newest when it has taken the last message, so that one
that has stopped reading costs one message and nobody else.
"""

from __future__ import annotations

import asyncio
import hmac
import ipaddress
import json
import math
import secrets
import threading
import time
from collections.abc import Awaitable, Callable, Mapping
from contextlib import suppress
from importlib import resources
from typing import Any
from urllib.parse import urlsplit

from wakeline import __version__

try:
    from aiohttp import WSMsgType, web
except ImportError as error:  # pragma: no cover
    raise ImportError(
        "the screen needs aiohttp: install the extra `live` (pip install 'wakeline[live]')"
    ) from error

from .echoes import EchoImage, EchoReader
from .scene import AIS_COLUMNS, TRACK_COLUMNS, Scene
from .signalk import SignalK

_KINDS = {
    ".html": "text/html",
    ".css": "text/css",
    ".js": "text/javascript",
    ".svg": "image/svg+xml",
}
_HEADERS = {
    "Content-Security-Policy": "default-src 'none'; script-src 'self'; style-src 'self'; "
    "img-src 'self' data:; connect-src 'self'; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cache-Control": "no-cache",
}
_COOKIE = "wakeline-token"
_MOST_OCTETS = 65536  # of anything that a client sends
_MOST_CLIENTS = 32
_MOST_WAITING = 1 << 18  # octets buffered for a client before a send waits
_PICTURE_S = 0.25
_LONGEST_PICTURE_S = 1.5  # between pictures of a busy session
_LATE_S, _VERSIONS_KEPT = 8.0, 200  # of commands after a picture; pictures
_BUSY_S = 2.5  # without a picture, after which a page hears that there will be one
_ECHO_S = 0.04
_ECHO_OCTETS_PER_S = 1.3e6
_ROWS_AT_ONCE = 256
_COMMAND_S = 0.02
_SILENT_S = 20.0

Handler = Callable[[web.Request], Awaitable[web.StreamResponse]]


class WebApp:
    """Serves a session on the running event loop.

    Parameters
    ----------
    session : object
        With ``picture() -> dict``, ``command(dict) -> dict``, ``sweeps`` (a list of callables for
        radar, azimuth_rad, heading_rad, range_m and cells), ``lock``, which is held in each call,
        and optionally ``status() -> dict`` and ``metrics() -> str``.
    host, port : str, int
        Port 0 takes a free one.
    token : str, optional
        Asked of every client; by default a new one for any address but this machine's, none there.

    Attributes
    ----------
    host, port : str, int
    token : str or None
    url : str
        Of the page, with the token.
    clients : int
        Streams that are open.
    octets_sent : int
        Of all streams, before compression.
    """

    def __init__(
        self,
        session: Any,
        host: str = "127.0.0.1",
        port: int = 8080,
        token: str | None = None,
    ) -> None:
        if not is_local(host) and token is None:
            token = secrets.token_urlsafe(16)
        self.host, self.port, self.token = host, port, token
        self.clients = 0
        self.octets_sent = 0
        self._session = session
        self._images: dict[str, EchoImage] = {}
        self._scene = Scene()
        self._signal_k = SignalK(self)
        self._changed = asyncio.Event()
        self._stopped = asyncio.Event()
        self._one_at_a_time = asyncio.Lock()
        self._taken_s = -math.inf
        self._taking: asyncio.Future[None] | None = None
        self._runner: web.AppRunner | None = None

    @property
    def url(self) -> str:
        """Of the page."""
        host = f"[{self.host}]" if ":" in self.host else self.host
        if host in ("0.0.0.0", "[::]"):
            host = "localhost"
        token = f"/?token={self.token}" if self.token else "/"
        return f"http://{host}:{self.port}{token}"

    async def start(self) -> None:
        """Listen.

        Raises
        ------
        OSError
            When the address cannot be used.
        """
        app = web.Application(middlewares=[self._guard], client_max_size=_MOST_OCTETS)
        app.add_routes(
            [
                web.get("/", self._page),
                web.get("/static/{name}", self._static),
                web.get("/status", self._status),
                web.get("/metrics", self._metrics),
                web.get("/picture", self._picture),
                web.get("/echoes", self._echoes),
                *self._signal_k.routes(),
            ]
        )
        self._runner = web.AppRunner(app, access_log=None, shutdown_timeout=1.0)
        await self._runner.setup()
        try:
            site = web.TCPSite(self._runner, self.host, self.port)
            await site.start()
        except OSError:
            await self._runner.cleanup()
            raise
        self.port = self._runner.addresses[0][1]
        self._session.sweeps.append(self._take_sweeps)
        await self.take_picture()
        self._taking = asyncio.ensure_future(self._take_pictures())

    async def close(self) -> None:
        """Disconnect all clients and stop."""
        with suppress(ValueError):
            self._session.sweeps.remove(self._take_sweeps)
        self._stopped.set()
        if self._taking is not None:
            self._taking.cancel()
        if self._runner is not None:
            await self._runner.cleanup()

    # The session ----------------------------------------------------------------------------------

    def _take_sweeps(
        self, radar: str, azimuth_rad: Any, heading_rad: float, range_m: float, cells: Any
    ) -> None:
        """On the session's thread."""
        image = self._images.get(radar)
        if image is None:
            image = self._images.setdefault(radar, EchoImage(len(self._images)))
        image(azimuth_rad, heading_rad, range_m, cells)

    async def _take_pictures(self) -> None:
        """Keep the scene up to date while somebody looks; a failing picture is shown as a note."""
        while True:
            began_s = time.monotonic()
            if self.clients or not self._scene.version:
                await self.take_picture()
            took_s = time.monotonic() - began_s
            await asyncio.sleep(min(max(_PICTURE_S, 5.0 * took_s), _LONGEST_PICTURE_S))

    async def take_picture(self) -> None:
        """Take the picture now, if the last one is not of this moment."""
        async with self._one_at_a_time:
            if time.monotonic() - self._taken_s < 0.5 * _PICTURE_S:
                return
            self._taken_s = time.monotonic()
            try:
                picture = await self._call(self._session.picture)
                picture["radars"] = self._with_range(picture.get("radars", ()))
                self._scene.take(picture)
                self._signal_k.take(picture)
            except Exception as error:  # noqa: BLE001 - the screen says it; tracking continues
                note = f"no picture: {type(error).__name__}: {error}"
                self._scene.take({"time_s": self._scene.time_s, "tracks": (), "note": note})
            self._changed.set()
            self._changed = asyncio.Event()

    def image_of(self, radar: str) -> EchoImage | None:
        """Echoes of a radar; None if it has given no video."""
        return self._images.get(radar)

    def _with_range(self, radars: Any) -> list[dict[str, Any]]:
        """Radars of the picture with what the page needs of their echoes."""
        shown = [dict(radar) for radar in radars]
        for name in self._images.keys() - {radar["name"] for radar in shown}:
            shown.append({"name": name})
        for radar in shown:
            image = self._images.get(radar["name"])
            if image is not None:
                radar["image"], radar["range_m"] = image.radar, image.range_m
        return shown

    async def _call(self, function: Callable[..., Any], *arguments: Any) -> Any:
        """Call the session, on a thread: it may be busy."""

        def locked() -> Any:
            with self._session.lock:
                return function(*arguments)

        return await asyncio.to_thread(locked)

    async def command(self, command: Mapping[str, Any]) -> dict[str, Any]:
        """The answer to a command; whatever a client sends, nothing is raised."""
        try:
            answer = await self._call(self._session.command, command)
        except Exception as error:  # noqa: BLE001
            answer = {"ok": False, "error": f"{type(error).__name__}: {error}"[:200]}
        self._taken_s = -math.inf
        await self.take_picture()
        return answer

    # Who may --------------------------------------------------------------------------------------

    @web.middleware
    async def _guard(self, request: web.Request, handler: Handler) -> web.StreamResponse:
        refusal = self._refusal(request)
        if refusal:
            return web.Response(status=403, text=refusal + "\n", headers=_HEADERS)
        try:
            response = await handler(request)
        except web.HTTPException as answer:
            answer.headers.update(_HEADERS)
            raise
        if not response.prepared:
            response.headers.update(_HEADERS)
            if self.token and request.query.get("token"):
                response.set_cookie(_COOKIE, self.token, httponly=True, samesite="Strict")
        return response

    def _refusal(self, request: web.Request) -> str:
        """Why a request is rejected; empty if it is not."""
        host = request.headers.get("Host", "")
        origin = request.headers.get("Origin")
        if origin is not None and urlsplit(origin).netloc != host:
            return "this page belongs to another site"
        if self.token is None:
            if not _names_this_machine(host):
                return "only this machine may look; start the server with a token for others"
            return ""
        given = (
            request.query.get("token")
            or request.cookies.get(_COOKIE)
            or request.headers.get("Authorization", "").removeprefix("Bearer ")
        )
        if not hmac.compare_digest(given.encode(errors="replace"), self.token.encode()):
            return "open the address with the token that the program has printed"
        return ""

    # Files and figures ----------------------------------------------------------------------------

    async def _page(self, request: web.Request) -> web.Response:
        if self.token and request.query.get("token"):
            return web.Response(status=303, headers={"Location": "/"})
        return _file("index.html")

    async def _static(self, request: web.Request) -> web.Response:
        return _file(request.match_info["name"])

    async def _status(self, request: web.Request) -> web.Response:
        status = {"version": __version__, "web": {"clients": self.clients}}
        if hasattr(self._session, "status"):
            status |= await self._call(self._session.status)
        return web.json_response(status)

    async def _metrics(self, request: web.Request) -> web.Response:
        lines = [
            "# TYPE wakeline_web_clients gauge",
            f"wakeline_web_clients {self.clients}",
            "# TYPE wakeline_web_sent_bytes_total counter",
            f"wakeline_web_sent_bytes_total {self.octets_sent}",
        ]
        text = "\n".join(lines) + "\n"
        if hasattr(self._session, "metrics"):
            text = await self._call(self._session.metrics) + text
        return web.Response(text=text, content_type="text/plain", charset="utf-8")

    # Streams --------------------------------------------------------------------------------------

    async def open_stream(
        self, request: web.Request, *, compress: bool = True
    ) -> web.WebSocketResponse:
        """A WebSocket, or 503 when there are too many."""
        if self.clients >= _MOST_CLIENTS:
            raise web.HTTPServiceUnavailable(text="too many clients\n")
        stream = web.WebSocketResponse(
            heartbeat=_SILENT_S, max_msg_size=_MOST_OCTETS, compress=compress, timeout=1.0
        )
        await stream.prepare(request)
        if request.transport is not None:
            request.transport.set_write_buffer_limits(high=_MOST_WAITING)
        return stream

    async def run_stream(
        self,
        stream: web.WebSocketResponse,
        send: Callable[[], Awaitable[None]],
        receive: Callable[[str], Awaitable[None]],
    ) -> None:
        """Send and receive until either side closes."""
        self.clients += 1
        sending = asyncio.ensure_future(send())
        stopping = asyncio.ensure_future(self._stopped.wait())
        receiving = asyncio.ensure_future(_receive(stream, receive))
        tasks = (sending, stopping, receiving)
        try:
            await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        finally:
            self.clients -= 1
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)
            if not stream.closed:
                with suppress(Exception):
                    await asyncio.wait_for(stream.close(), 1.0)

    async def _picture(self, request: web.Request) -> web.StreamResponse:
        stream = await self.open_stream(request)
        hello = {
            "type": "hello",
            "wakeline": __version__,
            "track_columns": TRACK_COLUMNS,
            "ais_columns": AIS_COLUMNS,
        }
        await stream.send_str(json.dumps(hello))

        sent_s: dict[int, float] = {}

        async def send() -> None:
            version = 0
            await self.take_picture()
            while True:
                changed = self._changed
                text, version = self._scene.message(version)
                self.octets_sent += len(text)
                await stream.send_str(text)
                sent_s[version] = time.monotonic()
                if len(sent_s) > _VERSIONS_KEPT:
                    del sent_s[next(iter(sent_s))]
                while not changed.is_set():
                    try:
                        await asyncio.wait_for(changed.wait(), _BUSY_S)
                    except asyncio.TimeoutError:
                        await stream.send_json({"type": "busy"})

        async def receive(text: str) -> None:
            answer, number = await self._answer(text, sent_s)
            await stream.send_json({"type": "answer", "number": number, **answer})
            await asyncio.sleep(_COMMAND_S)

        await self.run_stream(stream, send, receive)
        return stream

    async def _answer(self, text: str, sent_s: Mapping[int, float]) -> tuple[dict[str, Any], Any]:
        """Of a command that came too late after the picture that it is about, an error."""
        try:
            command = json.loads(text)
        except (ValueError, RecursionError):
            return {"ok": False, "error": "a command must be JSON"}, None
        if not isinstance(command, dict):
            return {"ok": False, "error": "a command must be an object"}, None
        number = command.pop("number", None)
        if not isinstance(number, int):
            number = None
        seen = command.pop("version", None)
        if isinstance(seen, int) and time.monotonic() - sent_s.get(seen, -math.inf) > _LATE_S:
            return {"ok": False, "error": "the command came too late, and is not done"}, number
        return await self.command(command), number

    async def _echoes(self, request: web.Request) -> web.StreamResponse:
        stream = await self.open_stream(request, compress=False)
        readers: dict[str, EchoReader] = {}

        async def send() -> None:
            credit = _ECHO_OCTETS_PER_S
            last_s = time.monotonic()
            while True:
                now_s = time.monotonic()
                credit = min(credit + (now_s - last_s) * _ECHO_OCTETS_PER_S, _ECHO_OCTETS_PER_S)
                last_s = now_s
                for name, image in list(self._images.items()):
                    reader = readers.setdefault(name, EchoReader(image, _ROWS_AT_ONCE))
                    while credit > 0.0 and (message := reader.next()):
                        credit -= len(message)
                        self.octets_sent += len(message)
                        await stream.send_bytes(message)
                gap = sum(reader.gap for reader in readers.values())
                if gap:
                    for reader in readers.values():
                        reader.gap = 0
                    await stream.send_json({"type": "gap", "rows": gap})
                await asyncio.sleep(_ECHO_S)

        async def receive(text: str) -> None:
            pass

        await self.run_stream(stream, send, receive)
        return stream


async def _receive(
    stream: web.WebSocketResponse, receive: Callable[[str], Awaitable[None]]
) -> None:
    async for message in stream:
        if message.type == WSMsgType.TEXT:
            await receive(message.data)


class WebServer:
    """Serves a session on a separate thread: a :class:`WebApp` with an event loop.

    Parameters
    ----------
    session : Session or Playback
        What :class:`WebApp` needs.
    host, port, token
        As there.

    Attributes
    ----------
    app : WebApp

    Raises
    ------
    OSError
        When the address cannot be used.
    """

    def __init__(
        self, session: Any, host: str = "127.0.0.1", port: int = 8080, token: str | None = None
    ) -> None:
        self.app = WebApp(session, host, port, token)
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(
            target=self._loop.run_forever, name="wakeline-web", daemon=True
        )
        self._thread.start()
        try:
            self._wait_for(self.app.start())
        except OSError:
            self._end()
            raise

    @property
    def url(self) -> str:
        """Of the page."""
        return self.app.url

    def close(self) -> None:
        """Disconnect all clients and stop."""
        if self._thread.is_alive():
            self._wait_for(self.app.close())
            self._end()

    def __enter__(self):
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _wait_for(self, work: Any) -> None:
        asyncio.run_coroutine_threadsafe(work, self._loop).result()

    def _end(self) -> None:
        self._wait_for(self._loop.shutdown_default_executor())
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join()
        self._loop.close()


def serve(
    session: Any, host: str = "127.0.0.1", port: int = 8080, token: str | None = None
) -> WebServer:
    """Serve a session: :class:`WebServer`."""
    return WebServer(session, host, port, token)


def is_local(host: str) -> bool:
    """Whether an address to listen on is this machine's alone."""
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"


def _names_this_machine(host: str) -> bool:
    """Whether the Host of a request does, so that a name that leads here by DNS does not."""
    with suppress(ValueError):
        return is_local(urlsplit(f"//{host}").hostname or "")
    return False


def _file(name: str) -> web.Response:
    folder = resources.files(__package__) / "static"
    if name in _names():
        kind = _KINDS["." + name.rsplit(".", 1)[1]]
        return web.Response(body=(folder / name).read_bytes(), content_type=kind, charset="utf-8")
    raise web.HTTPNotFound(text="no such file\n")


def _names() -> set[str]:
    folder = resources.files(__package__) / "static"
    return {one.name for one in folder.iterdir() if one.name.endswith(tuple(_KINDS))}
