"""Binary glTF 2.0, written with numpy and JSON."""
