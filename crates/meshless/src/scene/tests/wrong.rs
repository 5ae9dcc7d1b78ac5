//! Scenes whose sections are wrong, and what the answer is.

use super::{PLATE, check_all, wrong};
use crate::scene::{MAX_FILE_BYTES, Scene};

#[test]
fn syntax() {
    check_all(
        PLATE,
        &[
            wrong("seed = 7", "seed = «7 8»", "", "not valid TOML", ""),
            wrong("seed = 7", "seed = 7\n«seed» = 8", "", "duplicate key `seed`", ""),
        ],
    );
}

#[test]
fn root() {
    check_all(
        PLATE,
        &[
            wrong("title = \"Plate\"", "«»", "title", "missing", ""),
            wrong("title = \"Plate\"", "title = «3»", "title", "expected a string, found an integer", ""),
            wrong("title = \"Plate\"\ndimension = 2", "«»title = \"Plate\"", "dimension", "missing", ""),
            wrong("dimension = 2", "dimension = «4»", "dimension", "an integer from 1 to 3, found 4", ""),
            wrong("dimension = 2", "dimension = «\"2\"»", "dimension", "1 to 3, found a string", ""),
            wrong("[output]", "[«outputs»]", "outputs", "unknown key", "did you mean `output`?"),
            wrong("[output]", "[time]\nend = «0»\n[output]", "time.end", "expected a positive", ""),
            wrong("[output]", "«[accuracy]»\n[output]", "accuracy.tolerance", "missing", ""),
            wrong(
                "[output]",
                "[accuracy]\ntolerance = «0»\n[output]",
                "accuracy.tolerance",
                "above 0 and below 1, found 0",
                "",
            ),
            wrong(
                "[output]",
                "[accuracy]\ntolerance = «2»\n[output]",
                "accuracy.tolerance",
                "above 0 and below 1, found 2",
                "",
            ),
            wrong(
                "[output]",
                "[accuracy]\ntolerance = 1e-3\nmax_nodes = «0»\n[output]",
                "accuracy.max_nodes",
                "expected an integer from 1",
                "",
            ),
            wrong(
                "at = [1.0, 0.2]",
                "at = «[1.0]»",
                "probes[0].at",
                "expected 2 numbers, found 1",
                "dimension = 2",
            ),
            wrong("at = [1.0, 0.2]", "at = [1.0, «nan»]", "probes[0].at[1]", "finite number", ""),
            wrong(
                "at = [1.0, 0.2]",
                "at = «\"x\"»",
                "probes[0].at",
                "an array of 2 numbers, found a string",
                "",
            ),
            wrong("vtu = true", "vtu = «1»", "output.vtu", "expected true or false, found an integer", ""),
            wrong("vtu = true", "«vtk» = true", "output.vtk", "unknown key", "`vtu`"),
        ],
    );
}

#[test]
fn points_and_holes() {
    check_all(
        PLATE,
        &[
            wrong("spacing = 0.05", "spacing = «0»", "points.spacing", "positive value, found 0", ""),
            wrong("spacing = 0.05", "spacing = «\"-1 + 0.5\"»", "points.spacing", "found -0.5", ""),
            wrong("spacing = 0.05", "spacing = «-inf»", "points.spacing", "finite number", ""),
            wrong("spacing = 0.05", "spacing = \"0.05 +«»\"", "points.spacing", "ends where an operand", ""),
            wrong("[points]\nspacing = 0.05", "«[points]»", "points.spacing", "missing", "[accuracy] with"),
            wrong("seed = 7", "seed = «-7»", "points.seed", "not below 0, found -7", ""),
            wrong("seed = 7", "seed = «7.0»", "points.seed", "an integer not below 0, found a float", ""),
            wrong(
                "\"irregular\"",
                "«\"iregular\"»",
                "points.layout",
                "unknown name",
                "did you mean \"irregular\"?",
            ),
            wrong(
                "\"irregular\"",
                "\"grid\"\nrefine_gaps_to = «0.001»",
                "points.refine_gaps_to",
                "only irregular clouds",
                "",
            ),
            wrong(
                "\"irregular\"",
                "\"irregular\"\nrefine_gaps_to = «-1»",
                "points.refine_gaps_to",
                "positive",
                "",
            ),
            wrong("\"irregular\"", "\"grid\"\nadapt = «true»", "points.adapt", "only irregular clouds", ""),
            wrong("\"irregular\"", "\"irregular\"\nadapt = «1»", "points.adapt", "true or false", ""),
            wrong("[points]", "«[[points]]»", "points", "expected a table, found an array", ""),
            wrong("name = \"bolt\"", "name = «\"left\"»", "holes[0].name", "is the name of a face", ""),
            wrong("name = \"bolt\"", "name = «\"all\"»", "holes[0].name", "is the name of a face", ""),
            wrong("name = \"bolt\"", "name = «\" \"»", "holes[0].name", "visible characters", ""),
            wrong(
                "[[holes]]\nname = \"bolt\"",
                "[[holes]]\nname = \"bolt\"\nlevel_set = \"x\"\n[[holes]]\nname = «\"bolt\"»",
                "holes[1].name",
                "already a hole \"bolt\"",
                "",
            ),
        ],
    );
}

