"""The ready-made world `topiary`."""
