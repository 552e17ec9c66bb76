"""The harness's own proof: faults planted in the sources, one at a time, and what the gate makes of each."""
