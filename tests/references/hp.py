"""High-order finite elements on meshes refined towards corners (NGSolve): -div(eta grad u) = f in the plane and in space.

A problem is a list of regions (name, shape, diffusivity, source; a shape takes what the shapes before it have left), conditions by
the name of a piece of the boundary, and points. Every problem is solved twice; the difference is what the figures are not known to.
"""
import csv
import math
from dataclasses import dataclass, field

import numpy as np
import netgen.occ as occ
import ngsolve as ng

ng.ngsglobals.msg_level = 0

HEADER = ["case", "parameter", "quantity", "name", "at", "value", "uncertainty", "source"]


@dataclass
class Problem:
    case: str
    regions: list  # (name, OCC face or solid, diffusivity, source)
    probes: list  # (region, point)
    named: object  # centre of a piece of the boundary -> name of its condition
    dirichlet: dict = field(default_factory=dict)  # name -> value
    convection: dict = field(default_factory=dict)  # name -> (h, ambient)
    size: float = 0.15  # of elements
    levels: tuple = ((10, 10, 0.125), (14, 12, 0.25))  # layers towards corners, degree, factor of the layers
    curved: bool = False
    closed: dict = field(default_factory=dict)  # fluxes that are known in closed form, by condition
    edges: object = None  # in space: centre of an edge -> whether to refine towards it


def face(points):
    """A polygon."""
    wire = occ.MoveTo(*points[0])
    for p in points[1:]:
        wire = wire.LineTo(*p)
    return wire.Close().Face()


def box(low, high):
    if len(low) == 3:
        return occ.Box(occ.Pnt(*low), occ.Pnt(*high))
    return occ.MoveTo(*low).Rectangle(high[0] - low[0], high[1] - low[1]).Face()


def disc(center, radius):
    return occ.WorkPlane().Circle(*center, radius).Face()


def mesh_of(problem, layers, factor, degree):
    shapes, taken = [], None
    for name, shape, _, _ in problem.regions:
        rest = shape if taken is None else shape - taken
        taken = shape if taken is None else taken + shape
        space = bool(shape.solids)
        for part in rest.solids if space else rest.faces:
            part.name = name
        shapes.append(rest)
    whole = occ.Glue(shapes)
    pieces = whole.faces if space else whole.edges
    for piece in pieces:
        piece.name = problem.named(piece.center) or "none"
    for vertex in whole.vertices:
        vertex.hpref = 1
    if space and problem.edges:
        for edge in whole.edges:
            if problem.edges(edge.center):
                edge.hpref = 1
    mesh = ng.Mesh(occ.OCCGeometry(whole, dim=3 if space else 2).GenerateMesh(maxh=problem.size))
    mesh.RefineHP(layers, factor)
    if problem.curved:
        mesh.Curve(degree)
    return mesh


def solve(problem, layers, degree, factor, scale=None):
    """Values at the probes, root mean squares by region, fluxes in through the conditions."""
    mesh = mesh_of(problem, layers, factor, degree)
    regions = {name: (eta, source) for name, _, eta, source in problem.regions}
    eta = mesh.MaterialCF({name: scale(e) if scale else e for name, (e, _) in regions.items()})
    source = mesh.MaterialCF({name: s for name, (_, s) in regions.items()})
    space = ng.H1(mesh, order=degree, dirichlet="|".join(problem.dirichlet))
    u, v = space.TnT()
    a = ng.BilinearForm(eta * ng.grad(u) * ng.grad(v) * ng.dx, symmetric=True, condense=True)
    load = ng.LinearForm(space)
    if any(s for _, s in regions.values()):
        load += source * v * ng.dx
    for name, (h, ambient) in problem.convection.items():
        a += h * u * v * ng.ds(name)
        load += h * ambient * v * ng.ds(name)
    field_ = ng.GridFunction(space)
    if problem.dirichlet:
        values = mesh.BoundaryCF({name: value for name, value in problem.dirichlet.items()})
        field_.Set(values, definedon=mesh.Boundaries("|".join(problem.dirichlet)))
    with ng.TaskManager():
        a.Assemble()
        load.Assemble()
        residual = load.vec.CreateVector()
        residual.data = load.vec - a.mat * field_.vec
        if a.condense:
            residual.data += a.harmonic_extension_trans * residual
        inverse = a.mat.Inverse(space.FreeDofs(True), inverse="sparsecholesky")
        field_.vec.data += inverse * residual
        field_.vec.data += a.inner_solve * residual
        field_.vec.data += a.harmonic_extension * field_.vec
    out = {}
    for region, point in problem.probes:
        out[("u", region, point)] = field_(mesh(*point))
    for name in regions:
        part = mesh.Materials(name)
        square = ng.Integrate(field_ * field_, mesh, definedon=part, order=2 * degree)
        size = ng.Integrate(1, mesh, definedon=part)
        out[("rms", name, ())] = math.sqrt(square / size)
    # What enters through a prescribed value is the residual of the equation tested with any extension of 1 from there.
    for name in problem.dirichlet:
        one = ng.GridFunction(space)
        one.Set(1, definedon=mesh.Boundaries(name))
        flux = ng.LinearForm(eta * ng.grad(field_) * ng.grad(v) * ng.dx - source * v * ng.dx).Assemble()
        out[("flux", name, ())] = flux.vec.InnerProduct(one.vec)
    for name, (h, ambient) in problem.convection.items():
        out[("flux", name, ())] = ng.Integrate(h * (ambient - field_), mesh, definedon=mesh.Boundaries(name), order=2 * degree)
    return out, space.ndof


def rows(problem, eta, extrapolate=False, keep=lambda key: True):
    """Rows of the table. With `extrapolate`, eta is a function of the contrast c and the figures are those of its limit in 1/c."""
    found = []
    for layers, degree, factor in problem.levels:
        if extrapolate:
            # Round-off grows with the contrast; in 1/c the solution is analytic. Quadratic in 1/c through three contrasts.
            contrasts = [1e3, 1e4, 1e5]
            runs = [solve(extrapolate(c), layers, degree, factor)[0] for c in contrasts]
            x = 1 / np.array(contrasts)
            weights = [np.prod([(1 / eta - y) / (z - y) for y in x if y != z]) for z in x]
            found.append({key: sum(w * run[key] for w, run in zip(weights, runs)) for key in runs[0]})
        else:
            found.append(solve(problem, layers, degree, factor)[0])
    coarse, fine = found
    source = "hp-FEM" + (", contrasts 1e3 to 1e5, extrapolated" if extrapolate else "")
    for key, value in fine.items():
        if not keep(key):
            continue
        quantity, region, point = key
        unsure = max(abs(value - coarse[key]), 1e-12 * abs(value))
        place = " ".join(repr(float(x)) for x in point)
        if quantity == "flux" and region in problem.closed:
            exact = problem.closed[region]
            assert abs(value - exact) < 1e-4 * abs(exact), (problem.case, region, value, exact)
            yield [problem.case, f"{eta:g}", quantity, region, "", f"{exact:.13g}", f"{1e-12 * abs(exact):.1e}", "closed form"]
            continue
        yield [problem.case, f"{eta:g}", quantity, region, place, f"{value:.12g}", f"{unsure:.1e}", source]


def write(path, table):
    """Replaces the rows of the cases in `table`, keeps all others."""
    table = list(table)
    done = {(row[0], row[1]) for row in table}
    try:
        with open(path, newline="") as file:
            table = [r for r in list(csv.reader(file))[1:] if (r[0], r[1]) not in done] + table
    except FileNotFoundError:
        pass
    with open(path, "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(HEADER)
        writer.writerows(sorted(table, key=lambda row: row[0]))
