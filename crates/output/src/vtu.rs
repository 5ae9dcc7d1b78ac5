//! Point clouds with data as VTK files, for ParaView and meshio.

use std::path::Path;

use vtkio::model::{
    Attribute, Attributes, ByteOrder, CellType, Cells, DataSet, UnstructuredGridPiece, Version,
    VertexNumbers, Vtk,
};

use crate::error::OutputError;
use crate::file::{WriteError, write_atomically};

/// Values at the points of a cloud.
#[derive(Debug, Clone, PartialEq)]
pub enum VtuValues {
    /// One number for each point.
    Scalars(Vec<f64>),
    /// One integer for each point, for labels and flags.
    Integers(Vec<i64>),
    /// One vector for each point; components beyond the dimension are zero.
    Vectors(Vec<[f64; 3]>),
}

impl VtuValues {
    /// Vectors of `D` components.
    #[must_use]
    pub fn vectors<const D: usize>(vectors: &[[f64; D]]) -> Self {
        Self::Vectors(vectors.iter().map(pad).collect())
    }

    fn len(&self) -> usize {
        match self {
            Self::Scalars(values) => values.len(),
            Self::Integers(values) => values.len(),
            Self::Vectors(values) => values.len(),
        }
    }
}

/// Named values at the points of a cloud.
#[derive(Debug, Clone, PartialEq)]
pub struct VtuField {
    /// Name that ParaView shows.
    pub name: String,
    /// The values, as many as there are points.
    pub values: VtuValues,
}

impl VtuField {
    /// One number for each point.
    pub fn scalars(name: impl Into<String>, values: Vec<f64>) -> Self {
        Self { name: name.into(), values: VtuValues::Scalars(values) }
    }

    /// One integer for each point.
    pub fn integers(name: impl Into<String>, values: Vec<i64>) -> Self {
        Self { name: name.into(), values: VtuValues::Integers(values) }
    }

    /// One vector for each point.
    pub fn vectors<const D: usize>(name: impl Into<String>, vectors: &[[f64; D]]) -> Self {
        Self { name: name.into(), values: VtuValues::vectors(vectors) }
    }
}

/// Writes a point cloud and the values at its points as an unstructured grid of vertices (`.vtu`, XML with binary
/// arrays, little endian), which ParaView and meshio read. The file is either complete or not there.
///
/// # Errors
/// [`OutputError::Length`] if a field has another length than the cloud, [`OutputError::NotFinite`] if a point is not
/// finite (values may be), [`OutputError::Io`] if the file cannot be written.
pub fn write_vtu<const D: usize>(
    path: impl AsRef<Path>,
    points: &[[f64; D]],
    fields: &[VtuField],
) -> Result<(), OutputError> {
    const { assert!(D >= 1 && D <= 3, "VTK knows one, two and three dimensions") };
    for (index, point) in points.iter().enumerate() {
        if !point.iter().all(|x| x.is_finite()) {
            return Err(OutputError::NotFinite { index, position: point.to_vec() });
        }
    }
    for VtuField { name, values } in fields {
        if values.len() != points.len() {
            return Err(OutputError::Length {
                name: name.clone(),
                expected: points.len(),
                found: values.len(),
            });
        }
    }
    let vtk = model(points, fields);
    write_atomically(path.as_ref(), |out| {
        vtk.write_xml(out).map_err(|error| WriteError::Contents(OutputError::Vtk(error.to_string())))
    })
}

fn model<const D: usize>(points: &[[f64; D]], fields: &[VtuField]) -> Vtk {
    let count = points.len() as u64;
    let coordinates: Vec<f64> = points.iter().flat_map(pad).collect();
    let attribute = |VtuField { name, values }: &VtuField| match values {
        VtuValues::Scalars(values) => Attribute::scalars(name, 1).with_data(values.clone()),
        VtuValues::Integers(values) => Attribute::scalars(name, 1).with_data(values.clone()),
        VtuValues::Vectors(values) => Attribute::vectors(name).with_data(values.as_flattened().to_vec()),
    };
    Vtk {
        version: Version::XML { major: 1, minor: 0 },
        title: String::new(),
        byte_order: ByteOrder::LittleEndian,
        file_path: None,
        data: DataSet::inline(UnstructuredGridPiece {
            points: coordinates.into(),
            cells: Cells {
                cell_verts: VertexNumbers::XML {
                    connectivity: (0..count).collect(),
                    offsets: (1..=count).collect(),
                },
                types: vec![CellType::Vertex; points.len()],
            },
            data: Attributes { point: fields.iter().map(attribute).collect(), cell: Vec::new() },
        }),
    }
}

fn pad<const D: usize>(x: &[f64; D]) -> [f64; 3] {
    std::array::from_fn(|axis| if axis < D { x[axis] } else { 0.0 })
}
