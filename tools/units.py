# SPDX-License-Identifier: GPL-3.0-or-later
"""SI numbers in the units that people say them in: mm, g, MPa, km/s. Files stay SI; only what is shown is scaled."""

import math
import re

# Unit -> [(from this size on, SI per shown unit, its name)], smallest first; below the first it serves too.
LADDERS = {
    "m": [(0, 1e-9, "nm"), (1e-7, 1e-6, "µm"), (1e-4, 1e-3, "mm"), (1, 1, "m")],
    "s": [(0, 1e-9, "ns"), (1e-6, 1e-6, "µs"), (1e-3, 1e-3, "ms"), (1, 1, "s")],
    "kg": [(0, 1e-9, "µg"), (1e-6, 1e-6, "mg"), (1e-3, 1e-3, "g"), (1, 1, "kg")],
    "m/s": [(0, 1, "m/s"), (2e3, 1e3, "km/s")],
    "kg/m^3": [(0, 1, "kg/m³"), (100, 1e3, "g/cm³")],
    "J/kg": [(0, 1, "J/kg"), (1e3, 1e3, "kJ/kg"), (1e6, 1e6, "MJ/kg")],
    "m/s^2": [(0, 1, "m/s²"), (1e3, 1e3, "km/s²"), (1e6, 1e6, "Mm/s²")],
    "m^2": [(0, 1e-6, "mm²"), (1, 1, "m²")],
    "m^3": [(0, 1e-9, "mm³"), (1e-6, 1e-6, "cm³"), (1, 1, "m³")],
    "rad": [(0, math.pi / 180, "°")],
    "1": [(0, 1, "")],
    "": [(0, 1, "")],
}
USUAL = {"m": 1e-3, "s": 1e-6, "kg": 1e-3}
PREFIXED = {"J", "Pa", "N", "W", "N s", "Hz"}
PREFIXES = [(0, 1e-9, "n"), (1e-6, 1e-6, "µ"), (1e-3, 1e-3, "m"), (1, 1, ""), (1e3, 1e3, "k"), (1e6, 1e6, "M"),
            (1e9, 1e9, "G")]


def scale_of(largest, unit):
    """(SI per shown unit, its name) that make `largest` readable: 3.1e8 Pa -> 1e6, MPa."""
    unit = str(unit)
    steps = LADDERS.get(unit) or ([(least, divisor, prefix + unit) for least, divisor, prefix in PREFIXES]
                                  if unit in PREFIXED else [(0, 1, unit)])
    if not (math.isfinite(largest) and largest != 0):
        largest = USUAL.get(unit, 1.0)  # nothing to go by
    largest = abs(largest)
    return next((divisor, name) for least, divisor, name in reversed(steps) if largest >= least * (1 - 1e-9))


def said(value, unit, digits=4):
    """One number with its unit: 0.0254, m -> 25.4 mm; "-" where there is none."""
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        return "-" if value is None or isinstance(value, float) else str(value)
    divisor, name = scale_of(value, unit)
    if name[:1] == "n" and abs(value) < 0.01 * divisor and value != 0:  # below the ladder: 8.5e-14 J
        divisor, name = 1, str(unit)
    return f"{value / divisor:.{digits}g}" + ("" if name == "°" else " ") * bool(name) + name


FACTORS = {"": 1, "s": 1, "ms": 1e-3, "us": 1e-6, "µs": 1e-6, "ns": 1e-9, "m": 1, "cm": 1e-2, "mm": 1e-3, "um": 1e-6,
           "µm": 1e-6, "km": 1e3, "Pa": 1, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9, "m/s": 1, "km/s": 1e3, "K": 1, "kg/m^3": 1,
           "g/cm^3": 1e3, "J/kg": 1, "kJ/kg": 1e3, "MJ/kg": 1e6, "1/s": 1, "J": 1, "kJ": 1e3}
NUMBER = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(\S*)\s*")


def quantity(text, kind):
    """SI value of "30 us", "30us" or "3e-5" (kind: the unit in SI, as s); ValueError when it is none."""
    found = NUMBER.fullmatch(str(text))
    if not found or found[2] not in FACTORS or (found[2] and not found[2].endswith(kind)
                                                and (found[2], kind) != ("g/cm^3", "kg/m^3")):
        example = {"s": "30 us", "m": "5 mm", "Pa": "2 GPa"}.get(kind, f"7 {kind}")
        raise ValueError(f"'{text}' is no number of {kind}; write it as {example}")
    return float(found[1]) * FACTORS[found[2]]
