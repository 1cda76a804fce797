"""Film: a world seen through cameras, with the sound of the place, in a file."""

from bioscope.film.film import film_world
from bioscope.film.options import FilmOptions, parse_size
from bioscope.film.still import take_still

__all__ = ["FilmOptions", "film_world", "parse_size", "take_still"]
