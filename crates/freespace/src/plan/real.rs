//! The numbers that fields are made of.

use std::ops::RangeInclusive;
use std::sync::Arc;

use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};
use rustfft::{Fft, FftNum, FftPlanner};

use crate::fft::Vectors;

/// `f64` or `f32`: the type of the values and of the transforms. Kernels are evaluated in `f64` always.
pub trait Real: FftNum + Default + Vectors {
    /// The nearest number of this type.
    fn rounded(value: f64) -> Self;
    /// The same number.
    fn widened(self) -> f64;
    /// Numbers of this type in the same memory, if they are those given.
    #[doc(hidden)]
    fn same(values: Vec<f64>) -> Result<Vec<Self>, Vec<f64>>;
    /// Spacings that fields and kernels, which go with their square, are numbers for: of `f32` 1e-12 to 1e12.
    fn spacings() -> RangeInclusive<f64>;
    /// Mean of a source that is the round-off of its sum.
    #[doc(hidden)]
    fn epsilon() -> f64;
    /// Complex transforms of a length, forward and back. Here rather than where they are used, so that the many
    /// transforms of the library are compiled with this crate and not with every crate that has a plan.
    #[doc(hidden)]
    fn complex(len: usize) -> [Arc<dyn Fft<Self>>; 2];
    /// Transforms from real numbers and back.
    #[doc(hidden)]
    fn real(len: usize) -> (Arc<dyn RealToComplex<Self>>, Arc<dyn ComplexToReal<Self>>);
}

/// The planners are generic inside of the library.
macro_rules! transforms {
    () => {
        fn complex(len: usize) -> [Arc<dyn Fft<Self>>; 2] {
            let mut planner = FftPlanner::new();
            [planner.plan_fft_forward(len), planner.plan_fft_inverse(len)]
        }
        fn real(len: usize) -> (Arc<dyn RealToComplex<Self>>, Arc<dyn ComplexToReal<Self>>) {
            let mut planner = RealFftPlanner::new();
            (planner.plan_fft_forward(len), planner.plan_fft_inverse(len))
        }
    };
}

impl Real for f64 {
    fn rounded(value: f64) -> Self {
        value
    }
    fn same(values: Vec<f64>) -> Result<Vec<Self>, Vec<f64>> {
        Ok(values)
    }
    fn spacings() -> RangeInclusive<f64> {
        0.0..=f64::INFINITY
    }
    fn epsilon() -> f64 {
        1e-13
    }
    fn widened(self) -> f64 {
        self
    }
    transforms!();
}

impl Real for f32 {
    fn rounded(value: f64) -> Self {
        value as Self
    }
    fn same(values: Vec<f64>) -> Result<Vec<Self>, Vec<f64>> {
        Err(values)
    }
    fn spacings() -> RangeInclusive<f64> {
        1e-12..=1e12
    }
    fn epsilon() -> f64 {
        1e-5
    }
    fn widened(self) -> f64 {
        f64::from(self)
    }
    transforms!();
}
