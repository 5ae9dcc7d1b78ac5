//! Harmonic polynomials: 1 and x on the line, the real and imaginary parts of `(x + i y)^k` in the plane, solid
//! harmonics in space.

use super::basis::Jet;

/// Number of harmonic polynomials up to a degree, at least 1.
pub(super) const fn count<const D: usize>(degree: usize) -> usize {
    match D {
        1 => 2,
        2 => 2 * degree + 1,
        _ => (degree + 1) * (degree + 1),
    }
}

/// Writes values and gradients at z; the constant first, the coordinates after it.
pub(super) fn evaluate<const D: usize>(degree: usize, z: &[f64; D], jet: &mut Jet<D>) {
    jet.values[0] = 1.0;
    jet.gradients[0] = [0.0; D];
    match D {
        1 => {
            jet.values[1] = z[0];
            jet.gradients[1] = [1.0; D];
        }
        2 => plane(degree, z, jet),
        _ => space(degree, z, jet),
    }
}

fn plane<const D: usize>(degree: usize, z: &[f64; D], jet: &mut Jet<D>) {
    let (x, y) = (z[0], z[1]);
    let (mut re, mut im) = (1.0, 0.0);
    for k in 1..=degree {
        let (re_before, im_before) = (re, im);
        (re, im) = (re * x - im * y, re * y + im * x);
        let k_real = k as f64;
        jet.values[2 * k - 1] = re;
        jet.values[2 * k] = im;
        let (re_slope, im_slope) = (&mut [0.0; D], &mut [0.0; D]);
        (re_slope[0], re_slope[1]) = (k_real * re_before, -k_real * im_before);
        (im_slope[0], im_slope[1]) = (k_real * im_before, k_real * re_before);
        (jet.gradients[2 * k - 1], jet.gradients[2 * k]) = (*re_slope, *im_slope);
    }
}

/// A value with its gradient.
#[derive(Clone, Copy)]
struct Dual {
    value: f64,
    slope: [f64; 3],
}

impl Dual {
    const ZERO: Self = Self { value: 0.0, slope: [0.0; 3] };

    #[inline]
    fn coordinate(x: f64, axis: usize) -> Self {
        let mut slope = [0.0; 3];
        slope[axis] = 1.0;
        Self { value: x, slope }
    }

    #[inline]
    fn times(self, other: Self) -> Self {
        let slope = std::array::from_fn(|k| self.slope[k] * other.value + self.value * other.slope[k]);
        Self { value: self.value * other.value, slope }
    }

    #[inline]
    fn combine(a: f64, one: Self, b: f64, other: Self) -> Self {
        let slope = std::array::from_fn(|k| a * one.slope[k] + b * other.slope[k]);
        Self { value: a * one.value + b * other.value, slope }
    }
}

/// `(x + i y)^m` times the polynomials `Q_l^m(z, r^2)` that remain of the associated Legendre functions:
/// `(l - m) Q_l^m = (2 l - 1) z Q_(l-1)^m - (l + m - 1) r^2 Q_(l-2)^m` with `Q_m^m = 1`; in Schmidt's normalisation, so
/// that none exceeds the size of the others on the unit sphere.
fn space<const D: usize>(degree: usize, at: &[f64; D], jet: &mut Jet<D>) {
    let (x, y, z) = (Dual::coordinate(at[0], 0), Dual::coordinate(at[1], 1), Dual::coordinate(at[2], 2));
    let square = |d: Dual| d.times(d);
    let r2 = Dual::combine(1.0, Dual::combine(1.0, square(x), 1.0, square(y)), 1.0, square(z));
    let mut put = |place: usize, dual: Dual, factor: f64| {
        jet.values[place] = factor * dual.value;
        jet.gradients[place] = std::array::from_fn(|k| factor * dual.slope[k]);
    };
    let (mut re, mut im) = (Dual { value: 1.0, slope: [0.0; 3] }, Dual::ZERO);
    // (2 m - 1)!! sqrt(1 / (2 m)!), the normalisation of Q_m^m.
    let mut norm_mm = 1.0;
    for m in 0..=degree {
        if m > 0 {
            (re, im) = (
                Dual::combine(1.0, re.times(x), -1.0, im.times(y)),
                Dual::combine(1.0, re.times(y), 1.0, im.times(x)),
            );
            norm_mm *= ((2 * m - 1) as f64 / (2 * m) as f64).sqrt();
        }
        let (mut q, mut before) = (Dual { value: 1.0, slope: [0.0; 3] }, Dual::ZERO);
        let mut norm = norm_mm;
        for l in m..=degree {
            if l > m {
                let step =
                    Dual::combine((2 * l - 1) as f64, q.times(z), -((l + m - 1) as f64), before.times(r2));
                before = q;
                q = Dual::combine(1.0 / (l - m) as f64, step, 0.0, Dual::ZERO);
                norm *= ((l - m) as f64 / (l + m) as f64).sqrt();
            }
            match (l, m) {
                (0, _) => {}
                (1, 0) => put(3, q, 1.0),
                (1, _) => {
                    put(1, re, 1.0);
                    put(2, im, 1.0);
                }
                (_, 0) => put(l * l, q, 1.0),
                _ => {
                    let factor = std::f64::consts::SQRT_2 * norm;
                    put(l * l + 2 * m - 1, q.times(re), factor);
                    put(l * l + 2 * m, q.times(im), factor);
                }
            }
        }
    }
}