#[test]
fn regions() {
    check_all(
        PLATE,
        &[
            wrong(
                "diffusivity = 100",
                "diffusivity = «true»",
                "regions[1].diffusivity",
                "number or an expression, found a boolean",
                "quotes",
            ),
            wrong(
                "diffusivity = 100",
                "diffusivity = «0»",
                "regions[1].diffusivity",
                "positive value, found 0",
                "",
            ),
            wrong(
                "diffusivity = 100",
                "diffusivity = «\"0/0\"»",
                "regions[1].diffusivity",
                "finite value, found NaN",
                "",
            ),
            wrong(
                "diffusivity = 100",
                "«difusivity» = 100",
                "regions[1].difusivity",
                "unknown key",
                "did you mean `diffusivity`?",
            ),
            wrong(
                "[[regions]]\nname = \"matrix\"\ndiffusivity = 100",
                "«[[regions]]»\nname = \"matrix\"",
                "regions[1].diffusivity",
                "missing",
                "",
            ),
            wrong("name = \"matrix\"", "name = «\"inclusion\"»", "regions[1].name", "already a region", ""),
            wrong(
                "name = \"matrix\"",
                "name = \"matrix\"\nlevel_set = «\"x\"»",
                "regions[1].level_set",
                "the background and has no shape",
                "",
            ),
            wrong(
                "[[regions]]\nname = \"inclusion\"\nlevel_set = \"(x - 1)^2 + (y - 1)^2 - 0.25\"",
                "«[[regions]]»\nname = \"inclusion\"",
                "regions[0]",
                "only the last region",
                "",
            ),
        ],
    );
}

#[test]
fn expressions() {
    check_all(
        PLATE,
        &[
            wrong(
                "\"1 + x^2\"",
                "\"1 + «sprt»(x)\"",
                "regions[0].diffusivity",
                "unknown name `sprt`",
                "`sqrt`",
            ),
            wrong("\"1 + x^2\"", "\"1 + «z»\"", "regions[0].diffusivity", "unknown name `z`", "x, y"),
            wrong("\"-8*x\"", "\"-8*«t»\"", "regions[0].source", "unknown name `t`", ""),
            wrong("\"-8*x\"", "'''\n-8«x»'''", "regions[0].source", "expected an operator", "`*`"),
            wrong("\"-8*x\"", "«\"-8\\u002ay*q\"»", "regions[0].source", "unknown name `q`", ""),
            wrong("\"x^2\"", "«[\"x^2\"]»", "regions[0].exact", "found an array", ""),
        ],
    );
}

#[test]
fn interfaces() {
    check_all(
        PLATE,
        &[
            wrong(
                "[\"inclusion\", \"matrix\"]",
                "[\"inclusion\", «\"matrx\"»]",
                "interfaces[0].between[1]",
                "unknown name",
                "\"matrix\"",
            ),
            wrong(
                "[\"inclusion\", \"matrix\"]",
                "[\"matrix\", «\"matrix\"»]",
                "interfaces[0].between[1]",
                "two different regions",
                "",
            ),
            wrong(
                "[\"inclusion\", \"matrix\"]",
                "«[\"matrix\"]»",
                "interfaces[0].between",
                "expected 2 region names, found 1",
                "",
            ),
            wrong(
                "[\"inclusion\", \"matrix\"]",
                "«\"matrix\"»",
                "interfaces[0].between",
                "an array of two region names",
                "",
            ),
            wrong(
                "flux_jump = \"0.2\"",
                "[[interfaces]]\nbetween = «[\"matrix\", \"inclusion\"]»",
                "interfaces[1].between",
                "already an entry",
                "",
            ),
            wrong(
                "flux_jump = \"0.2\"",
                "flux_jump = \"0.2\"\ndirichlet = «0»",
                "interfaces[0].dirichlet",
                "either `dirichlet` or jumps",
                "",
            ),
            wrong(
                "flux_jump = \"0.2\"",
                "flux_jump = «2024-01-01»",
                "interfaces[0].flux_jump",
                "found a date",
                "",
            ),
        ],
    );
}

