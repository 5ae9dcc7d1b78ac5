//! A method with its parameters, as the `[method]` table of a scene.

/// A method with its parameters; `None` leaves the method's own choice.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Variant {
    pub(crate) method: &'static str,
    pub(crate) smoothing: Option<usize>,
    pub(crate) log_scaling: Option<bool>,
    pub(crate) conservative_neumann: Option<bool>,
    pub(crate) selection_tolerance: Option<f64>,
    pub(crate) select_by_region: Option<bool>,
    pub(crate) solver: Option<&'static str>,
    /// Radius of interaction in units of the spacing.
    pub(crate) support: Option<f64>,
    /// How the other side of an interface continues this one.
    pub(crate) wedge: Option<&'static str>,
    /// Values beyond a stiff side count less.
    pub(crate) flux_weights: Option<bool>,
    /// Nodes do not see through slits.
    pub(crate) visibility: Option<bool>,
    /// Order of the stencils.
    pub(crate) order: Option<usize>,
    /// How fields are continued beyond interfaces.
    pub(crate) ghosts: Option<&'static str>,
    /// The diffusivity across a smeared interface, and the source that a jump of the flux becomes.
    pub(crate) smeared: Option<(&'static str, &'static str)>,
}

impl Variant {
    /// A method as it chooses its parameters itself, on the radius of interaction of the benchmarks.
    pub(crate) const fn plain(method: &'static str) -> Self {
        Self {
            method,
            smoothing: None,
            log_scaling: None,
            conservative_neumann: None,
            selection_tolerance: None,
            select_by_region: None,
            solver: None,
            support: Some(meshless_tests::kraus::SUPPORT),
            wedge: None,
            flux_weights: None,
            visibility: None,
            order: None,
            ghosts: None,
            smeared: None,
        }
    }

    /// The strong form with so many smoothing cycles, on eta or on log eta.
    pub(crate) const fn strong(smoothing: usize, log_scaling: bool) -> Self {
        Self {
            smoothing: Some(smoothing),
            log_scaling: Some(log_scaling),
            ..Self::plain("gfdm-classical").directly()
        }
    }

    /// The same with a direct solver, so that no stopping criterion shows in the results.
    pub(crate) const fn directly(self) -> Self {
        Self { solver: Some("direct"), ..self }
    }

    /// The same with boundary conditions by stencils rather than by balances.
    pub(crate) const fn with_strong_neumann(self) -> Self {
        Self { conservative_neumann: Some(false), ..self }
    }

    /// The table of the scene.
    pub(crate) fn table(&self) -> String {
        let mut table = format!("\n[method]\nname = \"{}\"\n", self.method);
        let mut push = |key: &str, value: Option<String>| {
            if let Some(value) = value {
                table += &format!("{key} = {value}\n");
            }
        };
        push("order", self.order.map(|p| p.to_string()));
        push("smoothing", self.smoothing.map(|k| k.to_string()));
        push("log_scaling", self.log_scaling.map(|b| b.to_string()));
        push("conservative_neumann", self.conservative_neumann.map(|b| b.to_string()));
        push("selection_tolerance", self.selection_tolerance.map(|t| format!("{t:?}")));
        push("select_by_region", self.select_by_region.map(|b| b.to_string()));
        push("solver", self.solver.map(|s| format!("\"{s}\"")));
        push("support", self.support.map(|s| format!("{s:?}")));
        push("wedge", self.wedge.map(|w| format!("\"{w}\"")));
        push("flux_weights", self.flux_weights.map(|b| b.to_string()));
        push("visibility", self.visibility.map(|b| b.to_string()));
        push("ghosts", self.ghosts.map(|g| format!("\"{g}\"")));
        push("sigma", self.smeared.map(|s| format!("\"{}\"", s.0)));
        push("reaction", self.smeared.map(|s| format!("\"{}\"", s.1)));
        table
    }

    /// Parameters for the column `params`.
    pub(crate) fn params(&self) -> Vec<String> {
        let mut params = Vec::new();
        let mut push = |text: Option<String>| params.extend(text);
        push(self.order.map(|p| format!("order={p}")));
        push(self.smoothing.map(|k| format!("smoothing={k}")));
        push(self.log_scaling.map(|b| format!("log={b}")));
        push(
            self.conservative_neumann
                .map(|b| format!("neumann={}", if b { "conservative" } else { "strong" })),
        );
        push(self.selection_tolerance.map(|t| format!("tolerance={t:e}")));
        push(self.select_by_region.map(|b| format!("by_region={b}")));
        push(self.solver.map(|s| format!("solver={s}")));
        push(self.wedge.map(|w| format!("wedge={w}")));
        push(self.flux_weights.map(|b| format!("flux_weights={b}")));
        push(self.visibility.map(|b| format!("visibility={b}")));
        push(self.ghosts.map(|g| format!("ghosts={g}")));
        push(self.smeared.map(|(sigma, source)| format!("sigma={sigma}; reaction={source}")));
        params
    }

    /// How diagrams call it.
    pub(crate) fn label(&self) -> String {
        let mut label = match self.method {
            "gfdm-classical" => "strong form".to_owned(),
            "gfdm-positive" => "positivity-preserving hybrid".to_owned(),
            "gfdm-hybrid" => "conservative hybrid".to_owned(),
            "gfdm-conservative" => "conservative".to_owned(),
            "particle-difference-extended" => "former particle difference".to_owned(),
            other => other.to_owned(),
        };
        if self.select_by_region == Some(true) {
            label += ", by region";
        }
        if let Some(p) = self.order {
            label += &format!(", order {p}");
        }
        if self.log_scaling == Some(true) {
            label += ", log";
        }
        if let Some(k) = self.smoothing {
            label += &format!(", {k} cycle{}", if k == 1 { "" } else { "s" });
        }
        match (self.wedge, self.flux_weights) {
            (Some("plane"), Some(false)) => label += ", as in the paper",
            (wedge, weights) => {
                label += &wedge.map_or_else(String::new, |w| format!(", {w} wedge"));
                label += if weights == Some(false) { ", equal weights" } else { "" };
            }
        }
        if let Some(ghosts) = self.ghosts {
            label += &format!(", {ghosts} images");
        }
        if let Some((sigma, source)) = self.smeared {
            label += &format!(", {sigma} sigma, {source} source");
        }
        if self.conservative_neumann == Some(false) {
            label += ", strong Neumann";
        }
        label
    }
}

#[cfg(test)]
mod tests {
    use super::Variant;
    use meshless::scene::Scene;

    #[test]
    fn every_variant_is_a_scene_that_parses() {
        let problem = meshless_tests::kraus::interior(1e4, 0.2, 1);
        let every = Variant {
            selection_tolerance: Some(1e-8),
            select_by_region: Some(true),
            conservative_neumann: Some(true),
            solver: Some("bicgstab"),
            ..Variant::plain("gfdm-hybrid")
        };
        for variant in [Variant::strong(2, true), Variant::plain("auto"), every] {
            let parsed = Scene::parse(&(problem.clone() + &variant.table()), "test");
            assert!(parsed.is_ok(), "{parsed:?}");
        }
    }
}
