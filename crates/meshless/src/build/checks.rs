//! Checks of a scene that need the cloud.

use meshless_neighbors::NeighborLists;

use crate::Error;
use crate::scene::Scene;

/// Every region must have a node.
pub(crate) fn check_regions_are_met(scene: &Scene, labels: &[u16]) -> Result<(), Error> {
    let mut met = vec![false; scene.regions.len()];
    labels.iter().for_each(|&l| met[l as usize] = true);
    match met.iter().position(|&m| !m) {
        None => Ok(()),
        Some(region) => {
            let spec = &scene.regions[region];
            let message = format!("no node lies in the region \"{}\"", spec.name);
            let help = "it is outside of the domain, covered by the regions before it, or thinner than the spacing: \
                        remove it, move it, or use a smaller spacing";
            Err(Error::TooCoarse(Box::new(spec.place.error(message, help))))
        }
    }
}

/// The regions of an interface entry must touch.
pub(crate) fn check_interfaces_touch(
    scene: &Scene,
    labels: &[u16],
    lists: &NeighborLists,
) -> Result<(), Error> {
    for spec in &scene.interfaces {
        let [a, b] = spec.between.map(|r| r as u16);
        let touch = labels
            .iter()
            .enumerate()
            .any(|(i, &label)| label == a && lists.of(i).iter().any(|&j| labels[j as usize] == b));
        if !touch {
            let [a, b] = spec.between.map(|r| &scene.regions[r].name);
            let message = format!(
                "the regions \"{a}\" and \"{b}\" do not touch anywhere, so nothing can jump between them"
            );
            let help = "remove the entry, or name regions that share an interface";
            return Err(Error::TooCoarse(Box::new(spec.place.error(message, help))));
        }
    }
    Ok(())
}
