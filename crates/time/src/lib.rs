//! Adaptive implicit time steps for `M du/dt + A(t) u = b(t)`, as space discretisations of diffusion leave it.
//!
//! For: linear stiff systems of any size, with a mass matrix M that may have zero rows (algebraic rows: prescribed values and
//! boundary conditions). The caller implements [`Semidiscrete`], with the linear solver of their choice. Where M is not
//! diagonal, values have to fulfil the algebraic rows from the start: [`Semidiscrete::make_consistent`].
//!
//! Not for: right-hand sides that are not linear, or algebraic rows that do not determine their unknowns (index 2).
//!
//! The method is TR-BDF2 (Bank et al. 1985; Hosea and Shampine 1996, "Analysis and implementation of TR-BDF2"): order
//! 2, L-stable, stiffly accurate, with an embedded error estimate of order 3. Both implicit stages have the same matrix
//! `M / c + A`, and the step size changes seldom, so that a factorisation serves many steps.
//!
//! Rows that were made for their accuracy may have modes that grow where those of diffusion decay, and a solution that follows them
//! looks as smooth as any. So eigenvalues of a step are looked for beside the steps, and a run ends where by the steps taken a mode has grown a
//! hundredfold: [`StepError::Grows`]. That takes a few more solves for every matrix; [`Semidiscrete::may_grow`] saves them where
//! rows are known to be harmless.
//!
//! ```
//! use meshless_time::{Params, Semidiscrete, Stepper};
//!
//! /// `du/dt = -rate (u - cos t)`
//! struct Relaxation { rate: f64 }
//!
//! impl Semidiscrete for Relaxation {
//!     type Error = std::convert::Infallible;
//!     fn slope(&mut self, t: f64, u: &[f64], out: &mut [f64]) -> Result<(), Self::Error> {
//!         out[0] = -self.rate * (u[0] - t.cos());
//!         Ok(())
//!     }
//!     fn solve(&mut self, t: f64, c: f64, v: &[f64], u: &mut [f64]) -> Result<(), Self::Error> {
//!         u[0] = (v[0] / c + self.rate * t.cos()) / (1.0 / c + self.rate);
//!         Ok(())
//!     }
//!     fn damp(&mut self, _t: f64, c: f64, e: &mut [f64]) -> Result<(), Self::Error> {
//!         e[0] /= 1.0 + c * self.rate;
//!         Ok(())
//!     }
//!     fn norm(&self, e: &[f64]) -> f64 { e[0].abs() }
//! }
//!
//! let params = Params { tolerance: 1e-5, whole: 2.0, ..Params::default() };
//! let mut stepper = Stepper::new(Relaxation { rate: 1e4 }, 0.0, vec![0.0], params)?;
//! stepper.advance_to(2.0)?;
//! // The solution follows cos t, a ten-thousandth behind.
//! assert!((stepper.state().u[0] - 2.0_f64.cos()).abs() < 2e-4);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod complex;
mod error;
mod growth;
mod hessenberg;
mod krylov;
mod params;
mod state;
mod stepper;
mod system;
mod tableau;

pub use error::StepError;
pub use growth::{Past, Spell};
pub use params::Params;
pub use state::State;
pub use stepper::Stepper;
pub use system::Semidiscrete;
