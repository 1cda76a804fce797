"""The ready-made world `clover`."""
