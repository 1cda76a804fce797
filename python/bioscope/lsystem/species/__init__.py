"""A species of one's own: a folder to begin with, and how well its plant meets photographs.

docs/guides/new-species.md goes through it step by step.
"""

from bioscope.lsystem.species.comparison import Match, compare, sheet
from bioscope.lsystem.species.silhouette import overlap, silhouette_of_picture, silhouette_of_plant
from bioscope.lsystem.species.template import begin

__all__ = [
    "Match",
    "begin",
    "compare",
    "overlap",
    "sheet",
    "silhouette_of_picture",
    "silhouette_of_plant",
]
