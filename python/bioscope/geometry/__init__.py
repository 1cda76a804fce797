"""Geometry of what is published: transforms, bent meshes, simple shapes."""
