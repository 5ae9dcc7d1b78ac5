//! Particles that carry strengths, and the mesh.

use crate::error::FreeSpaceError;
use crate::mesh::{Centring, Mesh};
use crate::refine::{m4_prime, m6_star};

/// How strengths are spread over the points of a mesh, and values read back from them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Spread {
    /// M4' (Monaghan 1985): four points in each direction; moments up to 2 are kept.
    M4Prime,
    /// M6* (van Rees et al. 2011): six points in each direction; moments up to 4 are kept.
    #[default]
    M6Star,
}

impl Spread {
    fn half_width(self) -> usize {
        match self {
            Self::M4Prime => 2,
            Self::M6Star => 3,
        }
    }

    fn weight(self, x: f64) -> f64 {
        match self {
            Self::M4Prime => m4_prime(x),
            Self::M6Star => m6_star(x),
        }
    }

    /// A density on the mesh whose sum times the volume of a cell is that of the strengths, and whose further moments are
    /// those of the particles as far as the kernel keeps them.
    ///
    /// # Errors
    /// Positions and strengths of different numbers or not finite, or a particle too close to the edge of the mesh.
    pub fn deposit<const D: usize>(
        self,
        mesh: &Mesh<D>,
        positions: &[[f64; D]],
        strengths: &[f64],
    ) -> Result<Vec<f64>, FreeSpaceError> {
        crate::plan::check_values("list of strengths", strengths, positions.len())?;
        let mut density = vec![0.0; mesh.len()];
        let volume = mesh.cell_volume();
        for (particle, (position, strength)) in positions.iter().zip(strengths).enumerate() {
            let stencil = self.stencil(mesh, particle, *position)?;
            stencil.each(mesh, |point, weight| density[point] += weight * strength / volume);
        }
        Ok(density)
    }

    /// Values of a field on the mesh at positions.
    ///
    /// # Errors
    /// A field of the wrong length or with values that are not finite, or a position too close to the edge of the mesh.
    pub fn read<const D: usize>(
        self,
        mesh: &Mesh<D>,
        field: &[f64],
        positions: &[[f64; D]],
    ) -> Result<Vec<f64>, FreeSpaceError> {
        crate::plan::check_values("field", field, mesh.len())?;
        let value = |(particle, position): (usize, &[f64; D])| {
            let mut sum = 0.0;
            self.stencil(mesh, particle, *position)?.each(mesh, |point, weight| sum += weight * field[point]);
            Ok(sum)
        };
        positions.iter().enumerate().map(value).collect()
    }

    /// The points around a position and their weights.
    fn stencil<const D: usize>(
        self,
        mesh: &Mesh<D>,
        particle: usize,
        position: [f64; D],
    ) -> Result<Stencil<D>, FreeSpaceError> {
        let half = self.half_width();
        let mut stencil = Stencil { first: [0; D], count: 2 * half, weights: [[0.0; 6]; D] };
        for a in 0..D {
            let offset = if mesh.centring() == Centring::Cell { 0.5 } else { 0.0 };
            let place = (position[a] - mesh.min()[a]) / mesh.spacing()[a] - offset;
            let first = place.floor() - (half - 1) as f64;
            if !(first >= 0.0 && first + (2 * half) as f64 <= mesh.points()[a] as f64) {
                return Err(FreeSpaceError::Particle { particle, axis: a, at: position[a], points: half });
            }
            stencil.first[a] = first as usize;
            for (k, weight) in stencil.weights[a][..2 * half].iter_mut().enumerate() {
                *weight = self.weight(place - first - k as f64);
            }
        }
        Ok(stencil)
    }
}

/// Weights of a block of points, as products of those of each direction.
struct Stencil<const D: usize> {
    first: [usize; D],
    count: usize,
    weights: [[f64; 6]; D],
}

impl<const D: usize> Stencil<D> {
    fn each(&self, mesh: &Mesh<D>, mut visit: impl FnMut(usize, f64)) {
        for place in 0..self.count.pow(D as u32) {
            let (mut rest, mut weight, mut indices) = (place, 1.0, self.first);
            for a in 0..D {
                weight *= self.weights[a][rest % self.count];
                indices[a] += rest % self.count;
                rest /= self.count;
            }
            visit(mesh.index(indices), weight);
        }
    }
}
