"""Descriptions of tunable numbers."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Parameter:
    """One tunable number: described once, in the engine, with its present value."""

    owner: str
    """Population, field or `environment`."""
    name: str
    """Name as typed."""
    unit: str
    """`m`, `m/s`, `BL` (body lengths), `1` for a pure number."""
    minimum: float
    """Least admissible value."""
    maximum: float
    """Greatest admissible value."""
    default: float
    """Value if nothing is said."""
    meaning: str
    """What it does."""
    source: str
    """Where the default comes from."""
    value: float
    """Present value."""
