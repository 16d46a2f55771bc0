//! Named cases of scheduling: what each error says, and what order, culling and clears come to.
#![allow(clippy::unwrap_used, clippy::panic)]

mod support;

use luminaire_graph::plan::CullReason;
use support::fixture;

fn assert_says(text: &str, code: &str, parts: &[&str]) -> String {
    let problems = fixture(text).problems();
    assert!(problems.contains(code), "expected {code} in:\n{problems}");
    for part in parts {
        assert!(problems.contains(part), "expected {part:?} in:\n{problems}");
    }
    problems
}

#[test]
fn order_in_the_file_carries_no_meaning() {
    let graph = fixture(
        "texture a rgba16float 8x8\ntexture b rgba16float 8x8\n\
         pass last read b write a\npass first write b\noutput color a",
    );
    assert_eq!(graph.order(), ["first", "last"]);
}

#[test]
fn modifiers_run_between_producer_and_readers_in_the_order_of_the_file() {
    let graph = fixture(
        "texture x rgba16float 8x8\ntexture y rgba16float 8x8\n\
         pass use read x write y\npass second modify x\npass third modify x\npass make write x\noutput color y",
    );
    assert_eq!(graph.order(), ["make", "second", "third", "use"]);
}

#[test]
fn reader_of_a_version_runs_before_the_next_modifier() {
    let graph = fixture(
        "texture x rgba16float 8x8\ntexture y rgba16float 8x8\ntexture z rgba16float 8x8\n\
         pass make write x\npass change modify x\npass early read x@make write y\npass late read x read y write z\noutput color z",
    );
    assert_eq!(graph.order(), ["make", "early", "change", "late"]);
}

#[test]
fn mips_depend_on_each_other_and_not_on_the_whole() {
    let graph = fixture(
        "texture x rgba16float 8x8 mips 3\ntexture y rgba16float 8x8\n\
         pass down2 read x.mip(1) write x.mip(2)\npass down1 read x.mip(0) write x.mip(1)\npass make write x.mip(0)\n\
         pass use read x write y\noutput color y",
    );
    assert_eq!(graph.order(), ["make", "down1", "down2", "use"]);
}

#[test]
fn depth_may_be_sampled_while_it_is_only_tested() {
    let graph = fixture(
        "texture d depth32float 8x8\ntexture y rgba16float 8x8\n\
         pass make write d\npass lit tested d read d write y\noutput color y",
    );
    assert_eq!(graph.order(), ["make", "lit"]);
    assert_eq!(graph.problems(), "");
}

#[test]
fn what_no_output_needs_is_culled_with_its_reason() {
    let graph = fixture(
        "texture a rgba16float 8x8\ntexture b rgba16float 8x8\ntexture c rgba16float 8x8\n\
         pass kept write a\npass dead write b\npass deader read b write c\noutput color a",
    );
    let schedule = graph.schedule();
    let reasons: Vec<_> = schedule.culled.iter().map(|culled| (&*culled.name, culled.reason.clone())).collect();
    let deader = schedule.culled[1].pass;
    assert_eq!(reasons, [("dead", CullReason::OnlyCulledReaders(vec![deader])), ("deader", CullReason::Unread)]);
    let problems = graph.problems();
    assert!(problems.contains("nothing reads `c`"), "{problems}");
    assert!(!problems.contains("nothing reads `b`"), "{problems}");
}

#[test]
fn modifier_of_a_needed_part_is_alive_and_of_another_part_is_not() {
    let graph = fixture(
        "texture x rgba16float 8x8 mips 2\npass a write x.mip(0)\npass b write x.mip(1)\npass c modify x.mip(0)\n\
         pass d modify x.mip(1)\noutput color x.mip(0)",
    );
    assert_eq!(graph.order(), ["a", "c"]);
}

#[test]
fn after_orders_and_keeps_nothing_alive() {
    let graph = fixture(
        "texture x rgba16float 8x8\ntexture y rgba16float 8x8\ntexture z rgba16float 8x8\n\
         pass a write x after b\npass b write y\npass c write z\noutput one x\noutput two y",
    );
    assert_eq!(graph.order(), ["b", "a"]);
}

#[test]
fn declared_value_fills_what_nothing_produces_before_its_first_use() {
    let graph = fixture(
        "texture x rgba16float 8x8 mips 4 clear\ntexture y rgba16float 8x8\ntexture z rgba16float 8x8\n\
         pass a write x.mip(1)\npass b read x.mip(0) write y\npass c read x read y write z\noutput color z",
    );
    let schedule = graph.schedule();
    let clears: Vec<_> = schedule
        .initial_clears
        .iter()
        .map(|clear| (&*graph.bound.steps[clear.pass.index()].name, clear.part.mips.clone(), clear.part.layers.clone()))
        .collect();
    assert_eq!(clears, [("b", 0..1, 0..1), ("c", 2..4, 0..1)]);
    // They are set when they are not held, not whenever the step runs.
    assert!(graph.plan().steps.iter().all(|step| step.clears.is_empty()));
}

