"""The ready-made world `mating`."""
