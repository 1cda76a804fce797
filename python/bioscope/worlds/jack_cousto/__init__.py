"""The ready-made world `jack_cousto`."""
