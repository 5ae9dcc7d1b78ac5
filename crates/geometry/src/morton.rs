use crate::aabb::Aabb;

/// Order of the points along the Morton (Z) curve through their bounding box: neighbours in space are mostly
/// neighbours in memory. Points in the same cell of the curve keep their order.
pub(crate) fn morton_order<const D: usize>(points: &[[f64; D]], bounds: &Aabb<D>) -> Vec<u32> {
    let bits = 63 / D as u32;
    let bits = bits.min(31);
    let cells = (1_u64 << bits) as f64;
    let longest = bounds.lengths().iter().fold(0.0_f64, |a, &b| a.max(b));
    let key = |x: &[f64; D]| {
        let mut key = 0_u64;
        for axis in 0..D {
            let cell = (((x[axis] - bounds.min[axis]) / longest * cells) as u64).min((1 << bits) - 1);
            for bit in 0..bits {
                key |= (cell >> bit & 1) << (bit as usize * D + axis);
            }
        }
        key
    };
    let mut order: Vec<(u64, u32)> = points.iter().enumerate().map(|(i, x)| (key(x), i as u32)).collect();
    order.sort_unstable();
    order.into_iter().map(|(_, i)| i).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_four_quadrants_come_one_after_the_other() {
        let bounds = Aabb { min: [0.0, 0.0], max: [4.0, 4.0] };
        let points: Vec<[f64; 2]> =
            (0..16).map(|i| [f64::from(i % 4) + 0.5, f64::from(i / 4) + 0.5]).collect();
        let order = morton_order(&points, &bounds);
        assert_eq!(order, [0, 1, 4, 5, 2, 3, 6, 7, 8, 9, 12, 13, 10, 11, 14, 15]);
    }

    #[test]
    fn points_on_the_upper_faces_are_in_range() {
        let bounds = Aabb { min: [0.0; 3], max: [1.0; 3] };
        assert_eq!(morton_order(&[[1.0; 3], [0.0; 3]], &bounds), [1, 0]);
    }
}
