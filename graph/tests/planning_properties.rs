//! Random graphs against a checker that knows nothing of the planner: order, culling, memory and figures.
#![allow(clippy::unwrap_used, clippy::panic)]

mod support;

use std::collections::{BTreeMap, BTreeSet};

use luminaire_graph::allocate::allocate;
use luminaire_graph::assemble::assemble;
use luminaire_graph::bind::types::Bound;
use luminaire_graph::device::DeviceFacts;
use luminaire_graph::dump;
use luminaire_graph::expand::types::PassId;
use luminaire_graph::lifetime::lifetimes;
use luminaire_graph::place::Alignment;
use luminaire_graph::plan::Role;
use luminaire_graph::schedule::Schedule;
use proptest::prelude::*;
use proptest::test_runner::FileFailurePersistence;
use support::{Fixture, Planned, fixture};

/// Choices out of a list of numbers, so that a failing graph shrinks.
struct Choices<'a>(std::slice::Iter<'a, u16>);

impl Choices<'_> {
    fn below(&mut self, limit: usize) -> usize {
        usize::from(self.0.next().copied().unwrap_or(0)) % limit.max(1)
    }

    fn chance(&mut self, per_cent: usize) -> bool {
        // Exhausted choices answer no, so that shrunk graphs are small.
        99 - self.below(100) < per_cent
    }
}

/// A graph in the notation, built along a time line: each resource is produced, perhaps read in a version, modified, and only
/// then read. Two shuffles of its lines mean the same.
struct Random {
    declarations: String,
    passes: Vec<String>,
    outputs: String,
    /// Passes whose order among each other has a meaning.
    chains: Vec<Vec<usize>>,
}

fn random(numbers: &[u16]) -> Random {
    let mut choose = Choices(numbers.iter());
    let mut random = Random { declarations: String::new(), passes: Vec::new(), outputs: String::new(), chains: Vec::new() };
    let mut finished: Vec<Vec<String>> = Vec::new();
    let resources = 3 + choose.below(10);
    for index in 0..resources {
        let name = format!("x{index}");
        let clear = choose.chance(30);
        let tail = if clear { " clear" } else { "" };
        let cuts: Vec<String> = if choose.chance(25) {
            random.declarations += &format!("buffer {name} {}{tail}\n", [4, 100, 256, 1000, 70_000][choose.below(5)]);
            vec![String::new()]
        } else {
            let format = ["rgba16float", "rgba8unorm", "r32float"][choose.below(3)];
            let (mips, cube) = (1 + choose.below(4), choose.chance(20));
            let edge = [8, 64, 100][choose.below(3)];
            let shape = if cube { " cube" } else { "" };
            random.declarations += &format!("texture {name} {format} {edge}x{edge} mips {mips}{shape}{tail}\n");
            match choose.below(3) {
                1 => (0..mips).map(|mip| format!(".mip({mip})")).collect(),
                2 if cube => (0..6).map(|layer| format!(".layer({layer})")).collect(),
                _ => vec![String::new()],
            }
        };
        let mut modifiers = Vec::new();
        for cut in &cuts {
            let part = format!("{name}{cut}");
            let mut last = None;
            if !(clear && choose.chance(40)) {
                let number = random.passes.len();
                // A part may be made from another of the same resource that stands.
                let pass = format!("pass p{number} write {part}{}", reads(&mut choose, &finished));
                random.passes.push(pass);
                last = Some(number);
            }
            for _ in 0..choose.below(3) {
                if let Some(last) = last
                    && choose.chance(40)
                {
                    let (number, seen) = (random.passes.len(), format!("v{}", random.passes.len()));
                    random.declarations += &format!("texture {seen} rgba8unorm 8x8\n");
                    random.passes.push(format!("pass p{number} read {part}@p{last} write {seen}"));
                    finished.push(vec![seen]);
                }
                let number = random.passes.len();
                random.passes.push(format!("pass p{number} modify {part}{}", reads(&mut choose, &finished)));
                modifiers.push(number);
                last = Some(number);
            }
        }
        random.chains.push(modifiers);
        finished.push(cuts.iter().map(|cut| format!("{name}{cut}")).chain([name.clone()]).collect());
    }
    // Something always runs.
    random.declarations += "texture end rgba8unorm 4x4\n";
    random.passes.push("pass end write end".to_owned());
    random.outputs += "output end end\n";
    for output in 0..1 + choose.below(3) {
        let parts = &finished[choose.below(finished.len())];
        random.outputs += &format!("output o{output} {}\n", parts[choose.below(parts.len())]);
    }
    random
}

