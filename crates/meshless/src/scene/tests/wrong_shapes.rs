//! Scenes whose shapes are wrong, and what the answer is.

use super::{PLATE, check_all, wrong};

const BALL: &str = "title = 'ball'\ndimension = 3\n[domain]\nsphere = { center = [0, 0, 0], radius = 1 }\n[points]\n\
                    spacing = 0.1\n[[regions]]\nname = 'all'\ndiffusivity = 1\n[[boundaries]]\nface = 'outer'\n\
                    dirichlet = 0\n";

#[test]
fn domains() {
    let domain = "box = { min = [0.0, 0.0], max = [2.0, 1] }";
    check_all(
        PLATE,
        &[
            wrong(
                "[domain]\nbox = { min = [0.0, 0.0], max = [2.0, 1] }",
                "«[domain]»",
                "domain",
                "the shape is missing",
                "level_set",
            ),
            wrong(
                domain,
                "box = { min = [0.0, 0.0], max = «[2.0, 0]» }",
                "domain.box.max",
                "not above `min` (0) along axis 2",
                "",
            ),
            wrong(
                domain,
                "box = { min = «[0.0]», max = [2.0, 1] }",
                "domain.box.min",
                "expected 2 numbers, found 1",
                "",
            ),
            wrong(domain, "box = «{ min = [0.0, 0.0] }»", "domain.box.max", "missing", ""),
            wrong(
                domain,
                "box = { min = [0.0, 0.0], max = [2.0, 1], «mid» = 3 }",
                "domain.box.mid",
                "unknown key",
                "min, max",
            ),
        ],
    );
}

#[test]
fn domains_of_other_shapes() {
    let domain = "box = { min = [0.0, 0.0], max = [2.0, 1] }";
    check_all(
        PLATE,
        &[
            wrong(
                "[domain]\nbox = { min = [0.0, 0.0], max = [2.0, 1] }",
                "«[domain]»\nlevel_set = \"x\"",
                "domain.bounds",
                "missing",
                "holds it",
            ),
            wrong(
                domain,
                "box = { min = [0, 0], max = [2, 1] }\nbounds = «{ min = [0, 0], max = [2, 1] }»",
                "domain.bounds",
                "needs no bounds",
                "",
            ),
            wrong(
                domain,
                "box = { min = [0, 0], max = [2, 1] }\nlevel_set = «\"x\"»",
                "domain.level_set",
                "already the shape `box`",
                "intersection",
            ),
            wrong(domain, "stl = «\"part.stl\"»", "domain.stl", "needs dimension = 3", ""),
            wrong(
                domain,
                "free_space = { min = [0, 0], max = [1, 1] }\n«stl» = \"part.stl\"",
                "domain.stl",
                "unknown key",
                "",
            ),
            wrong(domain, "«boxx» = { min = [0, 0], max = [1, 1] }", "domain.boxx", "unknown key", "`box`"),
        ],
    );
}

#[test]
fn primitives() {
    let hole = "sphere = { center = [1.5, 0.5], radius = 0.1 }";
    check_all(
        PLATE,
        &[
            wrong(
                hole,
                "sphere = { center = [1.5, 0.5], radius = «-0.1» }",
                "holes[0].sphere.radius",
                "positive number, found -0.1",
                "",
            ),
            wrong(
                hole,
                "sphere = { center = [1.5, «inf»], radius = 0.1 }",
                "holes[0].sphere.center[1]",
                "finite",
                "",
            ),
            wrong(hole, "polygon = «[[0, 0], [1, 1]]»", "holes[0].polygon", "at least 3 vertices, not 2", ""),
            wrong(hole, "polygon = [[0, 0], [1, 1], «[1, 1]»]", "holes[0].polygon[2]", "repeats", ""),
            wrong(
                hole,
                "polygon = [[0, 0], [1, 1], [1, 0], «[0, 0]»]",
                "holes[0].polygon[3]",
                "repeats the first",
                "closes",
            ),
            wrong(
                hole,
                "polygon = [[0, 0], [1, 1], «[1, 0, 3]»]",
                "holes[0].polygon[2]",
                "expected 2 numbers, found 3",
                "",
            ),
            wrong(
                hole,
                "half_space = { point = [0, 0], normal = «[0, 0]» }",
                "holes[0].half_space.normal",
                "zero vector",
                "",
            ),
            wrong(
                hole,
                "cylinder = «{ point = [0, 0], axis = [0, 1], radius = 1 }»",
                "holes[0].cylinder",
                "dimension = 3",
                "sphere",
            ),
        ],
    );
}

#[test]
fn combinations() {
    let hole = "sphere = { center = [1.5, 0.5], radius = 0.1 }";
    check_all(
        PLATE,
        &[
            wrong(
                hole,
                "union = «[{ level_set = \"x\" }]»",
                "holes[0].union",
                "at least 2 shapes, found 1",
                "",
            ),
            wrong(
                hole,
                "union = [{ level_set = \"x\" }, { «levelset» = \"y\" }]",
                "holes[0].union[1].levelset",
                "unknown key",
                "`level_set`",
            ),
            wrong(
                hole,
                "union = [{ level_set = \"x\" }, «{}»]",
                "holes[0].union[1]",
                "the shape is missing",
                "",
            ),
            wrong(hole, "union = [{ level_set = \"x\" }, «3»]", "holes[0].union[1]", "expected a table", ""),
            wrong(
                hole,
                "union = [{ level_set = \"x\" }, { level_set = \"«w»\" }]",
                "holes[0].union[1].level_set",
                "unknown name `w`",
                "",
            ),
        ],
    );
}

#[test]
fn three_dimensions() {
    check_all(
        BALL,
        &[
            wrong(
                "sphere = { center = [0, 0, 0], radius = 1 }",
                "polygon = «[[0, 0], [1, 0], [0, 1]]»",
                "domain.polygon",
                "dimension = 2",
                "",
            ),
            wrong(
                "sphere = { center = [0, 0, 0], radius = 1 }",
                "stl = «3»",
                "domain.stl",
                "expected a file's name or a table, found an integer",
                "scale",
            ),
            wrong(
                "sphere = { center = [0, 0, 0], radius = 1 }",
                "stl = { file = 'part.stl', scale = «0» }",
                "domain.stl.scale",
                "positive",
                "",
            ),
            wrong(
                "sphere = { center = [0, 0, 0], radius = 1 }",
                "stl = { file = 'part.stl', crease = «180» }",
                "domain.stl.crease",
                "between 0 and 180",
                "",
            ),
            wrong(
                "sphere = { center = [0, 0, 0], radius = 1 }",
                "stl = { «path» = 'part.stl' }",
                "domain.stl.path",
                "unknown key",
                "file",
            ),
            wrong("face = 'outer'", "face = «'left'»", "boundaries[0].face", "unknown name", "outer, all"),
            wrong(
                "sphere = { center = [0, 0, 0], radius = 1 }",
                "cylinder = { point = [0, 0, 0], axis = [0, 0, 1], radius = 1, length = «0» }",
                "domain.cylinder.length",
                "positive",
                "",
            ),
            wrong(
                "[domain]\nsphere = { center = [0, 0, 0], radius = 1 }",
                "«[domain]»\ncylinder = { point = [0, 0, 0], axis = [0, 0, 1], radius = 1 }",
                "domain.bounds",
                "missing",
                "bounds",
            ),
        ],
    );
}
