"""Reference figures of problems in the plane: `python plane.py [CASE...]` writes them into natural.csv."""
import math
import pathlib
import sys

import ngsolve as ng

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
        levels=((10, 10, 0.125), (13, 12, 0.125)),
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



def l_domain(eta):
    """Source 1 in an L whose sides are at 0."""
    l = [(-1, -1), (0, -1), (0, 0), (1, 0), (1, 1), (-1, 1)]
    probes = [("l", (-0.5, -0.5)), ("l", (-0.2, 0.2)), ("l", (-0.1, 0.1)), ("l", (0.5, 0.5))]
    return hp.Problem("l-domain", [("l", hp.face(l), eta, 1)], probes, lambda p: "outer", {"outer": 0}, closed={"outer": -3})


def die(eta):
    """A die on a copper spreader that is cooled from below; mm, W/(mm K), degrees C."""
    regions = [("copper", hp.box((0, 0), (20, 3)), 0.39, 0), ("die", hp.box((0, 3), (5, 3.5)), eta, 1)]
    probes = [("die", (0.0, 3.5)), ("die", (4.5, 3.25)), ("copper", (0.0, 0.0)), ("copper", (20.0, 0.0)), ("copper", (8.0, 1.5))]
    bottom = {"bottom": (0.005, 25)}
    named = lambda p: "bottom" if p.y < 1e-9 else "free" if min(p.x, 20 - p.x) < 1e-9 or p.y > 3 + 1e-9 else None
    return hp.Problem("die", regions, probes, named, convection=bottom, size=1.5, closed={"bottom": -2.5})


# Conductivity of a square array of cylinders that conduct perfectly, by the fraction of area.
ARRAY = {0.3: 1.860188306519, 0.7: 7.432709328738}


def quarter(fraction):
    """A quarter of the cell of an array of cylinders, 0 on the left and 0.5 on the right, by the contrast."""
    def at(contrast):
        fibre = hp.disc((0, 0), math.sqrt(fraction / math.pi)) * hp.box((0, 0), (0.5, 0.5))
        regions = [("fibre", fibre, contrast, 0), ("matrix", hp.box((0, 0), (0.5, 0.5)), 1, 0)]
        probes = [("matrix", (0.45, 0.4)), ("matrix", (0.48, 0.2)), ("matrix", (0.4, 0.45))]
        named = lambda p: "left" if p.x < 1e-9 else "right" if p.x > 0.5 - 1e-9 else None
        flux = ARRAY[fraction] / 2
        return hp.Problem("quarter-cell", regions, probes, named, {"left": 0, "right": 0.5}, size=0.06, curved=True,
                          levels=((0, 8, 0.25), (0, 10, 0.25)), closed={"left": -flux, "right": flux})
    return at


def tolerance(eta):
    """A heated chip; u = x on the left and on the right, nothing passes the other sides."""
    chip = ("chip", hp.box((-0.3, -0.3), (0.3, 0.3)), eta, SOURCE)
    named = lambda p: "ends" if abs(p.x) > 1 - 1e-9 else None
    return hp.Problem("tolerance", [chip, ("plate", PLATE, 1, 0)], PROBES, named, {"ends": ng.x}, closed={"ends": -3.6})


CASES["l-domain"] = l_domain
CASES["die"] = die
CASES["tolerance"] = tolerance

ETAS = {
    "l-domain": [1],
    "die": [0.15],
    "tolerance": [10],
    "heated-box": [1e-10, 1e-4, 1e-2, 10, 1e4, 1e10],
    "touching-corner": [0.1, 10],
}


def main(names):
    for name in names or [*CASES, "quarter-cell"]:
        if name == "quarter-cell":
            for fraction in ARRAY:
                at = quarter(fraction)
                table = list(hp.rows(at(10), 1e10, extrapolate=at))
                hp.write(TABLE, [[row[0], f"{fraction:g}", *row[2:]] for row in table])
            continue
        for eta in ETAS.get(name, [1e-4, 1e-2, 10, 1e4, 1e10]):
            at = CASES[name]
            table = list(hp.rows(at(eta), eta, extrapolate=at if eta > 1e5 else False))
            hp.write(TABLE, table)
            for row in table:
                print(*row[:-1])


main(sys.argv[1:])
