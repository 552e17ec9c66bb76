"""What is doubtful of a scene before its first load step."""
