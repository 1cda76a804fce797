"""The world: advances time, holds what lives in it, lets itself be watched."""

from bioscope.world.environment import Environment
from bioscope.world.events import Event, EventLog
from bioscope.world.field import Current, Field
from bioscope.world.parameter import Parameter
from bioscope.world.population import Population
from bioscope.world.world import World

__all__ = [
    "Current",
    "Environment",
    "Event",
    "EventLog",
    "Field",
    "Parameter",
    "Population",
    "World",
]
