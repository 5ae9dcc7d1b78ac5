//! A report in lines of text, as `meshless solve` prints it.

use meshless::report::{BalanceReport, CornerReport, FluxReport, Probe, Report};

pub(crate) fn print(report: &Report) {
    say!("{}", report.title);
    let raised = report.estimate.raised_by.is_some();
    // What is worse than all that follows comes first.
    report.balance.iter().filter(|_| raised).for_each(|b| balance(b, report));
    corners(&report.corners);
    system(report);
    field(report);
    solution(report);
    errors(report);
    report.balance.iter().filter(|_| !raised).for_each(|b| balance(b, report));
    seconds(report);
    report.probes.iter().for_each(|p| probe(p, has_u(report)));
    report.fluxes.iter().for_each(fluxes);
}

/// What enters and arises, and what of it is left over; a region by itself where that is what raised the estimate.
fn balance(balance: &BalanceReport, report: &Report) {
    let enters: f64 = balance.into.iter().map(|part| part.flux).sum();
    let stored = balance.stored.map_or(String::new(), |stored| format!(", stored {stored:.6e}"));
    let part = |name: &str, value: Option<f64>| match value {
        Some(value) if value != 0.0 => format!(", {name} {value:.6e}"),
        _ => String::new(),
    };
    let taken = part("reacted", balance.reacted) + &part("carried away", balance.carried);
    let (left, relative) = (balance.left_over, balance.relative);
    say!(
        "balance     enters {enters:.6e}, sources {:.6e}{stored}{taken}: {left:.1e} left over, {relative:.1e} of the parts",
        balance.sources.total
    );
    let estimate = &report.estimate;
    if estimate.raised_by.is_none() {
        return;
    }
    if let Some(compared) = estimate.compared {
        say!(
            "  the comparison of two solutions says {compared:.1e}: they make the same mistake, the error is larger"
        );
    }
    for (name, region) in &balance.regions {
        if estimate.regions.get(name).is_some_and(|known| *known == region.relative) {
            say!("  {name:<10} {:.1e} left over, {:.1e} of its parts", region.left_over, region.relative);
        }
    }
}

/// Where the solution is singular: the worst corner that functions serve, and the worst that none do.
fn corners(corners: &[CornerReport]) {
    for served in [false, true] {
        let all: Vec<&CornerReport> = corners.iter().filter(|corner| corner.served == served).collect();
        let Some(worst) = all.iter().min_by(|a, b| a.exponent.total_cmp(&b.exponent)) else { continue };
        let more = match all.len() - 1 {
            0 => String::new(),
            others => format!(" (and at {others} more)"),
        };
        let why = match &worst.why_not {
            None => ": functions of their own there".to_owned(),
            Some(why) => format!(": not served, {why}; a cloud that is graded towards it helps"),
        };
        say!("corner      u ~ r^{:.3} at {:?}{more}{why}", worst.exponent, worst.at);
    }
}

/// What enters through the parts of the boundary, and passes interfaces.
fn fluxes(fluxes: &FluxReport) {
    for part in &fluxes.boundaries {
        let within = within(part.estimate);
        say!(
            "flux        {:.6e}{within} enters through {} (boundaries[{}])",
            part.flux,
            part.face,
            part.entry
        );
    }
    for seam in &fluxes.interfaces {
        let within = within(seam.estimate);
        say!(
            "flux        {:.6e}{within} enters \"{}\" from \"{}\"",
            seam.flux,
            seam.between[0],
            seam.between[1]
        );
    }
}

/// What was set up, and what had to be done otherwise than planned.
fn system(report: &Report) {
    say!(
        "method      {} (order {}), {} unknowns, spacing {:.4}",
        report.method,
        report.order,
        report.unknowns,
        report.spacing
    );
    if let Some(why) = &report.fallback {
        say!("fallback    {why}");
    }
    if let Some(layer) = &report.thin_layer {
        say!(
            "thin layer  \"{}\" is {:.2e} thin near {:?}: {}; a spacing of {:.2e} resolves it",
            layer.region,
            layer.thickness,
            layer.at,
            if layer.seen { "less accurate there" } else { "partly missing, the solution may be wrong" },
            layer.resolving_spacing
        );
    }
    if let Some(contact) = report.contacts.first() {
        let more = match report.contacts.len() - 1 {
            0 => String::new(),
            more => format!(", and at {more} more places"),
        };
        let between = contact.between.join("\" and \"");
        say!(
            "contact     \"{between}\" touch near {:?}{more}: no spacing resolves the tip between them",
            contact.at
        );
    }
    let nodes = &report.nodes;
    say!(
        "rows        {} stencils, {} cells, {} boundary stencils, {} prescribed",
        nodes.strong,
        nodes.conservative,
        nodes.strong_boundary,
        nodes.dirichlet
    );
    say!("contrast    {:.3e}", report.contrast);
}