fn reads(choose: &mut Choices<'_>, finished: &[Vec<String>]) -> String {
    let mut text = String::new();
    let mut taken = BTreeSet::new();
    for _ in 0..choose.below(4).min(finished.len()) {
        let resource = choose.below(finished.len());
        if taken.insert(resource) {
            text += &format!(" read {}", finished[resource][choose.below(finished[resource].len())]);
        }
    }
    text
}

impl Random {
    /// The passes in an order that the numbers choose; modifiers of a resource keep theirs.
    fn shuffled(&self, numbers: &[u16]) -> Fixture {
        let mut places: Vec<usize> = (0..self.passes.len()).collect();
        let mut choose = Choices(numbers.iter());
        for place in (1..places.len()).rev() {
            places.swap(place, choose.below(place + 1));
        }
        for chain in &self.chains {
            let mut own: Vec<usize> = chain.iter().map(|pass| places[*pass]).collect();
            own.sort_unstable();
            for (pass, place) in chain.iter().zip(own) {
                places[*pass] = place;
            }
        }
        let mut lines = vec![""; self.passes.len()];
        for (pass, place) in places.iter().enumerate() {
            lines[*place] = &self.passes[pass];
        }
        fixture(&format!("{}{}\n{}", self.declarations, lines.join("\n"), self.outputs))
    }
}

/// One mip level of one layer.
type Cell = (u32, u32, u32);

/// Writers of every cell: the producer, then modifiers in the order of the file.
fn writers(bound: &Bound) -> BTreeMap<Cell, Vec<usize>> {
    let mut writers: BTreeMap<Cell, Vec<usize>> = BTreeMap::new();
    for role in [Role::Produce, Role::Modify] {
        for (pass, step) in bound.steps.iter().enumerate() {
            for used in step.uses.iter().filter(|used| used.role == role) {
                for cell in cells(used.resource.0, &used.mips, &used.layers) {
                    writers.entry(cell).or_default().push(pass);
                }
            }
        }
    }
    writers
}

fn cells(resource: u32, mips: &std::ops::Range<u32>, layers: &std::ops::Range<u32>) -> Vec<Cell> {
    mips.clone().flat_map(|mip| layers.clone().map(move |layer| (resource, mip, layer))).collect()
}

/// The passes that outputs need, by repetition until nothing changes.
fn needed(bound: &Bound, plan: &luminaire_graph::plan::Plan) -> BTreeSet<usize> {
    let writers = writers(bound);
    let mut wanted: BTreeSet<(Cell, usize)> = BTreeSet::new();
    for output in &plan.outputs {
        for cell in cells(output.view.resource.0, &output.view.mips, &output.view.layers) {
            wanted.extend(writers.get(&cell).map(|chain| (cell, chain.len())));
        }
    }
    let mut alive: BTreeSet<usize> = BTreeSet::new();
    loop {
        let before = (alive.len(), wanted.len());
        for (cell, count) in &wanted {
            alive.extend(&writers[cell][..*count]);
        }
        for pass in &alive {
            for used in &bound.steps[*pass].uses {
                for cell in cells(used.resource.0, &used.mips, &used.layers) {
                    let Some(chain) = writers.get(&cell) else { continue };
                    let count = match (used.role, used.version) {
                        (Role::Read, None) => chain.len(),
                        (Role::Read, Some(version)) => 1 + chain.iter().position(|writer| *writer == version.index()).unwrap(),
                        _ => 1 + chain.iter().position(|writer| writer == pass).unwrap(),
                    };
                    wanted.insert((cell, count));
                }
            }
        }
        if before == (alive.len(), wanted.len()) {
            return alive;
        }
    }
}

