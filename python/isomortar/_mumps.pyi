# The compiled extension of the engine mumps, which not every build has: written by f2py, which knows no types.
from typing import Any

def __getattr__(name: str) -> Any: ...
