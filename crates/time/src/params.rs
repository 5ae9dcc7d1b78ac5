//! How accurate, and how often at most.

/// How to step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Params {
    /// Largest sum of the errors of all steps, relative to the largest solution met so far, in the norm of the system.
    /// Every step has its share of it, by its length.
    pub tolerance: f64,
    /// The time for which the tolerance is meant.
    pub whole: f64,
    /// First step; `None` tries one that is small beside the rate of change at the start.
    pub first_step: Option<f64>,
    /// Keep the step size whatever the error.
    pub fixed: bool,
    /// Give up after so many steps, those that were rejected included.
    pub max_steps: usize,
}

impl Default for Params {
    fn default() -> Self {
        Self { tolerance: 1e-4, whole: 1.0, first_step: None, fixed: false, max_steps: 100_000 }
    }
}
