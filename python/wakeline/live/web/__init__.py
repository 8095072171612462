"""The screen: a radar display in the browser, and the server behind it."""

from .server import WebApp, WebServer, serve

__all__ = ["WebApp", "WebServer", "serve"]
