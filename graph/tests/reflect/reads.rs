//! Which members of its tables a shader reads.

use crate::support::shader;

const DECLARED: &str = "
    struct Row { place: vec3<f32>, strength: f32, list: array<vec4<f32>, 2>, kind: u32 }
    struct Head { exposure: f32, position: vec3<f32> }
    struct Tail { count: u32, items: array<Row> }
    var<storage, read> rows: array<Row>;
    var<storage, read> numbers: array<u32>;
    var<storage, read> tail: Tail;
    var<storage, read> grid: array<array<Row, 2>>;
    var<uniform> head: Head;
    var<uniform> fixed: array<Row, 3>;
    var<private> kept: Row;
    var<private> sum: f32;

    fn nth(index: u32) -> Row { return rows[numbers[index]]; }
    fn either(index: u32) -> Row { if index == 0u { return rows[0]; } return nth(index); }
    fn mixed(index: u32) -> Row { if index == 0u { return fixed[0]; } return rows[index]; }
    fn strength_of(row: Row) -> f32 { return row.strength; }
    fn kind_at(index: u32) -> u32 { return rows[index].kind; }
    fn never_called() { sum = head.exposure; kept = rows[0]; }
";

/// What the body of an entry point reads: names of variables with their members.
fn reads(body: &str) -> String {
    let shader = shader(&format!("{DECLARED}\n@compute @workgroup_size(1) fn main() {{ {body} }}"));
    let globals = shader.entries.iter().flat_map(|entry| &entry.globals);
    globals.map(|global| format!("{}{}", global.name, global.reads)).collect::<Vec<_>>().join(" ")
}

#[test]
fn members_are_read_that_are_named() {
    let whole = "rows.{place, strength, list, kind}";
    for (body, expected) in [
        ("sum = head.position.x;", "head.position"),
        ("sum = head.position[1] + head.exposure;", "head.{exposure, position}"),
        ("sum = rows[2].strength;", "rows.strength"),
        ("let index = u32(sum); sum = rows[index].list[index].y;", "rows.list"),
        ("sum = fixed[1].strength;", "fixed.strength"),
        // Through values, functions that return rows, and pointers.
        ("let row = rows[1]; sum = row.strength + row.place.x;", "rows.{place, strength}"),
        ("sum = nth(1u).strength;", "rows.strength numbers"),
        ("sum = either(1u).place.x;", "rows.place numbers"),
        ("let row = &rows[1]; sum = (*row).strength;", "rows.strength"),
        (
            "for (var i = 0u; i < kind_at(i); i++) { switch i { case 1u: { sum = nth(i).strength; } default: {} } }",
            "rows.{strength, kind} numbers",
        ),
        // The length is no row.
        ("sum = f32(arrayLength(&rows));", "rows.length"),
        ("sum = f32(arrayLength(&rows)) + rows[0].strength;", "rows.strength"),
        // Everything else that happens to a row reads all of it.
        ("kept = rows[0];", whole),
        ("sum = strength_of(rows[0]);", whole),
        ("sum = mixed(1u).strength;", "rows.{place, strength, list, kind} fixed.{place, strength, list, kind}"),
        ("var row = rows[0]; sum = row.strength;", whole),
        ("let all = fixed; sum = all[0].strength;", "fixed.{place, strength, list, kind}"),
        // What is no struct, or no array of structs, is one thing.
        ("sum = f32(numbers[0]);", "numbers"),
        ("sum = f32(tail.count);", "tail"),
        ("sum = grid[0][1].strength;", "grid"),
    ] {
        assert_eq!(reads(body), expected, "{body}");
    }
}

#[test]
fn members_have_their_bytes() {
    use luminaire_graph::published::{ReadMember, RowReads};
    let shader = shader(&format!("{DECLARED}\n@compute @workgroup_size(1) fn main() {{ sum = rows[0].list[0].x + f32(rows[0].kind); }}"));
    let member = |name: &str, offset, end| ReadMember { offset, end, name: name.to_owned() };
    assert_eq!(shader.entries[0].globals[0].reads, RowReads::Members(vec![member("list", 16, 48), member("kind", 48, 64)]));
}