fn check_order(bound: &Bound, order: &[PassId]) -> Result<(), TestCaseError> {
    let place: BTreeMap<usize, usize> = order.iter().enumerate().map(|(place, pass)| (pass.index(), place)).collect();
    prop_assert_eq!(place.len(), order.len());
    for (cell, chain) in writers(bound) {
        let chain: Vec<usize> = chain.into_iter().filter(|pass| place.contains_key(pass)).collect();
        prop_assert!(chain.is_sorted_by_key(|pass| place[pass]), "writers of {cell:?} run as {chain:?}");
        for (pass, at) in &place {
            for used in bound.steps[*pass].uses.iter().filter(|used| used.role == Role::Read && used.resource.0 == cell.0) {
                if used.mips.contains(&cell.1) && used.layers.contains(&cell.2) {
                    let seen = chain.iter().rfind(|writer| place[writer] < *at).copied();
                    let expected = used.version.map_or(chain.last().copied(), |version| Some(version.index()));
                    prop_assert_eq!(seen, expected, "pass {} reads {:?}", pass, cell);
                }
            }
        }
    }
    Ok(())
}

fn device() -> DeviceFacts {
    DeviceFacts { memory_budget: u64::MAX, ..DeviceFacts::webgpu_defaults() }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: Some(Box::new(FileFailurePersistence::Off)), ..ProptestConfig::default() })]

    #[test]
    fn plans_hold(numbers in prop::collection::vec(any::<u16>(), 20..300), shuffle in prop::collection::vec(any::<u16>(), 0..80)) {
        let graph = random(&numbers);
        let fixture = graph.shuffled(&shuffle);
        let Planned { schedule, lifetimes: spans, allocation } = fixture.planned();
        check_order(&fixture.bound, &schedule.order)?;
        check_order(&fixture.bound, &schedule.declared)?;

        let figures = allocation.figures;
        prop_assert!(figures.bound <= figures.reached, "{:?}", figures);
        prop_assert!(figures.reached <= figures.without_sharing, "{:?}", figures);

        // The chosen order is never worse than the declared one.
        let declared = Schedule { order: schedule.declared.clone(), ..schedule.clone() };
        let same = allocate(&fixture.bound, &declared, &lifetimes(&fixture.bound, &declared, spans.retained.clone()), &device()).unwrap();
        prop_assert!(figures.reached <= same.figures.reached);

        let plan = assemble(fixture.bound.clone(), schedule.clone(), spans, allocation, Vec::new(), "test.graph", [64, 64]);
        prop_assert_eq!(plan.self_check(), Vec::<String>::new());
        prop_assert_eq!(plan.declared_bound(), same.figures.bound);
        let placed = plan.placed();
        check_order(&fixture.bound, &placed.order)?;
        prop_assert_eq!(plan.check_placed(&placed, Alignment::default()), Vec::<String>::new());
        prop_assert!(placed.bound <= placed.declared_bound);
        let tight = Alignment { texture: 256, buffer: 512 };
        prop_assert_eq!(plan.check_placed(&schedule.placed(tight), tight), Vec::<String>::new());
        let alive: BTreeSet<usize> = schedule.order.iter().map(|pass| pass.index()).collect();
        prop_assert_eq!(&alive, &needed(&fixture.bound, &plan));
        prop_assert_eq!(alive.len() + schedule.culled.len(), fixture.bound.steps.len());

        // Every sharer or reason is there, and the dumps are the same again.
        for resource in &plan.resources {
            prop_assert!(resource.placement.is_none() || resource.alone.is_some() || plan.memories[resource.placement.unwrap().memory.index()].holders.len() > 1);
        }
        let again = graph.shuffled(&shuffle).plan();
        let text = |plan| dump::text(plan, &fixture.sources);
        prop_assert_eq!(text(&plan), text(&again));
        prop_assert_eq!(dump::dot(&plan), dump::dot(&again));
        prop_assert_eq!(dump::json(&plan, &fixture.sources).to_string(), dump::json(&again, &fixture.sources).to_string());
    }

    #[test]
    fn order_of_the_file_decides_nothing_but_ties(numbers in prop::collection::vec(any::<u16>(), 20..300), shuffle in prop::collection::vec(any::<u16>(), 0..80)) {
        let graph = random(&numbers);
        let names = |fixture: &Fixture| fixture.order().into_iter().collect::<BTreeSet<String>>();
        prop_assert_eq!(names(&graph.shuffled(&[])), names(&graph.shuffled(&shuffle)));
    }
}
