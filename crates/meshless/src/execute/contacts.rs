//! Stiff regions that touch in a point, or along a line.
//!
//! All that flows from one to the other goes through the tip of the gap between them, which is thinner there than any spacing: the error
//! falls with the root of the spacing, on both clouds of an estimate alike (docs/sharp.md, Limits).

use meshless_geometry::{Contact, FaceId};
use meshless_interfaces::{Condition, Problem};

use crate::report::ContactReport;
use crate::scene::Scene;

/// Diffusivity over that of the gap from which on a region is stiff: two discs of ten times the diffusivity have errors of twice to
/// seven times the estimate, of a third of it none that matters.
const STIFF: f64 = 10.0;

/// How near to a face a contact with it is, in spacings.
const AT_FACE: f64 = 1e-2;

/// Where regions touch that conduct much better than the gap between them, or one touches a wall where u is prescribed.
pub(crate) fn contacts<const D: usize>(scene: &Scene, problem: &Problem<'_, D>) -> Vec<ContactReport> {
    if problem.contrast() < STIFF {
        return Vec::new();
    }
    let all = problem.regions.contacts(problem.cloud, problem.domain);
    let name = |region: Option<u16>| match region {
        Some(region) => scene.regions[region as usize].name.clone(),
        None => "boundary".to_owned(),
    };
    let tight =
        all.iter().filter(|contact| contact.between.iter().all(|&side| is_stiff(problem, contact, side)));
    tight
        .map(|contact| ContactReport {
            at: contact.at.to_vec(),
            between: contact.between.map(name).to_vec(),
            gap: name(Some(contact.gap)),
        })
        .collect()
}

/// Whether what lies on a side of a contact holds u, as seen from the gap.
fn is_stiff<const D: usize>(problem: &Problem<'_, D>, contact: &Contact<D>, side: Option<u16>) -> bool {
    let eta = |region: u16| problem.materials[region as usize].diffusivity.at(&contact.at);
    match side {
        Some(region) => eta(region) >= STIFF * eta(contact.gap),
        None => {
            (0..problem.domain.faces().len()).any(|face| prescribes(problem, contact, FaceId(face as u16)))
        }
    }
}

/// Whether u is prescribed on a face where a contact is.
fn prescribes<const D: usize>(problem: &Problem<'_, D>, contact: &Contact<D>, face: FaceId) -> bool {
    problem.domain.project_to_face(face, &contact.at).is_ok_and(|foot| {
        foot.distance.abs() < AT_FACE * contact.spacing
            && matches!(problem.boundary.condition(face, &foot.point), Some(Condition::Dirichlet(_)))
    })
}
