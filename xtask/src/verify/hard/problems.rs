//! Concentric rings with a closed form.
//!
//! With `f = 4` the flux through a circle of radius r is that of the source within, whatever the rings are made of:
//! `eta u' = -2 r`. So `u = c_k - r^2 / eta_k` in ring k, with constants that make u continuous.

use std::fmt::Write;

/// Concentric rings on `[-1, 1]^2`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rings {
    /// Radii of the interfaces, growing. The innermost disc is stiff, then soft and stiff alternate.
    pub(super) radii: &'static [f64],
    /// Diffusivity of the stiff rings; that of the soft ones is 1.
    pub(super) contrast: f64,
    /// Cut the quadrant `x > 0, y < 0` out of the domain.
    pub(super) corner: bool,
}

impl Rings {
    pub(super) fn plain(contrast: f64) -> Self {
        Self { radii: &[], contrast, corner: false }
    }

    /// Diffusivity of a ring, counted from the inside.
    fn eta(&self, ring: usize) -> f64 {
        // The background is soft, so that everything stiff floats.
        if (self.radii.len() - ring).is_multiple_of(2) { 1.0 } else { self.contrast }
    }

    /// Constants `c_k`, from the innermost ring to the background.
    fn constants(&self) -> Vec<f64> {
        let n = self.radii.len();
        let mut constants = vec![1.0; n + 1];
        for k in (0..n).rev() {
            let r = self.radii[k];
            constants[k] = constants[k + 1] + r * r * (1.0 / self.eta(k) - 1.0 / self.eta(k + 1));
        }
        constants
    }
}

/// The scene.
pub(super) fn rings(rings: &Rings, spacing: f64, seed: u64) -> String {
    let constants = rings.constants();
    let exact = |k: usize| format!("{:e} - (x^2 + y^2)/{:e}", constants[k], rings.eta(k));
    let whole = "{ box = { min = [-1.0, -1.0], max = [1.0, 1.0] } }";
    let domain = if rings.corner {
        format!("difference = [{whole}, {{ box = {{ min = [0.0, -2.0], max = [2.0, 0.0] }} }}]")
    } else {
        "box = { min = [-1.0, -1.0], max = [1.0, 1.0] }".to_owned()
    };
    let mut text = format!(
        "title = \"Rings\"\ndimension = 2\n\n[domain]\n{domain}\n\n\
         [points]\nspacing = {spacing:?}\nlayout = \"irregular\"\nseed = {seed}\n\n"
    );
    let n = rings.radii.len();
    for k in 0..=n {
        let place = if k < n {
            format!("sphere = {{ center = [0.0, 0.0], radius = {:?} }}\n", rings.radii[k])
        } else {
            String::new()
        };
        // Writing to a string cannot fail.
        let _ = write!(
            text,
            "[[regions]]\nname = \"ring {k}\"\n{place}diffusivity = \"{:e}\"\nsource = \"4\"\nexact = \"{}\"\n\n",
            rings.eta(k),
            exact(k),
        );
    }
    text + &format!("[[boundaries]]\nface = \"all\"\ndirichlet = \"{}\"\n", on_boundary(rings, &exact))
}

/// The exact solution as one expression: rings may meet the boundary at a corner.
fn on_boundary(rings: &Rings, exact: &impl Fn(usize) -> String) -> String {
    (0..rings.radii.len()).rev().fold(exact(rings.radii.len()), |outer, k| {
        format!("if(x^2 + y^2 < {:e}, {}, {outer})", rings.radii[k].powi(2), exact(k))
    })
}

#[cfg(test)]
mod tests {
    use super::{Rings, rings};

    const RINGS: Rings = Rings { radii: &[0.2, 0.5], contrast: 100.0, corner: false };

    #[test]
    fn the_background_is_soft_and_rings_alternate() {
        assert_eq!([RINGS.eta(0), RINGS.eta(1), RINGS.eta(2)], [1.0, 100.0, 1.0]);
    }

    #[test]
    fn the_solution_is_continuous() {
        let c = RINGS.constants();
        for (k, r) in RINGS.radii.iter().enumerate() {
            let value = |ring: usize| c[ring] - r * r / RINGS.eta(ring);
            assert!((value(k) - value(k + 1)).abs() < 1e-15);
        }
    }

    #[test]
    fn the_scenes_parse() {
        for corner in [false, true] {
            let parsed = meshless::scene::Scene::parse(&rings(&Rings { corner, ..RINGS }, 0.1, 1), "rings");
            assert!(parsed.is_ok(), "{parsed:?}");
        }
    }
}
