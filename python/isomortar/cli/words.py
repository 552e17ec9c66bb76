"""Numbers in sentences."""


def many(count: int, what: str) -> str:
    """How many there are: 1 load step, 2 load steps."""
    return f"{count} {what}{'' if count == 1 else 's'}"
