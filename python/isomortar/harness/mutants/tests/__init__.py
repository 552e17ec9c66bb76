"""The project's tests as cells."""
