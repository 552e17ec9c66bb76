"""What a load step that is given up may be due to."""
