"""Reference figures of problems in the plane: `python plane.py [CASE...]` writes them into natural.csv."""
import math
import pathlib
import sys

import hp

TABLE = pathlib.Path(__file__).with_name("natural.csv")
SOURCE = 10
PLATE = hp.box((-1, -1), (1, 1))


def outer(p):
    return "outer" if max(abs(p.x), abs(p.y)) > 1 - 1e-9 else None


def heated(case, parts, probes, **more):
    """Parts (name, shape, factor of eta, source) in a plate of diffusivity 1 whose sides are at 0."""
    def at(eta):
        regions = [(name, shape, factor * eta, source) for name, shape, factor, source in parts]
        regions.append(("plate", PLATE, 1, 0))
        keys = {"named": outer, "dirichlet": {"outer": 0}, **more}
        return hp.Problem(case, regions, probes, **keys)
    return at


def ngon(n, radius, start):
    return [(radius * math.cos(start + 2 * math.pi * k / n), radius * math.sin(start + 2 * math.pi * k / n)) for k in range(n)]


PROBES = [("chip", (0.1, 0.05)), ("plate", (0.5, 0.2)), ("plate", (0.7, 0.7)), ("plate", (-0.2, -0.6))]
L_CHIP = [(-0.3, -0.3), (0.3, -0.3), (0.3, 0), (0, 0), (0, 0.3), (-0.3, 0.3)]

CASES = {
    # A square chip in a plate.
    "heated-box": heated("heated-box", [("chip", hp.box((-0.3, -0.3), (0.3, 0.3)), 1, SOURCE)], PROBES),
    # An equilateral triangle.
    "heated-triangle": heated("heated-triangle", [("chip", hp.face(ngon(3, 0.4, math.pi / 2)), 1, SOURCE)], PROBES),
    # Twelve corners of 150 degrees: almost a disc.
    "heated-12-gon": heated("heated-12-gon", [("chip", hp.face(ngon(12, 0.3, 0)), 1, SOURCE)], PROBES),
    # A chip with a re-entrant corner.
    "heated-l": heated("heated-l", [("chip", hp.face(L_CHIP), 1, SOURCE)], [("chip", (-0.15, -0.1))] + PROBES[1:]),
    # Two boxes that share half an edge: heat is made in one, the other conducts three times as well.
    "touching-edge": heated(
        "touching-edge",
        [("a", hp.box((-0.4, -0.3), (0, 0.1)), 1, SOURCE), ("b", hp.box((0, -0.1), (0.4, 0.3)), 3, 0)],
        [("a", (-0.25, -0.1)), ("b", (0.25, 0.15)), ("plate", (0.6, 0.3)), ("plate", (-0.6, -0.5))],
    ),
    # Two boxes that touch in a corner.
    "touching-corner": heated(
        "touching-corner",
        [("a", hp.box((-0.4, -0.4), (0, 0)), 1, SOURCE), ("b", hp.box((0, 0), (0.4, 0.4)), 1, 0)],
        [("a", (-0.25, -0.15)), ("b", (0.25, 0.15)), ("plate", (0.6, 0.3)), ("plate", (-0.3, 0.25))],
        levels=((18, 10, 0.125), (26, 12, 0.15)),
    ),
    # A box on an insulated wall.
    "box-on-wall": heated(
        "box-on-wall",
        [("chip", hp.box((-1, -0.3), (-0.4, 0.3)), 1, SOURCE)],
        [("chip", (-0.8, 0.1)), ("plate", (-0.2, 0.2)), ("plate", (-0.7, 0.6)), ("plate", (0.4, -0.3))],
        named=lambda p: "left" if p.x < -1 + 1e-9 else outer(p),
    ),
    # What two discs have in common: curved sides.
    "heated-lens": heated(
        "heated-lens",
        [("chip", hp.disc((-0.3, 0), 0.5) * hp.disc((0.3, 0), 0.5), 1, SOURCE)],
        PROBES,
        curved=True,
    ),
}

ETAS = {
    "heated-box": [1e-10, 1e-4, 1e-2, 10, 1e4, 1e10],
    "touching-corner": [0.1, 10],
}


def main(names):
    for name in names or CASES:
        for eta in ETAS.get(name, [1e-4, 1e-2, 10, 1e4, 1e10]):
            at = CASES[name]
            table = list(hp.rows(at(eta), eta, extrapolate=at if eta > 1e5 else False))
            hp.write(TABLE, table)
            for row in table:
                print(*row[:-1])


main(sys.argv[1:])
