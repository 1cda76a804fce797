"""The ready-made world `honda_tiers`."""
