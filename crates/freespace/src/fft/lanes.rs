//! Several lines at once: a vector holds the same place of as many lines as it has lanes.

use pulp::{Arch, Simd, WithSimd};

/// Lanes that no processor exceeds.
pub(crate) const MOST: usize = 16;

/// Vectors of numbers of type `T`, of the width that the processor has.
pub trait Lanes<T>: Copy {
    /// A number of each line.
    type Pack: Copy;
    const COUNT: usize;
    fn splat(self, value: T) -> Self::Pack;
    fn add(self, a: Self::Pack, b: Self::Pack) -> Self::Pack;
    fn sub(self, a: Self::Pack, b: Self::Pack) -> Self::Pack;
    fn mul(self, a: Self::Pack, b: Self::Pack) -> Self::Pack;
    /// `a b + c`.
    fn mul_add(self, a: Self::Pack, b: Self::Pack, c: Self::Pack) -> Self::Pack;
    /// `c - a b`.
    fn mul_sub_from(self, a: Self::Pack, b: Self::Pack, c: Self::Pack) -> Self::Pack;
    fn packs(self, values: &[T]) -> &[Self::Pack];
    fn packs_mut(self, values: &mut [T]) -> &mut [Self::Pack];
    /// Rows and columns of a square of four by four exchanged. For vectors of four.
    fn transpose(self, rows: [Self::Pack; 4]) -> [Self::Pack; 4];
}

/// Work on vectors: what it does must not depend on how many lanes they have.
pub trait Work<T> {
    fn run<S: Lanes<T>>(self, simd: S);
}

/// Numbers that there are vectors of.
pub trait Vectors: Sized {
    /// Does work with the vectors of a processor.
    #[doc(hidden)]
    fn vectorize(arch: Arch, work: impl Work<Self>);
}

macro_rules! vectors {
    ($type:ty, $pack:ident, $count:ident, $splat:ident, $add:ident, $sub:ident, $mul:ident, $mul_add:ident, $negate_mul_add:ident,
     $packs:ident, $packs_mut:ident, $transpose:ident) => {
        impl<S: Simd> Lanes<$type> for S {
            type Pack = S::$pack;
            const COUNT: usize = S::$count;
            #[inline(always)]
            fn splat(self, value: $type) -> Self::Pack {
                self.$splat(value)
            }
            #[inline(always)]
            fn add(self, a: Self::Pack, b: Self::Pack) -> Self::Pack {
                self.$add(a, b)
            }
            #[inline(always)]
            fn sub(self, a: Self::Pack, b: Self::Pack) -> Self::Pack {
                self.$sub(a, b)
            }
            #[inline(always)]
            fn mul(self, a: Self::Pack, b: Self::Pack) -> Self::Pack {
                self.$mul(a, b)
            }
            #[inline(always)]
            fn mul_add(self, a: Self::Pack, b: Self::Pack, c: Self::Pack) -> Self::Pack {
                self.$mul_add(a, b, c)
            }
            #[inline(always)]
            fn mul_sub_from(self, a: Self::Pack, b: Self::Pack, c: Self::Pack) -> Self::Pack {
                self.$negate_mul_add(a, b, c)
            }
            #[inline(always)]
            fn packs(self, values: &[$type]) -> &[Self::Pack] {
                S::$packs(values).0
            }
            #[inline(always)]
            fn packs_mut(self, values: &mut [$type]) -> &mut [Self::Pack] {
                S::$packs_mut(values).0
            }
            #[inline(always)]
            fn transpose(self, rows: [Self::Pack; 4]) -> [Self::Pack; 4] {
                self.$transpose(rows)
            }
        }

        impl Vectors for $type {
            #[inline]
            fn vectorize(arch: Arch, work: impl Work<Self>) {
                struct Through<W>(W);
                impl<W: Work<$type>> WithSimd for Through<W> {
                    type Output = ();
                    #[inline(always)]
                    fn with_simd<S: Simd>(self, simd: S) {
                        self.0.run(simd);
                    }
                }
                arch.dispatch(Through(work));
            }
        }
    };
}

