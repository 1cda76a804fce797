"""Definition files of behavioral L-systems (.lm), as models in the notation of our own.

H. Noser, "A Behavioral Animation System Based on L-systems and Synthetic Sensors for Actors", EPFL
thesis 1609 (1997), appendices A to C: timed symbols with an age, three parameters and three growth
expressions in postfix notation, productions with terminal ages, conditions, one symbol of context
on either side and alternatives with probabilities.

What stands for actors, particles, sounds, cameras and memories is read, and refused where a rule
depends on it; a symbol of that kind that is only placed means nothing to the turtle.
"""

from bioscope.lsystem.definition.grammar import Definition, read
from bioscope.lsystem.definition.translation import translated

__all__ = ["Definition", "read", "translated"]
