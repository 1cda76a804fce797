"""The ready-made world `preying`."""
