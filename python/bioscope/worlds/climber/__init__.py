"""The ready-made world `climber`."""
