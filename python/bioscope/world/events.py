"""What happened in a world."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

from bioscope.errors import MissingExtraError

if TYPE_CHECKING:
    from collections.abc import Iterable

    import pyarrow


@dataclass(frozen=True, slots=True)
class Event:
    """Something that happened: a birth, a bite, a start of fright."""

    tick: int
    """Tick in which it happened."""
    time: float
    """World time in seconds."""
    kind: str
    """One word: `startled`, `born`, `dashed`."""
    subject: int
    """Id of the individual it happened to."""
    object: int | None
    """Id of the other individual involved, if any."""
    data: dict[str, Any]
    """Further figures, units in the names."""

    def as_dict(self) -> dict[str, Any]:
        """Return the event as a dict, as event files hold it."""
        return asdict(self)


class EventLog(list[Event]):
    """The events so far, oldest first."""

    def table(self) -> pyarrow.Table:
        """Return the events as an Arrow table; `data` is a column of JSON texts.

        Raises
        ------
        MissingExtraError
            Without the extra `data`.
        """
        return table(self)


def table(events: Iterable[Event]) -> pyarrow.Table:
    """Return events as an Arrow table with units in the schema; `data` holds JSON texts."""
    try:
        import pyarrow
    except ImportError:
        raise MissingExtraError("A table of events", "data") from None
    import msgspec

    schema = pyarrow.schema(
        [
            pyarrow.field("tick", pyarrow.uint64()),
            pyarrow.field("time", pyarrow.float64(), metadata={"unit": "s"}),
            pyarrow.field("kind", pyarrow.string()),
            pyarrow.field("subject", pyarrow.uint32()),
            pyarrow.field("object", pyarrow.uint32()),
            pyarrow.field("data", pyarrow.string()),
        ]
    )
    rows = [
        event.as_dict() | {"data": msgspec.json.encode(event.data).decode()} for event in events
    ]
    return pyarrow.Table.from_pylist(rows, schema=schema)
