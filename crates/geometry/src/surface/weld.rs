//! Vertices that the triangles of a file repeat, made one.

use std::collections::HashMap;

/// Distance up to which two vertices are one, relative to the largest coordinate: four units in the last place of the
/// single precision of a file.
const WELD: f64 = 4.8e-7;

/// Vertices and triangles as indices; triangles of which two vertices became one are left out, and counted. Removing
/// them leaves no hole: their other two edges are one edge.
pub(super) struct Welded {
    pub(super) vertices: Vec<[f64; 3]>,
    pub(super) triangles: Vec<[u32; 3]>,
    /// Number of each triangle in the file.
    pub(super) origin: Vec<u32>,
    pub(super) degenerate: usize,
}

/// Welds vertices in the order of the triangles: each to the first one met within the tolerance.
pub(super) fn weld(soup: &[[[f64; 3]; 3]]) -> Welded {
    let largest = soup.iter().flatten().flatten().fold(0.0_f64, |m, c| m.max(c.abs()));
    let tolerance = WELD * largest;
    let cell = 2.0 * tolerance.max(f64::MIN_POSITIVE);
    let key = |x: &[f64; 3]| x.map(|c| (c / cell).floor() as i64);
    let mut exact: HashMap<[u64; 3], u32> = HashMap::new();
    let mut cells: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
    let mut welded =
        Welded { vertices: Vec::new(), triangles: Vec::new(), origin: Vec::new(), degenerate: 0 };
    let mut index = |x: &[f64; 3], vertices: &mut Vec<[f64; 3]>| -> u32 {
        // Minus zero is zero.
        let bits = x.map(|c| (c + 0.0).to_bits());
        if let Some(&known) = exact.get(&bits) {
            return known;
        }
        let near = neighbors(key(x)).find_map(|k| {
            let same = |&&v: &&u32| crate::vector::distance(&vertices[v as usize], x) <= tolerance;
            cells.get(&k)?.iter().find(same).copied()
        });
        let id = near.unwrap_or_else(|| {
            vertices.push(*x);
            let id = vertices.len() as u32 - 1;
            cells.entry(key(x)).or_default().push(id);
            id
        });
        exact.insert(bits, id);
        id
    };
    for (number, triangle) in soup.iter().enumerate() {
        let [a, b, c] = triangle.each_ref().map(|x| index(x, &mut welded.vertices));
        if a == b || b == c || c == a {
            welded.degenerate += 1;
        } else {
            welded.triangles.push([a, b, c]);
            welded.origin.push(number as u32 + 1);
        }
    }
    welded
}

fn neighbors(k: [i64; 3]) -> impl Iterator<Item = [i64; 3]> {
    (0..27_i64).map(move |n| [k[0] + n % 3 - 1, k[1] + n / 3 % 3 - 1, k[2] + n / 9 - 1])
}
