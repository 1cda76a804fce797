"""Senses that can be used alone: look at a scene through an eye."""

from bioscope.senses.eye import View, look, look_many

__all__ = ["View", "look", "look_many"]