#[test]
fn output_that_nothing_touches_gets_its_declared_value() {
    let graph = fixture("texture x rgba16float 8x8 clear\ntexture y rgba16float 8x8\npass a write y\noutput one x\noutput two y");
    assert_eq!(graph.schedule().initial_clears.len(), 1);
    assert_eq!(graph.plan().self_check(), Vec::<String>::new());
}

#[test]
fn two_producers() {
    let problems = assert_says(
        "texture x rgba16float 8x8 mips 4\npass a write x.mip(2)\npass b write x\noutput color x",
        "schedule::two-producers",
        &["`a` and `b` both write `x.mip(2)`", "`b` writes it again", "hint: put it under `modify`"],
    );
    // The error stands beside what else is wrong.
    assert_eq!(problems.matches("error[").count(), 1, "{problems}");
}

#[test]
fn overlap_of_a_layer_and_a_mip() {
    assert_says(
        "texture x rgba16float 8x8 mips 4 cube\npass a write x.layer(5)\npass b write x.mip(1)\noutput color x",
        "schedule::two-producers",
        &["`x.mip(1).face(5)`"],
    );
}

#[test]
fn written_twice_by_one_pass() {
    assert_says(
        "texture x rgba16float 8x8\npass a write x modify x\noutput color x",
        "schedule::written-twice",
        &["`a` writes `x` through"],
    );
}

#[test]
fn read_of_a_part_that_nothing_produces() {
    assert_says(
        "texture x rgba16float 8x8 mips 4\ntexture y rgba16float 8x8\npass a write x.mip(1)\npass b read x write y\noutput color y",
        "schedule::nothing-produces",
        &["`b` reads `x.mip(0)`, `x.mips(2..4)`, which nothing produces", "declares no `clear` value"],
    );
}

#[test]
fn modify_of_a_part_that_nothing_produces() {
    assert_says(
        "buffer x 64\npass a modify x\noutput color x",
        "schedule::nothing-to-modify",
        &["`a` modifies `x`, which nothing produces", "hint: add `clear:`"],
    );
}

#[test]
fn version_of_a_pass_that_does_not_write_the_part() {
    assert_says(
        "texture x rgba16float 8x8\ntexture y rgba16float 8x8\ntexture z rgba16float 8x8\n\
         pass make write x\npass male write y\npass use read x@male read y write z\noutput color z",
        "schedule::wrong-version",
        &["`use` reads the value of `x` as `male` left it, but `male` doesn't write it", "did you mean `make`?"],
    );
}

#[test]
fn output_that_nothing_produces() {
    assert_says(
        "texture x rgba16float 8x8\ntexture y rgba16float 8x8\npass a write y\noutput color x",
        "schedule::output-not-produced",
        &["output `color` is `x`, which nothing produces", "warning[schedule::unread-resource]: nothing reads `y`"],
    );
}

#[test]
fn output_that_is_nothing_but_a_declared_value_where_no_pass_runs() {
    assert_says(
        "texture x rgba16float 8x8 clear\ntexture y rgba16float 8x8\npass a write y\noutput color x",
        "schedule::nothing-runs",
        &["output `color` is the declared value of `x`, and no pass runs to fill it"],
    );
}

#[test]
fn output_of_a_version_that_is_changed() {
    assert_says(
        "texture x rgba16float 8x8\npass a write x\npass b modify x\noutput color x@a",
        "schedule::output-version",
        &["output `color` is the value that `a` left, but `b` changes it"],
    );
}

#[test]
fn reads_what_it_writes() {
    assert_says(
        "texture x rgba16float 8x8 mips 2\npass a write x\npass b read x modify x.mip(1)\noutput color x",
        "schedule::reads-what-it-writes",
        &["`b` reads `x.mip(1)` and modifies it"],
    );
    assert_says(
        "texture d depth32float 8x8\ntexture y rgba8unorm 8x8\npass a write d\npass b read d modify d write y\noutput color y",
        "schedule::reads-what-it-writes",
        &["set `depth: (write: false)`"],
    );
}

