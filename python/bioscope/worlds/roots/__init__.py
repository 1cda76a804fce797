"""The ready-made world `roots`."""
