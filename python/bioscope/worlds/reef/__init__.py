"""The ready-made world `reef`."""