#[test]
fn cycle_names_every_pass_and_resource() {
    let problems = assert_says(
        "texture x rgba16float 8x8\ntexture y rgba16float 8x8\ntexture z rgba16float 8x8\n\
         pass a read z write x\npass b read x write y\npass c read y write z\noutput color z",
        "schedule::cycle",
        &[
            "passes wait for each other: `a` -> `b` -> `c` -> `a`",
            "`b` needs `x` from `a`",
            "`c` needs `y` from `b`",
            "`a` needs `z` from `c`",
        ],
    );
    assert_eq!(problems.matches("error[").count(), 1, "{problems}");
}

#[test]
fn cycle_through_a_version() {
    assert_says(
        "texture x rgba16float 8x8\ntexture y rgba16float 8x8\n\
         pass make write x\npass change modify x read y\npass use read x write y\noutput color y",
        "schedule::cycle",
        &["`change` needs `y` from `use`", "`use` needs `x` from `change`"],
    );
}

#[test]
fn cycle_of_after() {
    assert_says(
        "texture x rgba16float 8x8\ntexture y rgba16float 8x8\npass a write x after b\npass b write y after a\noutput one x\noutput two y",
        "schedule::after-cycle",
        &["`b` says that it comes after `a`", "`a` says that it comes after `b`", "take one of these `after` away"],
    );
    assert_says("texture x rgba16float 8x8\npass a write x after a\noutput one x", "schedule::after-cycle", &["`a` waits for itself"]);
}

#[test]
fn every_problem_is_reported_at_once() {
    let problems = fixture(
        "texture x rgba16float 8x8\ntexture y rgba16float 8x8\ntexture z rgba16float 8x8\ntexture w rgba16float 8x8\n\
         pass a write x\npass b write x\npass c read y write z\npass d read w\npass e read z write w after f\npass f read w\noutput color y",
    )
    .problems();
    for code in ["two-producers", "nothing-produces", "output-not-produced", "cycle"] {
        assert!(problems.contains(code), "{code} in\n{problems}");
    }
}

#[test]
fn depth_that_is_only_tested_against_needs_no_reader() {
    let graph = fixture("texture d depth32float 8x8\ntexture y rgba8unorm 8x8\npass a write d\npass b modify d write y\noutput color y");
    assert_eq!(graph.problems(), "");
}

#[test]
fn branches_run_one_after_the_other() {
    let mut text = "texture source rgba16float 1920x1080\ntexture sum rgba16float 1920x1080\npass source write source\n".to_owned();
    let (mut level_a, mut level_b, mut level_c) = (String::new(), String::new(), String::new());
    let mut gather = "pass gather write sum".to_owned();
    for branch in 0..40 {
        text += &format!(
            "texture a{branch} rgba16float 1920x1080\ntexture b{branch} rgba8unorm 1920x1080\ntexture c{branch} rgba8unorm 240x135\n"
        );
        level_a += &format!("pass a{branch} read source write a{branch}\n");
        level_b += &format!("pass b{branch} read a{branch} write b{branch}\n");
        level_c += &format!("pass c{branch} read b{branch} write c{branch}\n");
        gather += &format!(" read c{branch}");
    }
    text += &format!("{level_a}{level_b}{level_c}{gather}\noutput color sum");
    let plan = fixture(&text).plan();
    assert!(plan.figures.reached * 10 < plan.declared_bound(), "{:?}", plan.figures);
}

/// Two hundred writers of a part each and two hundred readers of the whole.
fn many_to_many(tail: &str) -> support::Fixture {
    let mut text = "texture x rgba8unorm 8x8 layers 200\ntexture sum rgba8unorm 8x8\n".to_owned();
    let mut gather = "pass gather write sum".to_owned();
    for index in 0..200 {
        text += &format!("texture y{index} rgba8unorm 8x8\npass read{index} read x write y{index}\n");
        gather += &format!(" read y{index}");
    }
    for index in 0..199 {
        text += &format!("pass make{index} write x.layer({index})\n");
    }
    fixture(&format!("{text}{gather}\n{tail}output color sum"))
}

#[test]
fn many_readers_of_many_writers() {
    let order = many_to_many("pass last write x.layer(199)\n").order();
    assert_eq!(order.len(), 401);
    let place = |name: &str| order.iter().position(|pass| pass == name).unwrap();
    assert!((0..200).all(|reader| place("last") < place(&format!("read{reader}"))));
}

#[test]
fn cycle_through_many_readers_of_many_writers_names_passes_alone() {
    let problems = many_to_many("pass last write x.layer(199) read y7\n").problems();
    assert!(problems.contains("passes wait for each other: `read7` -> `last` -> `read7`"), "{problems}");
    assert!(problems.contains("`read7` needs `x` from `last`"), "{problems}");
}
