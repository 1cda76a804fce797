"""The 27 named materials of the symbol `m` (thesis, appendix C).

The thesis prints the names and, for the ball, the numbers; the other colors are chosen here after
their names, those of the crystals after the minerals. Linear colors.
"""

from __future__ import annotations

from dataclasses import dataclass

from bioscope._engine import Material as Surface
from bioscope._engine import power

Color = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Material:
    """What a surface looks like."""

    name: str
    diffuse: Color
    """Linear."""
    ambient: Color
    """Linear; of the same hue, so that vision can tell it in shadow."""
    specular: float = 0.04
    """Share of light that is mirrored at right angles."""
    roughness: float = 0.8
    """0 is a mirror, 1 is matt."""
    lit: bool = True
    """Whether light falls on it; otherwise it shows its diffuse color as it is."""

    @property
    def written(self) -> tuple[int, int, int]:
        """Its color as definitions give it, 0 to 255: its diffuse color, or that of a stroke."""
        red, green, blue = (
            round(255 * min(1.0, max(0.0, _encoded(one) if self.name == STROKE else one)))
            for one in self.diffuse
        )
        return red, green, blue

    def surface(self) -> Surface:
        """Return it for a scene."""
        return Surface(
            self.name,
            color=self.diffuse,
            roughness=self.roughness,
            specular=self.specular if self.lit else 0.0,
            two_sided=True,
        )


STROKE = "stroke"
"""Name of the material of strokes."""


def stroke_material(color: Color) -> Material:
    """Return the material of strokes of a color as screens show it, 0 to 1 (sRGB)."""
    red, green, blue = (
        one / 12.92 if one <= 0.04045 else power((one + 0.055) / 1.055, 2.4) for one in color
    )
    return _named(STROKE, (red, green, blue))


def _encoded(linear: float) -> float:
    """Return a linear color as screens show it (sRGB)."""
    return linear * 12.92 if linear <= 0.0031308 else 1.055 * power(linear, 1 / 2.4) - 0.055


def _named(name: str, diffuse: Color, specular: float = 0.04, roughness: float = 0.8) -> Material:
    red, green, blue = diffuse
    return Material(name, diffuse, (red / 2, green / 2, blue / 2), specular, roughness)


def _crystal(name: str, diffuse: Color) -> Material:
    return _named(name, diffuse, 0.1, 0.15)


_NAMED = (
    _named("green", (0.05, 0.45, 0.05)),
    _named("brown", (0.2, 0.09, 0.03)),
    _named("blue", (0.05, 0.1, 0.7)),
    _named("red", (0.7, 0.04, 0.04)),
    _named("yellow", (0.8, 0.65, 0.05)),
    _named("gray", (0.21, 0.21, 0.21)),
    _named("white", (0.85, 0.85, 0.85)),
    _named("earth", (0.13, 0.08, 0.045)),
    _named("green2", (0.18, 0.5, 0.1)),
    _named("actor1", (0.05, 0.6, 0.1)),
    _named("actor2", (0.1, 0.15, 0.75)),
    Material("ball", (0.8, 0.4, 0.2), (0.4, 0.2, 0.1), specular=0.0),
    _named("mirror", (0.9, 0.9, 0.9), 0.9, 0.02),
    _named("skin", (0.6, 0.33, 0.23), 0.04, 0.5),
    _named("grey0", (0.1, 0.1, 0.1)),
    _named("grey1", (0.25, 0.25, 0.25)),
    _named("grey2", (0.4, 0.4, 0.4)),
    _named("grey3", (0.6, 0.6, 0.6)),
    _crystal("cr_quartz", (0.8, 0.8, 0.82)),
    _crystal("cr_pyrite", (0.55, 0.45, 0.15)),
    _crystal("cr_emeraude", (0.03, 0.45, 0.18)),
    _crystal("cr_grossulaire", (0.55, 0.3, 0.08)),
    _crystal("cr_fluorine", (0.35, 0.15, 0.6)),
    _crystal("cr_rhodochrosite", (0.7, 0.15, 0.2)),
    _crystal("cr_natrolite", (0.8, 0.75, 0.65)),
    _crystal("cr_celestine", (0.4, 0.6, 0.8)),
    _crystal("cr_aigue_marine", (0.25, 0.65, 0.65)),
)
MATERIALS: dict[int, Material] = dict(enumerate(_NAMED, 1))
"""By number."""
