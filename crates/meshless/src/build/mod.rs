//! From the data of a scene to geometry, fields and conditions.

mod checks;
mod conditions;
mod corners;
mod features;
mod fields;
mod line;
mod mesh;
mod points;
mod shapes;
mod slits;
mod smooth;
mod surfaces;
mod survey;

pub(crate) use checks::{check_interfaces_touch, check_regions_are_met};
pub(crate) use conditions::{Boundary, missing_condition};
pub(crate) use corners::{AtCorners, singular_corners};
pub(crate) use fields::{
    check_coefficients, exact, field, law_rates, laws, materials, nodal_diffusivity, nodal_source,
    nodal_vorticity,
};
pub(crate) use line::{Line, LineData, lines};
pub(crate) use mesh::{free_mesh, mesh_cells, particles};
pub(crate) use points::{Placed, has_features, place};
pub(crate) use shapes::{domain, regions, with_spacing_times};
pub(crate) use slits::slits;
pub(crate) use smooth::check_diffusivity_is_smooth;
pub(crate) use surfaces::{has_creased_regions, triangle_counts};
pub(crate) use survey::{estimated_nodes, is_curved, sampled_contrast, sampled_peclet};
