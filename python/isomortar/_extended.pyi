# The compiled kernel in quadruple precision: written by f2py, which knows no types. `_bindings` gives them.
from typing import Any

def __getattr__(name: str) -> Any: ...