/// A scene with a vorticity alone has a velocity, and no u.
fn has_u(report: &Report) -> bool {
    report.speed.is_none() || report.extrema.min != 0.0 || report.extrema.max != 0.0
}

fn field(report: &Report) {
    if has_u(report) {
        say!("u           {:.6e} .. {:.6e}", report.extrema.min, report.extrema.max);
    }
    if let Some(speed) = &report.speed {
        say!("speed       {:.6e} .. {:.6e}", speed.min, speed.max);
    }
}

fn solution(report: &Report) {
    let solver = &report.solver;
    say!("solver      {}, {} iterations, residual {:.1e}", solver.name, solver.iterations, solver.residual);
    if let Some(time) = &report.time {
        say!(
            "time        {} in {} steps ({} rejected), {} matrices",
            time.end,
            time.steps,
            time.rejected,
            time.matrices
        );
    }
}

/// A region's own estimate is shown from here on, if it is so many times that of the whole.
const SHOWN: f64 = 0.02;
const MUCH: f64 = 10.0;

/// True errors, the estimate, and the clouds that a tolerance has taken.
fn errors(report: &Report) {
    if let Some(errors) = &report.errors {
        say!(
            "error       l2 {:.3e}, linf {:.3e}, gradient linf {:.3e}",
            errors.l2,
            errors.linf,
            errors.gradient_linf
        );
        if errors.regions.len() > 1 {
            for (name, region) in &errors.regions {
                say!("  {name:<10} l2 {:.3e}, linf {:.3e}", region.l2, region.linf);
            }
        }
    }
    match (report.estimate.l2, &report.estimate.why_not) {
        (Some(l2), _) => {
            say!("estimate    l2 {l2:.3e}");
            let worse = |(_, of_region): &(&String, &f64)| **of_region > SHOWN.max(MUCH * l2);
            for (name, of_region) in report.estimate.regions.iter().filter(worse) {
                say!("  {name:<10} l2 {of_region:.3e} of u in this region alone");
            }
        }
        (None, Some(why)) => say!("estimate    none: {why}"),
        (None, None) => {}
    }
    for rung in report.accuracy.iter().flat_map(|accuracy| &accuracy.rungs) {
        match (&rung.why, rung.estimate) {
            (None, Some(estimate)) => say!(
                "  spacing {:.3e}: {} unknowns, estimate {estimate:.1e}, {:.3} s",
                rung.spacing,
                rung.unknowns,
                rung.seconds
            ),
            (why, _) => {
                say!("  spacing {:.3e}: {}", rung.spacing, why.as_deref().unwrap_or("no estimate"));
            }
        }
    }
}

fn seconds(report: &Report) {
    let s = &report.seconds;
    say!(
        "seconds     {:.3}: points {:.3}, neighbors {:.3}, stencils {:.3}, assembly {:.3}, solve {:.3}, post {:.3}, balance {:.3}, estimate {:.3}",
        s.total,
        s.points,
        s.neighbors,
        s.stencils,
        s.assembly,
        s.solve,
        s.post,
        s.balance,
        s.estimate
    );
}

/// An estimated error behind its value.
fn within(estimate: Option<f64>) -> String {
    estimate.map_or(String::new(), |error| format!(" \u{b1} {error:.1e}"))
}

fn probe(probe: &Probe, has_u: bool) {
    let Some(value) = probe.value else {
        say!("probe       {:?}: outside of the domain", probe.at);
        return;
    };
    let mut parts = Vec::new();
    if has_u {
        parts.push(format!("{value:.8e}{}", within(probe.estimate)));
    }
    if let Some(velocity) = &probe.velocity {
        let components: Vec<String> = velocity.iter().map(|v| format!("{v:.8e}")).collect();
        parts.push(format!("velocity [{}]", components.join(", ")));
    }
    say!("probe       {:?}: {}", probe.at, parts.join(", "));
}
