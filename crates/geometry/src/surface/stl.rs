//! STL files, binary and ASCII: nothing but triangles. Normals in the file are not read: the order of the vertices says
//! the same, and exporters agree on that more often.

use crate::error::GeometryError;

/// Length of the header and the count of a binary file.
const HEADER: usize = 84;

/// Length of a triangle in a binary file: a normal, three vertices and two bytes of attributes.
const RECORD: usize = 50;

/// Most triangles that are read: 100 MB of a binary file.
pub const MAX_STL_TRIANGLES: usize = 2_000_000;

/// The triangles of an STL file, each of three vertices, counter-clockwise as seen from outside.
///
/// A file is binary if its length is that which its count of triangles asks for, whatever its header says; otherwise it
/// must begin with `solid`. Several solids in one file are taken together.
///
/// # Errors
/// [`GeometryError::InvalidShape`] for an empty or truncated file, more than [`MAX_STL_TRIANGLES`], syntax (with the
/// line) and coordinates that are not finite (with the number of the triangle).
pub fn read_stl(bytes: &[u8]) -> Result<Vec<[[f64; 3]; 3]>, GeometryError> {
    let count = bytes.get(HEADER - 4..HEADER).and_then(|b| b.try_into().ok()).map(u32::from_le_bytes);
    let needed = |count: u32| HEADER as u64 + RECORD as u64 * u64::from(count);
    let triangles = match count {
        _ if bytes.is_empty() => return Err(invalid("the file is empty")),
        Some(count) if needed(count) == bytes.len() as u64 => binary(bytes, count as usize)?,
        _ if bytes.trim_ascii_start().get(..5).is_some_and(|b| b.eq_ignore_ascii_case(b"solid")) => {
            ascii(bytes)?
        }
        Some(count) => {
            return Err(invalid(format!(
                "the file does not begin with `solid`, and as a binary file of {count} triangles it would have {} bytes, \
                 not {}",
                needed(count),
                bytes.len()
            )));
        }
        None => return Err(invalid(format!("{} bytes are neither a binary nor an ASCII file", bytes.len()))),
    };
    if triangles.is_empty() {
        return Err(invalid("the file has no triangles"));
    }
    match triangles.iter().position(|t| !t.iter().flatten().all(|c| c.is_finite())) {
        Some(k) => Err(invalid(format!("triangle {} has a coordinate that is not finite", k + 1))),
        None => Ok(triangles),
    }
}

fn invalid(reason: impl Into<String>) -> GeometryError {
    GeometryError::invalid("STL file", reason)
}

fn check_count(count: usize) -> Result<(), GeometryError> {
    if count <= MAX_STL_TRIANGLES {
        return Ok(());
    }
    Err(invalid(format!("more than {MAX_STL_TRIANGLES} triangles: simplify the surface")))
}

fn binary(bytes: &[u8], count: usize) -> Result<Vec<[[f64; 3]; 3]>, GeometryError> {
    check_count(count)?;
    let number = |record: &[u8], k: usize| {
        let at = 12 + 4 * k;
        f64::from(f32::from_le_bytes([record[at], record[at + 1], record[at + 2], record[at + 3]]))
    };
    let triangle = |record: &[u8]| {
        std::array::from_fn(|corner| std::array::from_fn(|axis| number(record, 3 * corner + axis)))
    };
    Ok(bytes[HEADER..].chunks_exact(RECORD).map(triangle).collect())
}

fn ascii(bytes: &[u8]) -> Result<Vec<[[f64; 3]; 3]>, GeometryError> {
    let text = std::str::from_utf8(bytes).map_err(|e| {
        invalid(format!("byte {} is neither ASCII nor part of a binary file", e.valid_up_to()))
    })?;
    let mut triangles = Vec::new();
    let mut corners: Vec<[f64; 3]> = Vec::with_capacity(3);
    let (mut in_facet, mut ended, mut last) = (false, false, 0);
    for (number, line) in text.lines().enumerate() {
        let wrong = |what: &str| invalid(format!("line {}: {what}", number + 1));
        let mut words = line.split_ascii_whitespace();
        let Some(first) = words.next() else { continue };
        last = number + 1;
        match first.to_ascii_lowercase().as_str() {
            "solid" if !in_facet => ended = false,
            "endsolid" if !in_facet => ended = true,
            "facet" if !in_facet && !ended => {
                in_facet = true;
                corners.clear();
            }
            "outer" | "endloop" if in_facet => {}
            "vertex" if in_facet => {
                let values: Vec<f64> = words.map_while(|w| w.parse().ok()).collect();
                let corner: [f64; 3] =
                    values.try_into().map_err(|_| wrong("`vertex` needs three numbers"))?;
                corners.push(corner);
            }
            "endfacet" if in_facet => {
                let triangle: [[f64; 3]; 3] = corners[..]
                    .try_into()
                    .map_err(|_| wrong(&format!("a facet has 3 vertices, not {}", corners.len())))?;
                triangles.push(triangle);
                check_count(triangles.len())?;
                in_facet = false;
            }
            _ => {
                let shown: String = first.chars().take(20).collect();
                return Err(wrong(&format!("`{}` is not expected here", shown.escape_debug())));
            }
        }
    }
    if in_facet || !ended {
        return Err(invalid(format!("the file ends after line {last} without `endsolid`: it is cut off")));
    }
    Ok(triangles)
}

#[cfg(test)]
mod tests {
    use super::*;

    const ONE: &str = "solid a name\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   VERTEX 1 0 0\n   \
                       vertex 0 1.5e0 0\n  endloop\n endfacet\nendsolid a name\n";

    fn packed(triangles: &[[[f32; 3]; 3]]) -> Vec<u8> {
        let mut bytes = b"solid, says a header that lies".to_vec();
        bytes.resize(80, b' ');
        bytes.extend((triangles.len() as u32).to_le_bytes());
        for t in triangles {
            bytes.extend([0; 12]);
            t.iter().flatten().for_each(|c| bytes.extend(c.to_le_bytes()));
            bytes.extend([0; 2]);
        }
        bytes
    }

    #[test]
    fn both_forms_say_the_same() {
        let triangle = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.5, 0.0]];
        assert_eq!(read_stl(ONE.as_bytes()).unwrap(), [triangle]);
        assert_eq!(read_stl(&packed(&[triangle.map(|v| v.map(|c| c as f32))])).unwrap(), [triangle]);
        let twice = format!("{ONE}\n{ONE}");
        assert_eq!(read_stl(twice.as_bytes()).unwrap().len(), 2);
    }

    #[test]
    fn what_is_wrong_is_said() {
        let cut = packed(&[[[0.0; 3]; 3]; 2]);
        let says = |bytes: &[u8], expected: &str| {
            let message = read_stl(bytes).unwrap_err().to_string();
            assert!(message.contains(expected), "{message}");
        };
        says(b"", "empty");
        says(b"solid x\nendsolid x\n", "no triangles");
        says(&packed(&[]), "no triangles");
        says(&[7; 40], "neither");
        says(&cut[30..], "would have");
        says(&packed(&[[[f32::NAN; 3]; 3]]), "triangle 1");
        says(ONE.replace("1.5e0", "x").as_bytes(), "line 6: `vertex` needs three numbers");
        says(ONE.replace("1.5e0", "inf").as_bytes(), "not finite");
        says(ONE.replace("   VERTEX 1 0 0\n", "").as_bytes(), "line 7: a facet has 3 vertices, not 2");
        says(ONE.replace("outer", "inner").as_bytes(), "line 3: `inner`");
        says(ONE.split("endloop").next().expect("the text before it").as_bytes(), "cut off");
    }
}
