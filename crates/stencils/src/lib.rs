//! Local least-squares stencils for derivatives on scattered points, in one, two and three dimensions.
//!
//! A [`LocalFit`] factors the moment matrix of a support once and gives the coefficients of any operator on it:
//! value, partial derivatives, Laplacian, `div(eta grad)`, directional derivative ([`Functional`]). Coefficients are
//! exact for polynomials to a chosen degree and of least weighted norm (Kraus et al. 2022, (10)), which is the same as
//! to apply the operator to a weighted least-squares polynomial. Where the plain factorisation is not safe a
//! rank-revealing one takes its place; an operator that the support does not determine is an error with its figures.
//!
//! Polynomials to degree p make a derivative of order k converge with order p + 1 - k: for second order of a Laplacian
//! take degree 3, or degree 2 where supports are symmetric about their node. [`build_stencils`] does all points of a
//! cloud in parallel; [`LocalFit::diagnose`] tells good stencils from bad ones.
//!
//! [`DcPse`] offers the operators of discretisation-corrected particle strength exchange on the same engine, and
//! [`ConstrainedFit`] fits under linear constraints, as the conditions at an interface are.
//!
//! **Not for** finding supports (see `meshless-neighbors`), and not for interpolation of large data sets.
//!
//! # Example
//!
//! ```
//! use meshless_stencils::{FitParams, Functional, LocalFit, Weight};
//!
//! // Nine points of a lattice; the Laplacian of x^2 + 3 y^2 is 8.
//! let offsets: Vec<[f64; 2]> =
//!     (0..9).map(|i| [0.1 * f64::from(i % 3 - 1), 0.1 * f64::from(i / 3 - 1)]).collect();
//! let weights: Vec<f64> =
//!     offsets.iter().map(|[x, y]| Weight::Exponential.value(x.hypot(*y), 0.2, 0.2)).collect();
//! let fit = LocalFit::<2>::new(FitParams::default());
//! let mut scratch = fit.scratch(9);
//! fit.factor(&offsets, &weights, 0.2, &mut scratch)?;
//! let mut laplacian = [0.0; 9];
//! fit.coefficients(&Functional::Laplacian, &mut scratch, &mut laplacian)?;
//! let value: f64 = laplacian.iter().zip(&offsets).map(|(c, [x, y])| c * (x * x + 3.0 * y * y)).sum();
//! assert!((value - 8.0).abs() < 1e-10);
//! # Ok::<(), meshless_stencils::StencilError>(())
//! ```

mod basis;
mod constrained;
mod dcpse;
mod diagnosis;
mod error;
mod fit;
mod functional;
mod monomials;
mod qr;
mod scratch;
mod set;
mod weight;

pub use basis::BasisValues;
pub use constrained::ConstrainedFit;
pub use dcpse::{DcPse, DcPseScratch};
pub use diagnosis::{SignDiagnosis, StencilDiagnosis};
pub use error::StencilError;
pub use fit::{FitDiagnosis, FitParams, LocalFit, REPRODUCTION_TOLERANCE};
pub use functional::Functional;
pub use monomials::Monomials;
pub use qr::Qr;
pub use scratch::FitScratch;
pub use set::{StencilSet, build_stencils};
pub use weight::Weight;