#[test]
fn boundaries() {
    check_all(
        PLATE,
        &[
            wrong(
                "face = \"left\"",
                "face = «\"letf\"»",
                "boundaries[0].face",
                "unknown name",
                "did you mean \"left\"?",
            ),
            wrong(
                "face = \"left\"",
                "face = «\"front\"»",
                "boundaries[0].face",
                "unknown name",
                "left, right, bottom, top, bolt, all",
            ),
            wrong(
                "dirichlet = \"1.0\"",
                "dirichlet = \"1.0\"\nneumann = «0»",
                "boundaries[0].neumann",
                "already the condition `dirichlet`",
                "robin",
            ),
            wrong(
                "[[boundaries]]\nface = \"left\"\nwhere = \"y > 0.5\"\ndirichlet = \"1.0\"",
                "«[[boundaries]]»\nface = \"left\"",
                "boundaries[0]",
                "the condition is missing",
                "robin",
            ),
            wrong("\"y > 0.5\"", "\"0 «< y <» 1\"", "boundaries[0].where", "do not chain", ""),
            wrong("b = \"2\"", "b = «0.0»", "boundaries[1].robin.b", "no flux term", "dirichlet"),
            wrong(
                "{ a = 1, b = \"2\", g = \"x\" }",
                "«{ a = 1, b = \"2\" }»",
                "boundaries[1].robin.g",
                "missing",
                "",
            ),
            wrong(
                "{ a = 1, b = \"2\", g = \"x\" }",
                "«3»",
                "boundaries[1].robin",
                "expected a table, found an integer",
                "",
            ),
            wrong("neumann = 0", "«neuman» = 0", "boundaries[2].neuman", "unknown key", "`neumann`"),
        ],
    );
    let start = PLATE.find("[[boundaries]]").expect("boundaries");
    let end = PLATE.find("[method]").expect("method");
    let without = format!("{}{}", &PLATE[..start], &PLATE[end..]);
    let error = Scene::parse(&without, "scene.toml").expect_err("no boundaries");
    assert_eq!((error.key.as_str(), error.message.as_str()), ("boundaries", "the key is missing"));
}

#[test]
fn method() {
    check_all(
        PLATE,
        &[
            wrong("\"gfdm-hybrid\"", "«\"gfdm-hibrid\"»", "method.name", "unknown method", "\"gfdm-hybrid\""),
            wrong("\"gfdm-hybrid\"", "«2»", "method.name", "expected a string", ""),
            wrong("\"bicgstab\"", "«\"bicg\"»", "method.solver", "unknown name", "bicgstab"),
            wrong("order = 2", "order = «1»", "method.order", "from 2 to 8, found 1", ""),
            wrong(
                "order = 2",
                "order = «12»",
                "method.order",
                "from 2 to 8, found 12",
                "even orders up to 16",
            ),
            wrong(
                "name = \"gfdm-hybrid\"\norder = 2",
                "name = \"sharp\"\norder = «5»",
                "method.order",
                "an even order, found 5",
                "4, 6, 8",
            ),
            wrong("smoothing = 1", "smoothing = «101»", "method.smoothing", "from 0 to 100", ""),
            wrong("smoothing = 1", "support = «1.0»", "method.support", "above 1", "spacing"),
            wrong(
                "smoothing = 1",
                "selection_tolerance = «-1e-9»",
                "method.selection_tolerance",
                "not below 0",
                "",
            ),
            wrong(
                "smoothing = 1",
                "kernel = «\"gauss\"»",
                "method.kernel",
                "has no option `kernel`",
                "surface-reaction",
            ),
            wrong(
                "smoothing = 1",
                "log_scaling = «\"yes\"»",
                "method.log_scaling",
                "true or false, found a string",
                "",
            ),
            wrong("smoothing = 1", "«smooting» = 1", "method.smooting", "unknown key", "`smoothing`"),
        ],
    );
    let conservative = PLATE.replace("gfdm-hybrid", "gfdm-conservative");
    let automatic = PLATE.replace("gfdm-hybrid", "auto");
    let option = [wrong(
        "smoothing = 1",
        "smoothing = «1»",
        "method.smoothing",
        "has no option `smoothing`",
        "gfdm-classical",
    )];
    check_all(&conservative, &option);
    check_all(&automatic, &option);
}

#[test]
fn files_that_are_too_long() {
    let long = format!("{PLATE}#{}", "-".repeat(MAX_FILE_BYTES));
    let error = Scene::parse(&long, "scene.toml").expect_err("too long");
    assert!(error.message.contains("bytes") && error.line == 0, "{error}");
}
