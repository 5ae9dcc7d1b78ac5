//! Small vector arithmetic on plain arrays; everything is inlined into the loops that use it.

#[inline]
pub(crate) fn dot<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    let mut s = 0.0;
    for i in 0..D {
        s += a[i] * b[i];
    }
    s
}

#[inline]
pub(crate) fn sub<const D: usize>(a: &[f64; D], b: &[f64; D]) -> [f64; D] {
    std::array::from_fn(|i| a[i] - b[i])
}

/// `a + t b`.
#[inline]
pub(crate) fn axpy<const D: usize>(a: &[f64; D], t: f64, b: &[f64; D]) -> [f64; D] {
    std::array::from_fn(|i| a[i] + t * b[i])
}

#[inline]
pub(crate) fn scale<const D: usize>(t: f64, a: &[f64; D]) -> [f64; D] {
    a.map(|v| t * v)
}

#[inline]
pub(crate) fn norm<const D: usize>(a: &[f64; D]) -> f64 {
    dot(a, a).sqrt()
}

#[inline]
pub(crate) fn distance_squared<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    let d = sub(a, b);
    dot(&d, &d)
}

#[inline]
pub(crate) fn distance<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    distance_squared(a, b).sqrt()
}

/// `a / |a|`, or `None` where the length is zero, subnormal or not finite.
#[inline]
pub(crate) fn normalized<const D: usize>(a: &[f64; D]) -> Option<[f64; D]> {
    // Scaling by the largest entry first keeps the squares of very large and very small gradients in range.
    let largest = a.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    if !(largest.is_normal() && a.iter().all(|v| v.is_finite())) {
        return None;
    }
    let b = a.map(|v| v / largest);
    let length = norm(&b);
    Some(b.map(|v| v / length))
}

#[inline]
pub(crate) fn is_finite<const D: usize>(a: &[f64; D]) -> bool {
    a.iter().all(|v| v.is_finite())
}

/// The largest absolute coordinate.
#[inline]
pub(crate) fn max_abs<const D: usize>(a: &[f64; D]) -> f64 {
    a.iter().fold(0.0, |m, v| m.max(v.abs()))
}

/// The unit vector along `axis`, times `sign`.
#[inline]
pub(crate) fn axis_vector<const D: usize>(axis: usize, sign: f64) -> [f64; D] {
    std::array::from_fn(|i| if i == axis { sign } else { 0.0 })
}
