//! The field of one region through time, and when to stop.

use meshless_geometry::Cloud;

use super::derivatives::Derivatives;
use super::{PhaseFieldInfo, PhaseFieldParams, PhaseFieldStop};
use crate::parallel;

/// Share of the largest stable step that is taken.
const STEP: f64 = 0.5;

/// Steps between two looks at drift and profile.
const STEPS_PER_LOOK: usize = 5;

/// Largest |psi| that is turned into a distance.
const SATURATED: f64 = 0.9999;

/// Nodes with |psi| below this tell how good the profile is.
const NEAR: f64 = 0.9;

/// Averages over near neighbours, each of a standard deviation of 0.7 spacings, before the first step. More of them move
/// curved interfaces: four a disc of ten spacings by a tenth of a spacing.
const SWEEPS: usize = 2;

/// Share of the first defect of the profile above which it has not begun to settle. At first the slope is that of the
/// averaged step, `2/sqrt(2 pi)` over a spacing, and not `1/(sqrt 2 w)`: more than twice as steep for w of two spacings.
const SETTLING: f64 = 0.5;

/// A look at which the defect of the profile has not fallen by this share ends the run.
const LEAST_GAIN: f64 = 0.01;

/// The distance from the surface of a region at every node, negative inside, and how it came about.
pub(super) fn evolve<const D: usize>(
    cloud: &Cloud<D>,
    derivatives: &Derivatives<'_, D>,
    labels: &[u16],
    region: u16,
    params: &PhaseFieldParams,
) -> (Vec<f64>, PhaseFieldInfo) {
    let start: Vec<f64> = labels.iter().map(|&l| if l == region { 1.0 } else { -1.0 }).collect();
    let run = Run { cloud, derivatives, width: params.width };
    let time_step = run.time_step();
    // A step function has no direction: what a few averages leave of it has one.
    let mut psi = (0..SWEEPS).fold(start.clone(), |psi, _| run.average(&psi));
    let mut kept = (
        psi.clone(),
        PhaseFieldInfo { steps: 0, drift: 0.0, defect: f64::INFINITY, stop: PhaseFieldStop::Steps },
    );
    let first = run.look(&start, &psi).1;
    while kept.1.steps < params.max_steps {
        let steps = STEPS_PER_LOOK.min(params.max_steps - kept.1.steps);
        (0..steps).for_each(|_| psi = run.step(&psi, time_step));
        let (drift, defect) = run.look(&start, &psi);
        let stop = if drift.abs() > params.drift {
            Some(PhaseFieldStop::Drift)
        } else if defect < SETTLING * first && defect > (1.0 - LEAST_GAIN) * kept.1.defect {
            Some(PhaseFieldStop::Settled)
        } else {
            None
        };
        // The state before is the better one, unless it is the step function itself.
        if let (Some(stop), true) = (stop, kept.1.steps > 0) {
            kept.1.stop = stop;
            break;
        }
        let steps = kept.1.steps + steps;
        kept = (psi.clone(), PhaseFieldInfo { steps, drift, defect, stop: PhaseFieldStop::Steps });
        if stop == Some(PhaseFieldStop::Drift) {
            kept.1.stop = PhaseFieldStop::Drift;
            break;
        }
    }
    let distance = kept.0.iter().zip(cloud.spacing()).map(|(&psi, &h)| run.distance(psi, h));
    (distance.collect(), kept.1)
}

struct Run<'a, const D: usize> {
    cloud: &'a Cloud<D>,
    derivatives: &'a Derivatives<'a, D>,
    /// In units of the spacing.
    width: f64,
}

impl<const D: usize> Run<'_, D> {
    /// (4.11), solved for the distance.
    fn distance(&self, psi: f64, h: f64) -> f64 {
        -std::f64::consts::SQRT_2 * self.width * h * psi.clamp(-SATURATED, SATURATED).atanh()
    }

    /// A stable time step, in units of the squared spacing of each node: steady states do not depend on it.
    fn time_step(&self) -> f64 {
        let band = self.derivatives.band();
        let rate = |(place, &i): (usize, &u32)| {
            let h = self.cloud.spacing()[i as usize];
            self.derivatives.stiffness(place) * h * h
        };
        let stiffest = band.iter().enumerate().map(rate).fold(1.0, f64::max);
        2.0 * STEP / (stiffest + 2.0 / (self.width * self.width))
    }

    /// Means over the neighbours and the node itself, weighted by `exp(-r^2 / h^2)`.
    fn average(&self, psi: &[f64]) -> Vec<f64> {
        self.on_band(psi, |place, i| self.mean(place, i, psi))
    }

    fn mean(&self, place: usize, i: usize, psi: &[f64]) -> f64 {
        let (points, h) = (self.cloud.points(), self.cloud.spacing()[i]);
        let weighted = self.derivatives.neighbors(place).iter().map(|&j| {
            let squared: f64 = (0..D).map(|k| (points[j as usize][k] - points[i][k]).powi(2)).sum();
            ((-squared / (h * h)).exp(), psi[j as usize])
        });
        let (mass, sum) = weighted.fold((1.0, psi[i]), |(m, s), (w, u)| (m + w, s + w * u));
        sum / mass
    }

    /// A new field: values at the nodes of the band, the same elsewhere.
    fn on_band(&self, psi: &[f64], value: impl Fn(usize, usize) -> f64 + Sync) -> Vec<f64> {
        let band = self.derivatives.band();
        let values = parallel::map(band.len(), |place| value(place, band[place] as usize));
        let mut next = psi.to_vec();
        band.iter().zip(values).for_each(|(&i, value)| next[i as usize] = value);
        next
    }

    fn step(&self, psi: &[f64], time_step: f64) -> Vec<f64> {
        let squared = self.width * self.width;
        let change = |place: usize, i: usize| {
            // One-sided second derivatives are no use for explicit steps: there the field follows its neighbours.
            if self.cloud.is_boundary(i) {
                return self.mean(place, i, psi);
            }
            let h = self.cloud.spacing()[i];
            let (second, _) = self.derivatives.at(place, psi).along_gradient();
            let rate = h * h * second + psi[i] * (1.0 - psi[i] * psi[i]) / squared;
            (psi[i] + time_step * rate).clamp(-1.0, 1.0)
        };
        self.on_band(psi, change)
    }

    /// Drift in spacings and defect of the profile.
    fn look(&self, start: &[f64], psi: &[f64]) -> (f64, f64) {
        let (mut growth, mut surface, mut defect, mut count) = (0.0, 0.0, 0.0, 0.0);
        for (place, &i) in self.derivatives.band().iter().enumerate() {
            let i = i as usize;
            let h = self.cloud.spacing()[i];
            let volume = h.powi(D as i32);
            let slope = self.derivatives.at(place, psi).along_gradient().1;
            // Nodes within half a spacing of the interface count in part. psi itself would not do: on a curved interface
            // its mean is not that of the step function, although nothing has moved.
            let inside = (0.5 - self.distance(psi[i], h) / h).clamp(0.0, 1.0);
            growth += volume * (inside - 0.5 * (1.0 + start[i])) / h;
            surface += 0.5 * volume * slope;
            if psi[i].abs() < NEAR {
                let profile = std::f64::consts::SQRT_2 * self.width * h * slope / (1.0 - psi[i] * psi[i]);
                defect += (profile - 1.0).abs();
                count += 1.0;
            }
        }
        let drift = if surface > 0.0 { growth / surface } else { f64::INFINITY };
        (drift, if count > 0.0 { defect / count } else { f64::INFINITY })
    }
}
