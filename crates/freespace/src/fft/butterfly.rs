//! Discrete Fourier transforms of a few numbers, `y_k = sum x_j exp(-2 pi i j k / r)`.

use std::f64::consts::FRAC_1_SQRT_2;

use super::lanes::{Lanes, Pair, add, add_times, add_turned, sub, sub_times, sub_turned};
use crate::plan::Real;

/// sin(2 pi / 3).
const SINE_OF_THIRD: f64 = 0.866_025_403_784_438_6;
/// Cosine and sine of 2 pi / 5 and 4 pi / 5.
const COSINES_OF_FIFTHS: [f64; 2] = [0.309_016_994_374_947_45, -0.809_016_994_374_947_5];
const SINES_OF_FIFTHS: [f64; 2] = [0.951_056_516_295_153_5, 0.587_785_252_292_473_1];

#[inline(always)]
pub(super) fn two<T: Real, S: Lanes<T>>(s: S, [a, b]: [Pair<S::Pack>; 2]) -> [Pair<S::Pack>; 2] {
    [add(s, a, b), sub(s, a, b)]
}

#[inline(always)]
pub(super) fn three<T: Real, S: Lanes<T>>(s: S, [a, b, c]: [Pair<S::Pack>; 3]) -> [Pair<S::Pack>; 3] {
    let (half, height) = (s.splat(T::rounded(0.5)), s.splat(T::rounded(SINE_OF_THIRD)));
    let (sum, difference) = (add(s, b, c), sub(s, b, c));
    let middle = sub_times(s, a, half, sum);
    let turned = [s.mul(difference[0], height), s.mul(difference[1], height)];
    [add(s, a, sum), sub_turned(s, middle, turned), add_turned(s, middle, turned)]
}

#[inline(always)]
pub(super) fn four<T: Real, S: Lanes<T>>(s: S, [a, b, c, d]: [Pair<S::Pack>; 4]) -> [Pair<S::Pack>; 4] {
    let (p, q, r, t) = (add(s, a, c), sub(s, a, c), add(s, b, d), sub(s, b, d));
    [add(s, p, r), sub_turned(s, q, t), sub(s, p, r), add_turned(s, q, t)]
}

#[inline(always)]
pub(super) fn five<T: Real, S: Lanes<T>>(s: S, [a, b, c, d, e]: [Pair<S::Pack>; 5]) -> [Pair<S::Pack>; 5] {
    let ([p, q], [u, v]) = (COSINES_OF_FIFTHS, SINES_OF_FIFTHS);
    let cosine = [s.splat(T::rounded(p)), s.splat(T::rounded(q))];
    let sine = [s.splat(T::rounded(u)), s.splat(T::rounded(v))];
    let (near, far) = (add(s, b, e), add(s, c, d));
    let (turned, twice) = (sub(s, b, e), sub(s, c, d));
    let p = add_times(s, add_times(s, a, cosine[0], near), cosine[1], far);
    let q = add_times(s, add_times(s, a, cosine[1], near), cosine[0], far);
    let u = [s.mul(turned[0], sine[0]), s.mul(turned[1], sine[0])];
    let v = [s.mul(turned[0], sine[1]), s.mul(turned[1], sine[1])];
    let (u, v) = (add_times(s, u, sine[1], twice), sub_times(s, v, sine[0], twice));
    [
        add(s, a, add(s, near, far)),
        sub_turned(s, p, u),
        sub_turned(s, q, v),
        add_turned(s, q, v),
        add_turned(s, p, u),
    ]
}

#[inline(always)]
pub(super) fn eight<T: Real, S: Lanes<T>>(s: S, x: [Pair<S::Pack>; 8]) -> [Pair<S::Pack>; 8] {
    let even = four(s, [x[0], x[2], x[4], x[6]]);
    let odd = four(s, [x[1], x[3], x[5], x[7]]);
    let half = s.splat(T::rounded(FRAC_1_SQRT_2));
    // The odd ones times exp(-i pi k / 4): `(1 - i) / sqrt 2` and `-(1 + i) / sqrt 2` without the root.
    let first = sub_turned(s, odd[1], odd[1]);
    let third = add_turned(s, odd[3], odd[3]);
    [
        add(s, even[0], odd[0]),
        add_times(s, even[1], half, first),
        sub_turned(s, even[2], odd[2]),
        sub_times(s, even[3], half, third),
        sub(s, even[0], odd[0]),
        sub_times(s, even[1], half, first),
        add_turned(s, even[2], odd[2]),
        add_times(s, even[3], half, third),
    ]
}
