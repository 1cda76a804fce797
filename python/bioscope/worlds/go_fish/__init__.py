"""The ready-made world `go_fish`."""
