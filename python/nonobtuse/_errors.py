"""The exceptions of the package. A file that cannot be read or written is an OSError."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ._results import Result


class InvalidInput(ValueError):
    """The input or an option cannot be used; the message is one sentence.

    ``element``: index (from 0) of the offending vertex or triangle; -1 where there is none.
    """

    def __init__(self, message: str, element: int = -1) -> None:
        super().__init__(message)
        self.element = element


class TooFewVertices(InvalidInput):
    """The topology of the surface needs more vertices than were asked for.

    ``least``: the least number that was reached (an upper bound of what is needed).
    """

    def __init__(self, message: str, least: int) -> None:
        super().__init__(message)
        self.least = least


class Cancelled(KeyboardInterrupt):
    """Ctrl-C during `remesh`: a KeyboardInterrupt that holds the best mesh so far.

    ``result``: its status is CANCELLED; it has no faces if there was no mesh yet.
    """

    def __init__(self, result: Result) -> None:
        super().__init__("remesh was interrupted; the best mesh so far is in .result")
        self.result = result
