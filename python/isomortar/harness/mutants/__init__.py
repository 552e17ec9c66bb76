"""The harness's own proof: faults planted in the kernel's sources, one at a time, and what the gate makes of each."""
