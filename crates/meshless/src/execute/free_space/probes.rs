//! Values at the probes, by the sum over all points that defines the field: as accurate between the points of the mesh as at
//! them, and outside of the box, too.

use meshless_freespace::{Gaussian, Kernel, Radial, Spectral};
use rayon::prelude::*;

use super::Source;
use crate::Error;
use crate::plan::Transforms;
use crate::report::Probe;
use crate::scene::Scene;

/// Points whose contributions to a probe are added up together.
const BLOCK: usize = 4096;

/// Values and slopes of a kernel.
enum Green<const D: usize> {
    Gaussian(Gaussian<D>),
    Spectral(Spectral<D>),
}

impl<const D: usize> Green<D> {
    fn new(kernel: Kernel, coarsest: f64) -> Result<Self, Error> {
        Ok(match kernel {
            Kernel::Gaussian { order, smoothing } => {
                Self::Gaussian(Gaussian::new(order, smoothing.unwrap_or(2.0) * coarsest)?)
            }
            // Where the mesh resolves the source, the two are the same.
            Kernel::Spectral | Kernel::Truncated => {
                Self::Spectral(Spectral::new(coarsest / std::f64::consts::PI)?)
            }
        })
    }

    fn value(&self, r: f64) -> f64 {
        match self {
            Self::Gaussian(kernel) => kernel.value(r),
            Self::Spectral(kernel) => kernel.value(r),
        }
    }

    /// The gradient of the kernel at `x`.
    fn gradient(&self, x: [f64; D]) -> [f64; D] {
        let r = super::report::length(&x);
        if r == 0.0 {
            return [0.0; D];
        }
        let slope = match self {
            Self::Gaussian(kernel) => kernel.slope(r),
            Self::Spectral(kernel) => kernel.slope(r),
        };
        x.map(|x| x / r * slope)
    }
}

pub(super) fn probes<const D: usize>(
    scene: &Scene,
    source: &Source<D>,
    kernel: Kernel,
    transforms: Transforms,
) -> Result<Vec<Probe>, Error> {
    let green = Green::new(kernel, source.mesh.spacing().into_iter().fold(0.0, f64::max))?;
    let probe = |at: &Vec<f64>| {
        let x = std::array::from_fn(|a| at[a]);
        let value = transforms.potential.then(|| {
            let of = |i: usize, d: [f64; D]| [source.values[i] * green.value(super::report::length(&d))];
            sum(source, &x, |i| source.values[i] != 0.0, of)[0]
        });
        let turns = |i: usize| source.vorticity.iter().any(|w| w[i] != 0.0);
        let velocity = (transforms.vorticity > 0).then(|| {
            let counts = |i: usize| turns(i) || source.values[i] != 0.0;
            let of = |i: usize, d: [f64; D]| induced(source, i, green.gradient(d));
            sum(source, &x, counts, of).to_vec()
        });
        // Where there is a vorticity alone, u is zero.
        Probe { at: at.clone(), value: Some(value.unwrap_or(0.0)), velocity, ..Probe::default() }
    };
    Ok(scene.probes.iter().map(probe).collect())
}

/// `curl (G w) - grad (G f)` of what is at a point, from the gradient of G.
fn induced<const D: usize>(source: &Source<D>, point: usize, g: [f64; D]) -> [f64; D] {
    let mut v = g.map(|g| -g * source.values[point]);
    match &source.vorticity[..] {
        [w] if D == 2 => {
            v[0] += g[1] * w[point];
            v[1] -= g[0] * w[point];
        }
        [_, _, _] if D == 3 => {
            for (axis, v) in v.iter_mut().enumerate() {
                let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
                *v += g[next] * source.vorticity[last][point] - g[last] * source.vorticity[next][point];
            }
        }
        _ => {}
    }
    v
}

/// The sum over all points that count of a function of the point and of the way from it to `at`, times the volume of a cell. Blocks of
/// fixed size are added up in their order: the number of threads does not show.
fn sum<const D: usize, const C: usize>(
    source: &Source<D>,
    at: &[f64; D],
    counts: impl Fn(usize) -> bool + Sync,
    of: impl Fn(usize, [f64; D]) -> [f64; C] + Sync,
) -> [f64; C] {
    let blocks = source.points.par_chunks(BLOCK).enumerate().map(|(block, points)| {
        let mut sum = [0.0; C];
        for (i, p) in points.iter().enumerate() {
            let i = block * BLOCK + i;
            if counts(i) {
                let part = of(i, std::array::from_fn(|a| at[a] - p[a]));
                sum.iter_mut().zip(part).for_each(|(s, p)| *s += p);
            }
        }
        sum
    });
    let parts: Vec<[f64; C]> = blocks.collect();
    let all = parts.into_iter().fold([0.0; C], |mut all, part| {
        all.iter_mut().zip(part).for_each(|(s, p)| *s += p);
        all
    });
    all.map(|sum| sum * source.mesh.cell_volume())
}
