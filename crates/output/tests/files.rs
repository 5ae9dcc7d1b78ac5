//! Files are read back as they were written, and are either complete or not there.

use std::fs;

use meshless_output::{OutputError, VtuField, VtuValues, write_text_atomically, write_vtu};
use vtkio::model::{Attribute, CellType, DataSet, Piece, UnstructuredGridPiece, Vtk};

fn read(path: &std::path::Path) -> UnstructuredGridPiece {
    let DataSet::UnstructuredGrid { mut pieces, .. } =
        Vtk::import(path).expect("a file that vtkio reads").data
    else {
        panic!("not an unstructured grid");
    };
    match pieces.remove(0) {
        Piece::Inline(piece) => *piece,
        _ => panic!("not inline"),
    }
}

#[test]
fn a_cloud_is_read_back_bit_by_bit() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cloud.vtu");
    let points = [[0.1, -2.0], [1.0 / 3.0, 1e-300], [4.0, 5.0]];
    let u = vec![1.0 / 3.0, f64::NAN, -1e10];
    let fields = [
        VtuField::scalars("u & <v>", u.clone()),
        VtuField::integers("region", vec![0, -1, i64::MAX]),
        VtuField::vectors("flux", &[[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]]),
    ];
    write_vtu(&path, &points, &fields).unwrap();
    let piece = read(&path);
    assert_eq!(
        piece.points.cast_into::<f64>().unwrap(),
        [0.1, -2.0, 0.0, 1.0 / 3.0, 1e-300, 0.0, 4.0, 5.0, 0.0]
    );
    assert_eq!(piece.cells.types, [CellType::Vertex; 3]);
    let (connectivity, offsets) = piece.cells.cell_verts.into_xml();
    assert_eq!((connectivity, offsets), (vec![0, 1, 2], vec![1, 2, 3]));
    let arrays: Vec<_> = piece
        .data
        .point
        .into_iter()
        .map(|attribute| match attribute {
            Attribute::DataArray(array) => array,
            Attribute::Field { .. } => panic!("a field"),
        })
        .collect();
    let bits = |values: Vec<f64>| values.into_iter().map(f64::to_bits).collect::<Vec<_>>();
    assert_eq!(bits(arrays[0].data.clone().cast_into().unwrap()), bits(u));
    assert_eq!(arrays[1].data.clone().cast_into::<i64>().unwrap(), [0, -1, i64::MAX]);
    assert_eq!(
        arrays[2].data.clone().cast_into::<f64>().unwrap(),
        [1.0, 2.0, 0.0, 3.0, 4.0, 0.0, 5.0, 6.0, 0.0]
    );
    let names: Vec<_> = arrays.iter().map(|array| array.name.as_str()).collect();
    assert_eq!(names[1..], ["region", "flux"]);
}

#[test]
fn every_dimension_and_no_point_at_all_can_be_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cloud.vtu");
    write_vtu(&path, &[[1.0], [2.0]], &[]).unwrap();
    assert_eq!(read(&path).points.cast_into::<f64>().unwrap(), [1.0, 0.0, 0.0, 2.0, 0.0, 0.0]);
    write_vtu(&path, &[[1.0, 2.0, 3.0]], &[]).unwrap();
    assert_eq!(read(&path).points.cast_into::<f64>().unwrap(), [1.0, 2.0, 3.0]);
    write_vtu::<3>(&path, &[], &[VtuField::scalars("u", vec![])]).unwrap();
}

#[test]
fn wrong_clouds_are_refused_and_leave_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cloud.vtu");
    let field = VtuField { name: "u".to_owned(), values: VtuValues::Scalars(vec![1.0]) };
    let error = write_vtu(&path, &[[0.0], [1.0]], &[field]).unwrap_err();
    assert!(matches!(error, OutputError::Length { expected: 2, found: 1, .. }));
    let error = write_vtu(&path, &[[0.0], [f64::NAN]], &[]).unwrap_err();
    assert!(matches!(error, OutputError::NotFinite { index: 1, .. }));
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn text_replaces_a_file_and_leaves_nothing_beside_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("notes.txt");
    write_text_atomically(&path, "first").unwrap();
    write_text_atomically(&path, "second").unwrap();
    assert_eq!(fs::read_to_string(&path).unwrap(), "second");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn a_failure_names_the_path_and_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    // A folder that is not empty cannot be replaced by a file.
    let taken = folder.path().join("taken");
    fs::create_dir(&taken).unwrap();
    fs::write(taken.join("inside"), "kept").unwrap();
    let error = write_text_atomically(&taken, "text").unwrap_err();
    assert!(matches!(&error, OutputError::Io { path, .. } if *path == taken));
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    assert_eq!(fs::read_to_string(taken.join("inside")).unwrap(), "kept");
    let missing = folder.path().join("missing").join("file.txt");
    assert!(write_text_atomically(&missing, "text").unwrap_err().to_string().contains("missing"));
}
