"""Scene files: TOML in, a `Problem` out."""

from isomortar.scene.scene import Scene
from isomortar.scene.schema import json_schema
from isomortar.scene.source import bundled_scenes

__all__ = ["Scene", "bundled_scenes", "json_schema"]
