//! Particles that carry a part of the source, and the fields at them.

use meshless_freespace::{Mesh, Spread};

use crate::scene::{ParticlesSpec, SpreadName};
use crate::{Error, ParticleField, build};

/// Particles of a scene.
pub(super) struct Carried<const D: usize> {
    positions: Vec<[f64; D]>,
    strengths: Vec<f64>,
    spread: Spread,
}

impl<const D: usize> Carried<D> {
    pub(super) fn from_file(spec: &ParticlesSpec) -> Result<Self, Error> {
        let (positions, strengths) = build::particles::<D>(spec)?;
        let spread = match spec.spread {
            SpreadName::M4Prime => Spread::M4Prime,
            SpreadName::M6Star => Spread::M6Star,
        };
        Ok(Self { positions, strengths, spread })
    }

    /// What they are on the mesh.
    pub(super) fn density(&self, mesh: &Mesh<D>) -> Result<Vec<f64>, Error> {
        Ok(self.spread.deposit(mesh, &self.positions, &self.strengths)?)
    }

    /// Fields of the mesh at the particles, by the weights that they were deposited with.
    pub(super) fn read(
        &self,
        mesh: &Mesh<D>,
        u: &[f64],
        gradient: Option<&[[f64; D]]>,
        velocity: Option<&[[f64; D]]>,
    ) -> Result<ParticleField, Error> {
        let vectors = |field: &[[f64; D]]| -> Result<Vec<[f64; 3]>, Error> {
            let mut vectors = vec![[0.0; 3]; self.positions.len()];
            for axis in 0..D {
                let component: Vec<f64> = field.iter().map(|v| v[axis]).collect();
                let values = self.spread.read(mesh, &component, &self.positions)?;
                vectors.iter_mut().zip(values).for_each(|(vector, value)| vector[axis] = value);
            }
            Ok(vectors)
        };
        Ok(ParticleField {
            dimension: D,
            positions: self.positions.iter().map(crate::field::padded).collect(),
            strengths: self.strengths.clone(),
            u: self.spread.read(mesh, u, &self.positions)?,
            gradient: gradient.map(vectors).transpose()?,
            velocity: velocity.map(vectors).transpose()?,
        })
    }
}
