"""Reference figures of problems in space: `python space.py [CASE...]` writes them into natural.csv."""
import math
import pathlib
import sys

import netgen.occ as occ

import closed
import hp

TABLE = pathlib.Path(__file__).with_name("natural.csv")

# Degree and layers towards corners and edges; elements grow fast in space.
LEVELS = ((3, 4, 0.15), (4, 5, 0.15))


def eighth(solid):
    """The part where x, y, z > 0: the others are its mirror images."""
    return solid * hp.box((0, 0, 0), (2, 2, 2))


def far(p):
    return "outer" if max(p.x, p.y, p.z) > 1 - 1e-9 else None


def heated(case, solid, volume, edges, probes, curved=False):
    """10 in each unit of volume of a solid in a cube from -1 to 1 whose sides are at 0: an eighth of it."""
    def at(eta):
        regions = [("part", eighth(solid), eta, 10), ("plate", hp.box((0, 0, 0), (1, 1, 1)), 1, 0)]
        return hp.Problem(case, regions, probes, far, {"outer": 0}, size=0.35, levels=LEVELS, curved=curved, edges=edges,
                          closed={"outer": -10 * volume / 8})
    return at


def at_cube(p):
    """Edges of the cube: two coordinates are those of its sides."""
    return sum(abs(x - 0.4) < 1e-9 for x in (p.x, p.y, p.z)) >= 2


def at_rim(p):
    return abs(p.z - 0.4) < 1e-9 and abs(math.hypot(p.x, p.y) - 0.4) < 0.1


def die(eta):
    """A quarter of a die of 10 x 10 x 0.5 on a copper plate of 40 x 40 x 3 that is cooled from below."""
    regions = [("copper", hp.box((0, 0, 0), (20, 20, 3)), 0.39, 0), ("die", hp.box((0, 0, 3), (5, 5, 3.5)), eta, 1)]
    probes = [("die", (0.0, 0.0, 3.5)), ("die", (4.0, 4.0, 3.25)), ("copper", (0.0, 0.0, 0.0)), ("copper", (20.0, 20.0, 0.0)), ("copper", (8.0, 2.0, 1.5))]
    named = lambda p: "bottom" if p.z < 1e-9 else None
    edges = lambda p: abs(p.z - 3) < 1e-9 and max(p.x, p.y) < 5 + 1e-9 and max(p.x, p.y) > 5 - 1e-9
    return hp.Problem("die-3d", regions, probes, named, convection={"bottom": (0.005, 25)}, size=4, levels=LEVELS, edges=edges,
                      closed={"bottom": -12.5})


def bar(eta):
    """ISO 10211, case 4: a quarter of an insulation layer with an iron bar through it, 1 inside (above), 0 outside."""
    bar_ = hp.box((0, 0, 0), (0.05, 0.025, 0.6))
    layer = hp.box((0, 0, 0), (0.5, 0.5, 0.2))
    regions = [("bar", bar_, eta, 0), ("layer", layer, 0.1, 0)]
    def named(p):
        if p.z < 1e-9:
            return "outside"
        free = p.z > 0.2 - 1e-9 and p.x < 0.5 - 1e-9 and p.y < 0.5 - 1e-9 and (p.z > 0.6 - 1e-9 or max(p.x - 0.05, p.y - 0.025) > -1e-9)
        return "inside" if free else None
    probes = [("bar", (0.0, 0.0, 0.0)), ("bar", (0.0, 0.0, 0.4)), ("layer", (0.2, 0.2, 0.1)), ("layer", (0.1, 0.0, 0.1))]
    # Those of the bar in the layer, without the lines where its sides meet planes of symmetry.
    edges = lambda p: 1e-9 < p.x < 0.05 + 1e-9 and 1e-9 < p.y < 0.025 + 1e-9 and max(p.x - 0.05, p.y - 0.025) > -1e-9 and p.z < 0.2 + 1e-9
    return hp.Problem("iso-10211-4", regions, probes, named, convection={"outside": (10, 0), "inside": (10, 1)}, size=0.03,
                      levels=((6, 3, 0.25), (6, 4, 0.25)), edges=edges)


CUBE = hp.box((-0.4, -0.4, -0.4), (0.4, 0.4, 0.4))
CYLINDER = occ.Cylinder(occ.Pnt(0, 0, -0.4), occ.Z, 0.4, 0.8)
PROBES = [("part", (0.1, 0.05, 0.2)), ("plate", (0.6, 0.1, 0.2)), ("plate", (0.6, 0.6, 0.6)), ("plate", (0.1, 0.2, 0.7))]

CASES = {
    # A cube, its edges and corners.
    "heated-cube": (heated("heated-cube", CUBE, 0.8**3, at_cube, PROBES), [10, 1e4, 1e-2]),
    # A cylinder with ends.
    "heated-cylinder": (heated("heated-cylinder", CYLINDER, math.pi * 0.4**2 * 0.8, at_rim, PROBES, curved=True), [10, 1e4, 1e-2]),
    "die-3d": (die, [0.15]),
    "iso-10211-4": (bar, [50]),
}


def main(names):
    for name in names or CASES:
        at, etas = CASES[name]
        for eta in etas:
            table = list(hp.rows(at(eta), eta))
            if "heated" in name:
                # Eight eighths.
                table = [row if row[2] != "flux" else [*row[:5], f"{8 * float(row[5]):.12g}", *row[6:]] for row in table]
            if name == "iso-10211-4":
                # The figures of the standard stay.
                table += closed.bar()
            hp.write(TABLE, table)
            for row in table:
                print(*row[:-1])


main(sys.argv[1:])
