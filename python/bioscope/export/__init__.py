"""Export: a take of a world as USD or glTF, for other programs.

| suffix | written |
|---|---|
| `.usdc`, `.usda` | USD: PointInstancers, UsdSkel for jointed bodies, sampled points for others |
| `.glb` | binary glTF 2.0: nodes, skins and morph targets, one animation |

Both are metres, Y up, linear color. Every individual keeps its id (USD: `ids` and custom data;
glTF: `extras`). Tints are rounded to a palette per batch. What fills the space (water) has no
place in either format; its numbers travel as custom data.
"""

from bioscope.export.export import PROFILES, export_world

__all__ = ["PROFILES", "export_world"]
