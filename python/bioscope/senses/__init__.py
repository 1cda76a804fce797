"""Senses that can be used alone: look at a scene through an eye."""

from bioscope.senses.eye import View, eyes, identity_colors, look, look_many

__all__ = ["View", "eyes", "identity_colors", "look", "look_many"]
