"""The ready-made world `light_trees`."""