vectors!(
    f64,
    f64s,
    F64_LANES,
    splat_f64s,
    add_f64s,
    sub_f64s,
    mul_f64s,
    mul_add_f64s,
    negate_mul_add_f64s,
    as_simd_f64s,
    as_mut_simd_f64s,
    deinterleave_shfl_f64s
);
vectors!(
    f32,
    f32s,
    F32_LANES,
    splat_f32s,
    add_f32s,
    sub_f32s,
    mul_f32s,
    mul_add_f32s,
    negate_mul_add_f32s,
    as_simd_f32s,
    as_mut_simd_f32s,
    deinterleave_shfl_f32s
);

/// A complex number of each line: real and imaginary parts.
pub(crate) type Pair<P> = [P; 2];

#[inline(always)]
pub(super) fn add<T, S: Lanes<T>>(s: S, a: Pair<S::Pack>, b: Pair<S::Pack>) -> Pair<S::Pack> {
    [s.add(a[0], b[0]), s.add(a[1], b[1])]
}

#[inline(always)]
pub(super) fn sub<T, S: Lanes<T>>(s: S, a: Pair<S::Pack>, b: Pair<S::Pack>) -> Pair<S::Pack> {
    [s.sub(a[0], b[0]), s.sub(a[1], b[1])]
}

/// `a + i b`.
#[inline(always)]
pub(super) fn add_turned<T, S: Lanes<T>>(s: S, a: Pair<S::Pack>, b: Pair<S::Pack>) -> Pair<S::Pack> {
    [s.sub(a[0], b[1]), s.add(a[1], b[0])]
}

/// `a - i b`.
#[inline(always)]
pub(super) fn sub_turned<T, S: Lanes<T>>(s: S, a: Pair<S::Pack>, b: Pair<S::Pack>) -> Pair<S::Pack> {
    [s.add(a[0], b[1]), s.sub(a[1], b[0])]
}

/// `a + f b` with a real factor.
#[inline(always)]
pub(super) fn add_times<T, S: Lanes<T>>(
    s: S,
    a: Pair<S::Pack>,
    f: S::Pack,
    b: Pair<S::Pack>,
) -> Pair<S::Pack> {
    [s.mul_add(b[0], f, a[0]), s.mul_add(b[1], f, a[1])]
}

/// `a - f b` with a real factor.
#[inline(always)]
pub(super) fn sub_times<T, S: Lanes<T>>(
    s: S,
    a: Pair<S::Pack>,
    f: S::Pack,
    b: Pair<S::Pack>,
) -> Pair<S::Pack> {
    [s.mul_sub_from(b[0], f, a[0]), s.mul_sub_from(b[1], f, a[1])]
}

/// `a` times the same complex number in every line.
#[inline(always)]
pub(super) fn times<T: Copy, S: Lanes<T>>(s: S, a: Pair<S::Pack>, w: [T; 2]) -> Pair<S::Pack> {
    let (re, im) = (s.splat(w[0]), s.splat(w[1]));
    [s.mul_sub_from(a[1], im, s.mul(a[0], re)), s.mul_add(a[1], re, s.mul(a[0], im))]
}

/// The complex conjugate times i, which turns a forward transform into an inverse one.
#[inline(always)]
pub(super) fn swapped<P: Copy>(a: Pair<P>) -> Pair<P> {
    [a[1], a[0]]
}

#[cfg(test)]
mod tests {
    use pulp::Arch;

    use super::{Lanes, Vectors, Work};

    struct Squares;

    impl Work<f64> for Squares {
        fn run<S: Lanes<f64>>(self, s: S) {
            let numbers: Vec<f64> = (0..4 * S::COUNT).map(|i| i as f64).collect();
            let [a, b, c, d] = *s.packs(&numbers) else { return };
            let mut columns = vec![0.0; 4 * S::COUNT];
            s.packs_mut(&mut columns).copy_from_slice(&s.transpose([a, b, c, d]));
            if S::COUNT == 4 {
                assert!((0..16).all(|i| columns[i] == numbers[4 * (i % 4) + i / 4]));
            }
        }
    }

    /// Whole squares are transposed, what is left over is copied: both must mean the same lane.
    #[test]
    fn lanes_of_transposed_squares_are_in_order() {
        f64::vectorize(Arch::new(), Squares);
    }
}
