"""The march through the load steps, and what is recorded of each."""
