"""The compiled half; stromboli/__init__.py is what to call."""

from typing import Any

def __getattr__(name: str) -> Any: ...
