"""The live view: a world watched in the browser while it runs."""

from bioscope.live.server import serve

__all__ = ["serve"]
