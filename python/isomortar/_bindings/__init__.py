"""Calls of the compiled kernel, a subject a file, with the arrays that those who call take from here.

Arguments are checked, status codes become exceptions. Arrays are laid out as `_arrays` says.
"""

from isomortar._arguments import FloatArray, IntArray, LongArray
from isomortar._arrays import (
    NO_FRICTION,
    AveragedFaceArrays,
    BodyArrays,
    Control,
    FaceArrays,
    FrictionArrays,
    FunctionArrays,
    Law,
    MasterArrays,
    MaterialArrays,
    PatchArrays,
    Pattern,
    PlaneArrays,
    Projections,
    Response,
    SlaveArrays,
)
from isomortar._bindings.contact import contact_blocks, contact_forces
from isomortar._bindings.faces import slave_tables, surface_functions
from isomortar._bindings.kinematics import control_quantities, find_climbs, project_points
from isomortar._bindings.multipliers import augmented_multipliers, condense_multipliers, friction_radius, multiplier_rows
from isomortar._bindings.solid import add_body, control_volumes, material_stress
from isomortar._bindings.system import add_values, find_places, squares_times

__all__ = [
    "NO_FRICTION", "AveragedFaceArrays", "BodyArrays", "Control", "FaceArrays", "FloatArray", "FrictionArrays", "FunctionArrays",
    "IntArray", "Law", "LongArray", "MasterArrays", "MaterialArrays", "PatchArrays", "Pattern", "PlaneArrays", "Projections",
    "Response", "SlaveArrays",
    "add_body", "add_values", "augmented_multipliers",
    "condense_multipliers", "contact_blocks", "contact_forces", "control_quantities",
    "control_volumes", "find_climbs", "find_places", "friction_radius",
    "material_stress", "multiplier_rows", "project_points", "slave_tables", "squares_times", "surface_functions",
]  # fmt: skip
