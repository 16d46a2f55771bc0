//! Imports: exact places in the file where the text stands.

use crate::support::{check, check_problems, describe, run};

#[test]
fn an_error_in_an_imported_file_points_into_it() {
    check_problems(
        &[
            ("vct/main.wgsl", "// größer als β\n#import \"shared/outer.wgsl\"\n@compute @workgroup_size(1) fn main() { outer(); }\n"),
            ("shared/outer.wgsl", "/* ein\nKommentar äöü */ #not an import\n"),
        ],
        "
        reflect::wgsl-syntax: expected global item (`struct`, `const`, `var`, `alias`, `fn`, `diagnostic`, `enable`, `requires`, `;`) or the end of the file, found \"#\"
        at shared/outer.wgsl:2:18 `#`: expected global item (`struct`, `const`, `var`, `alias`, `fn`, `diagnostic`, `enable`, `requires`, `;`) or the end of the file
        ",
    );
    check_problems(
        &[
            ("main.wgsl", "#import \"a.wgsl\"\n#import \"b.wgsl\"\n@compute @workgroup_size(1) fn main() { b(); }"),
            ("a.wgsl", "enable f16;\nfn a() -> f32 { return 1.0; } // no newline at the end"),
            ("b.wgsl", "#import \"a.wgsl\"\n\tfn b() -> f32 { /* ä→ */ return a() + missing; }"),
        ],
        "
        reflect::wgsl-syntax: no definition in scope for identifier: `missing`
        at b.wgsl:2:40 `missing`: unknown identifier
        ",
    );
}

#[test]
fn names_are_one_scope_and_both_definitions_are_shown() {
    check_problems(
        &[("main.wgsl", "#import \"a.wgsl\"\nfn same() {}\n"), ("a.wgsl", "\n  fn same() {}")],
        "
        reflect::wgsl-syntax: redefinition of `same`
        at main.wgsl:2:4 `same`: redefinition of `same`
        at a.wgsl:2:6 `same`: previous definition of `same`
        ",
    );
}

#[test]
fn a_validation_error_points_into_the_imported_file() {
    check_problems(
        &[
            ("main.wgsl", "#import \"shared/bad.wgsl\"\n@compute @workgroup_size(1) fn main() { bad(); }"),
            ("shared/bad.wgsl", "// ünïcödé\n/* ß */ var<storage, read> cells: array<u32>;\nfn bad() { /* ß */ cells[0] = 1u; }"),
        ],
        "
        reflect::wgsl-invalid: the function `bad` is invalid: The pointer [1] doesn't relate to a valid destination for a store
        at shared/bad.wgsl:3:20 `cells[0]`: writing to this location is not permitted
        at shared/bad.wgsl:3:1 `fn bad() { /* ß */ cells[0] = 1u; }`: this function
        ",
    );
}

#[test]
fn a_diamond_stands_once_and_places_are_in_their_files() {
    let files = [
        ("main.wgsl", "#import \"left.wgsl\"\n#import \"right.wgsl\"\n@compute @workgroup_size(1) fn main() { _ = left() + right(); }"),
        ("left.wgsl", "#import \"base.wgsl\"\nfn left() -> f32 { return base(); }"),
        ("right.wgsl", "#import \"base.wgsl\"\nvar<uniform> right_scale: vec4<f32>;\nfn right() -> f32 { return base() * right_scale.x; }"),
        ("base.wgsl", "struct Base { first: u32, scale: f32 }\n  var<uniform> values: Base;\nfn base() -> f32 { return values.scale; }"),
    ];
    let (result, sources) = run(&files);
    let shader = result.unwrap();
    check(
        &describe(&shader),
        "
        Compute main [1, 1, 1]
        0.0 values: uniform 8 bytes [first: u32 @0, scale: f32 @4]
        0.1 right_scale: uniform 16 bytes []
        ",
    );
    let entry = &shader.entries[0];
    let at = |span: luminaire_graph::source::Span| {
        let (line, column) = sources.line_column(span).unwrap();
        format!("{}:{line}:{column} {}", sources.get(span.file).unwrap().name, sources.text(span))
    };
    assert_eq!(at(entry.span), "main.wgsl:3:32 main");
    assert_eq!(at(entry.globals[0].span), "base.wgsl:2:16 values");
    assert_eq!(at(entry.globals[1].span), "right.wgsl:2:14 right_scale");
    let luminaire_graph::reflect::interface::GlobalKind::Uniform { layout } = &entry.globals[0].kind else { panic!("no uniform") };
    assert_eq!(at(layout.members[1].span), "base.wgsl:1:27 scale");
    assert_eq!(sources.iter().count(), 4);
}

#[test]
fn missing_files_have_a_place_and_the_nearest_name() {
    check_problems(
        &[("main.wgsl", "\n  #import \"shared/bdrf.wgsl\" // typo\n"), ("shared/brdf.wgsl", "")],
        "
        reflect::missing-import: can't read the imported shader file `shared/bdrf.wgsl`: no such file (searched: memory)
        at main.wgsl:2:12 `shared/bdrf.wgsl`: imported here
        hint did you mean `shared/brdf.wgsl`?
        ",
    );
}

#[test]
fn what_an_imported_file_leaves_open_is_its_own_error() {
    check_problems(
        &[("main.wgsl", "#import \"a.wgsl\"\nfn main() {}"), ("a.wgsl", "fn a() {\n  if (true) {\n}\n")],
        "
        reflect::unbalanced-bracket: `{` has no partner in its file
        at a.wgsl:1:8 `{`: here
        ",
    );
    check_problems(
        &[("main.wgsl", "#import \"main.wgsl\"\n")],
        "
        reflect::import-cycle: imports go in a circle: `main.wgsl` -> `main.wgsl`
        at main.wgsl:1:10 `main.wgsl`: this import closes the circle
        hint move what both files need into a third one
        ",
    );
}

#[test]
fn directives_of_imported_files_hold_for_all() {
    let files = [
        ("main.wgsl", "#import \"half.wgsl\"\n@compute @workgroup_size(1) fn main() { _ = one(); }"),
        ("half.wgsl", "// first a comment\nenable f16;\nfn one() -> f16 { return 1.0h; }"),
    ];
    check(&describe(&run(&files).0.unwrap()), "needs shader-f16\nCompute main [1, 1, 1]");
}
