"""Figures in closed form: `python closed.py` writes them into natural.csv."""
import math
import pathlib

import hp

TABLE = pathlib.Path(__file__).with_name("natural.csv")


def half_column():
    """ISO 10211, case 1: half of a square column of 8 x 8, 20 at the top and 0 at the other sides; series of sines."""
    for j in range(1, 8):
        for i in range(1, 5):
            x, y = float(i), 8.0 - j
            value, n = 0.0, 1
            while n * math.pi * j / 8 < 45:
                # sinh(n pi y / 8) / sinh(n pi) without overflow
                ratio = math.exp(n * math.pi * (y / 8 - 1)) * -math.expm1(-n * math.pi * y / 4) / -math.expm1(-2 * n * math.pi)
                value += 80 / (n * math.pi) * math.sin(n * math.pi * x / 8) * ratio
                n += 2
            yield ["iso-10211-1", "1", "u", "column", f"{x} {y}", f"{value:.13g}", f"{1e-13 * value:.1e}", "series"]


# Conductivity of a simple cubic array of spheres of ratio 10, by the fraction of volume.
SPHERES = {0.1: 1.243338546, 0.3: 1.887740058}


def spheres():
    """An eighth of the cell, 0 on the left and 0.5 on the right: what passes is a quarter of the conductivity."""
    for fraction, conductivity in SPHERES.items():
        for name, sign in ("left", -1), ("right", 1):
            flux = sign * conductivity / 4
            yield ["spheres", f"{fraction:g}", "flux", name, "", f"{flux:.10g}", f"{1e-9 * abs(flux):.1e}", "multipoles"]


def bar():
    """ISO 10211, case 4, as the standard has it: within 0.005 of the highest outer temperature, and 1 % of the flow (a quarter of it); space.py writes it."""
    yield ["iso-10211-4", "50", "u", "bar", "0.0 0.0 0.0", "0.805", "5.0e-3", "ISO 10211"]
    yield ["iso-10211-4", "50", "flux", "inside", "", "0.135", "1.35e-3", "ISO 10211"]


if __name__ == "__main__":
    hp.write(TABLE, [*half_column(), *spheres()])
