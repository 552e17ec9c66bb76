"""What watches a run, and says what is doubtful of its load steps."""
