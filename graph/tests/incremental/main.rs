//! Running only what changed gives what running everything gives, and nothing that need not runs.
//!
//! Random pipelines with loops, batches, parts, modifiers, versions, history, Spread, Accumulate and every-frame passes, under random
//! changes: inputs, edited shaders, resizes, passes that come and go, other outputs, frames that fail, lost devices. After every
//! frame, on a device whose memory is poisoned at creation and between users:
//!
//! - every read and every output has the value that the interpreter gives it;
//! - a pass is due if and only if something that it reads has another value than when it last ran;
//! - the amortised passes that run are the interpreter's;
//! - a unit that only runs for the sake of others is missed by somebody if it is left out.
//!
//! Accepted: history and amortised passes are proved apart from each other; cycles through both are not among the pipelines yet.
//!
//! `INCREMENTAL_CASES` says how many pipelines of each kind; each meets 20 changes.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, missing_docs, unreachable_pub)]

mod interpreter;
mod simulation;
mod spec;
mod value;

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::sync::Arc;

use interpreter::{Interpreter, Meaning};
use luminaire_graph::allocate::allocate;
use luminaire_graph::assemble::assemble;
use luminaire_graph::device::DeviceFacts;
use luminaire_graph::dirty::{Tracker, retention};
use luminaire_graph::execute;
use luminaire_graph::expand::types::{ResourceId, Run};
use luminaire_graph::lifetime::lifetimes;
use luminaire_graph::plan::Plan;
use luminaire_graph::schedule::schedule;
use proptest::prelude::*;
use proptest::test_runner::FileFailurePersistence;
use simulation::Simulation;
use spec::{Choices, INPUTS, Kinds, Spec, random};
use value::{DECLARED, Node, ground, hash, layers, noticed};

/// `None` where the pipeline is wrong, as when a producer is off and no value is declared.
fn plan_of(spec: &Spec) -> Option<Arc<Plan>> {
    // A version of a pass that does not stand is an error of an earlier step.
    let mut versions = spec.passes.iter().filter(|pass| !pass.off).flat_map(|pass| &pass.reads).filter_map(|read| read.version);
    if versions.any(|version| spec.passes[version].off) {
        return None;
    }
    let bound = spec.bound();
    let device = DeviceFacts { memory_budget: u64::MAX, ..DeviceFacts::webgpu_defaults() };
    let kept = retention(&bound);
    let schedule = schedule(&bound, &kept.retained).ok()?;
    let spans = lifetimes(&bound, &schedule, kept.retained);
    let allocation = allocate(&bound, &schedule, &spans, &device).ok()?;
    Some(Arc::new(assemble(bound, schedule, spans, allocation, kept.for_inputs, "random", [64, 64])))
}

struct World {
    spec: Spec,
    plan: Arc<Plan>,
    tracker: Tracker,
    device: Simulation,
    meaning: Interpreter,
    revisions: Vec<u64>,
    /// What each pass saw when it last ran.
    seen: HashMap<(String, Option<u32>), u64>,
    next: u64,
    /// What happened, for messages.
    log: Vec<String>,
}

impl World {
    /// The pipeline and what happened to it.
    fn told(&self) -> String {
        let mut text = format!("outputs {:?}\n", self.spec.outputs);
        for resource in &self.spec.resources {
            text += &format!("{resource:?}\n");
        }
        for pass in &self.spec.passes {
            text += &format!("{pass:?}\n");
        }
        text + &self.log.join("\n")
    }

    fn new(spec: Spec) -> Option<World> {
        let plan = plan_of(&spec)?;
        let mut device = Simulation::default();
        execute::prepare(&plan, &[], &mut device).ok()?;
        Some(World {
            tracker: Tracker::new(Arc::clone(&plan)),
            spec,
            plan,
            device,
            meaning: Interpreter::default(),
            revisions: vec![0; INPUTS as usize],
            seen: HashMap::new(),
            next: 1,
            log: Vec::new(),
        })
    }

    fn alive(&self) -> BTreeSet<String> {
        self.plan.steps.iter().map(|step| step.name.to_string()).collect()
    }

    /// The revisions of the plan's inputs, which are those that some pass takes.
    fn of_plan(&self) -> Vec<u64> {
        let inputs = self.tracker.inputs().iter();
        inputs
            .map(|input| {
                (0..INPUTS as usize)
                    .find(|at| format!("{input:?}") == format!("Table(\"i{at}\", Whole)"))
                    .map_or(0, |at| self.revisions[at])
            })
            .collect()
    }

    fn replan(&mut self, spec: Spec) -> Result<(), TestCaseError> {
        let Some(plan) = plan_of(&spec) else { return Ok(()) };
        prop_assert_eq!(plan.self_check(), Vec::<String>::new());
        let adoption = self.tracker.adopt(Arc::clone(&plan));
        self.device.adopt(&self.plan, &plan, &adoption);
        (self.plan, self.spec) = (plan, spec);
        execute::prepare(&self.plan, &adoption.memories, &mut self.device).map_err(|_| TestCaseError::fail("prepare"))?;
        let alive = self.alive();
        self.meaning.keep_only(&self.spec, &alive);
        self.seen.retain(|(name, _), _| alive.contains(name));
        let lost = self
            .plan
            .resources
            .iter()
            .filter(|resource| resource.placement.is_some_and(|placement| adoption.memories[placement.memory.index()].is_none()));
        let lost = lost.map(|resource| resource.name.clone()).collect();
        self.meaning.forget(&self.spec, &lost, &BTreeSet::new());
        Ok(())
    }

    fn change(&mut self, choose: &mut Choices<'_>) -> Result<bool, TestCaseError> {
        let mut spec = self.spec.clone();
        let kind = choose.below(13);
        self.log.push(format!("change {kind}"));
        match kind {
            0..=4 => {
                for _ in 0..1 + choose.below(2) {
                    self.revisions[choose.below(INPUTS as usize)] = self.next;
                    self.next += 1;
                }
            }
            5 => {
                let pass = choose.below(spec.passes.len());
                if spec.passes[pass].remembers.is_none() {
                    spec.passes[pass].salt = self.next as u32;
                    self.next += 1;
                    self.replan(spec)?;
                }
            }
            6 => {
                let edge = [8, 16, 32][choose.below(3)];
                for resource in spec.resources.iter_mut().filter(|resource| !resource.buffer) {
                    resource.edge = edge;
                }
                self.replan(spec)?;
            }
            7 => {
                let pass = choose.below(spec.passes.len());
                // What a pass leaves that has not had its turn, and what none leaves, is equal by chance; the past of both would be, too.
                let amortised = matches!(spec.passes[pass].run, Run::Accumulate(_) | Run::Spread { .. });
                let remembered = |part: &spec::Part| spec.passes.iter().any(|other| other.remembers == Some(part.resource));
                let has_past = amortised && spec.passes[pass].writes.iter().chain(&spec.passes[pass].modifies).any(remembered);
                if spec.passes[pass].remembers.is_none() && !has_past {
                    spec.passes[pass].off ^= true;
                    self.replan(spec)?;
                }
            }
            8 => {
                let shown: Vec<usize> = (0..spec.resources.len()).filter(|index| spec.resources[*index].history.is_none()).collect();
                spec.outputs = vec![shown[choose.below(shown.len())]];
                self.replan(spec)?;
            }
            9 => {
                self.revisions[choose.below(INPUTS as usize)] = self.next;
                self.next += 1;
                self.device.fails_after = Some(choose.below(4));
            }
            10 => {
                self.tracker.lose();
                self.meaning.lose();
                self.seen.clear();
                let mut device = Simulation { created: self.device.created, submitted: self.device.submitted, ..Simulation::default() };
                execute::prepare(&self.plan, &[], &mut device).map_err(|_| TestCaseError::fail("prepare"))?;
                self.device = device;
            }
            // The same again and again, as where a camera moves.
            11 => {
                let input = choose.below(INPUTS as usize);
                for _ in 0..6 {
                    self.revisions[input] = self.next;
                    self.next += 1;
                    self.frame()?;
                }
            }
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// What a pass sees: all that decides its value, and who made it.
    fn sight(&self, node: Node, meaning: &Meaning) -> u64 {
        let pass = &self.spec.passes[node.0];
        let mut values: Vec<u64> = pass.inputs.iter().map(|input| self.revisions[*input as usize]).collect();
        values.extend(node.1.map(|iteration| self.revisions[(iteration % INPUTS) as usize]));
        for part in &pass.reads {
            for layer in layers(&self.spec, &noticed(&self.spec, part), None) {
                values.push(meaning.at(part.resource, layer, part.version).unwrap_or(DECLARED));
            }
        }
        for part in &pass.modifies {
            for layer in layers(&self.spec, part, node.1) {
                values.push(meaning.before(part.resource, layer, node.0).unwrap_or(DECLARED));
            }
        }
        hash((&pass.name, pass.salt, pass.partial, ground(&self.spec, &self.alive(), node), values))
    }

    fn nodes(&self) -> Vec<(usize, Option<u32>, Node)> {
        let mut found = Vec::new();
        for (step, planned) in self.plan.steps.iter().enumerate() {
            let pass = self.spec.passes.iter().position(|pass| *pass.name == *planned.name).expect("a pass");
            match planned.batch.len() as u32 {
                0 => found.push((step, None, (pass, None))),
                count => found.extend((0..count).map(|iteration| (step, Some(iteration), (pass, Some(iteration))))),
            }
        }
        found
    }

    /// Shown or remembered cells that do not hold what they should.
    fn wrong_ends(&self, device: &mut Simulation) -> Vec<String> {
        let mut wrong = Vec::new();
        let remembered = self
            .spec
            .passes
            .iter()
            .filter(|pass| self.plan.steps.iter().any(|step| *step.name == *pass.name))
            .filter_map(|pass| pass.remembers);
        for resource in self.spec.outputs.iter().copied().chain(remembered).collect::<BTreeSet<_>>() {
            for layer in 0..self.spec.resources[resource].layers {
                let found = device.load(&self.plan, ResourceId(resource as u32), layer);
                let wanted = self.device.expected.get(&(resource, layer, None)).copied();
                if Some(found) != wanted {
                    wrong.push(format!("{}[{layer}] ends as {found:x}, wanted {wanted:x?}", self.spec.resources[resource].name));
                }
            }
        }
        wrong
    }

    fn frame(&mut self) -> Result<(), TestCaseError> {
        let alive = self.alive();
        let meaning = self.meaning.frame(&self.spec, &alive, &self.revisions);
        self.device.begin();
        self.device.frame = self.meaning.frames;
        self.device.revisions = self.revisions.clone();
        self.device.spec = self.spec.clone();
        self.device.expected = meaning.named(&self.spec);
        let revisions = self.of_plan();
        let frame = self.tracker.frame(&revisions);
        let runs = frame
            .runs
            .iter()
            .map(|run| format!("{}{:?} {:?} {:?}", self.plan.steps[run.step].name, run.iterations, run.remembered, run.why));
        self.log.push(format!("frame {:?} fails {:?}: {}", self.revisions, self.device.fails_after, runs.collect::<Vec<_>>().join("; ")));
        let due: BTreeSet<(usize, Option<u32>)> = self.tracker.changed(&frame).into_iter().collect();
        let mut sights = Vec::new();
        let mut amortised: BTreeMap<Node, u32> = BTreeMap::new();
        for (step, iteration, node) in self.nodes() {
            let pass = &self.spec.passes[node.0];
            let is_due = due.contains(&(step, iteration));
            match pass.run {
                Run::Accumulate(_) | Run::Spread { .. } => {
                    let run = frame.runs.iter().find(|run| run.step == step);
                    if let Some(run) = run.filter(|run| iteration.is_none_or(|iteration| run.iterations.contains(&iteration))) {
                        amortised.insert(node, run.accumulated);
                    }
                }
                Run::EveryFrame => prop_assert!(is_due, "`{}` runs in every frame", pass.name),
                Run::OnChange if pass.remembers.is_none() => {
                    let sight = self.sight(node, &meaning);
                    let known = self.seen.get(&(pass.name.clone(), iteration)).copied();
                    prop_assert_eq!(is_due, known != Some(sight), "`{}` {:?} is due: {}", pass.name, iteration, is_due);
                    sights.push(((pass.name.clone(), iteration), sight));
                }
                Run::OnChange => {}
            }
        }
        prop_assert_eq!(&amortised, &meaning.amortised, "amortised passes");
        let before = self.device.clone();
        let done = execute::execute(&self.plan, &frame, &mut self.device);
        if done.is_err() {
            let written = frame
                .runs
                .iter()
                .flat_map(|run| self.plan.steps[run.step].uses.iter())
                .filter(|used| !matches!(used.role, luminaire_graph::plan::Role::Read | luminaire_graph::plan::Role::Recall));
            let fills = frame.runs.iter().flat_map(|run| &run.fills).chain(&frame.last_fills).map(|(part, _)| part.resource);
            let lost: BTreeSet<String> =
                written.map(|used| used.resource).chain(fills).map(|id| self.plan.resources[id.index()].name.clone()).collect();
            let past = lost.iter().filter(|name| !self.device.carries(name)).cloned().collect();
            self.device.scramble(&self.plan, &lost);
            self.tracker.fail(&frame);
            self.meaning.forget(&self.spec, &lost, &past);
            self.device.fails_after = None;
            return Ok(());
        }
        self.device.fails_after = None;
        prop_assert_eq!(&self.device.wrong, &Vec::<String>::new());
        let mut device = self.device.clone();
        prop_assert_eq!(self.wrong_ends(&mut device), Vec::<String>::new());
        prop_assert_eq!(self.device.submitted, before.submitted + usize::from(!frame.is_empty()));
        self.nothing_is_needless(&frame, &due, &before)?;
        if frame.is_empty() {
            return Ok(());
        }
        self.tracker.commit(&frame, &revisions);
        self.meaning.submitted(meaning);
        self.seen.extend(sights);
        Ok(())
    }

    /// Whoever runs for the sake of others is missed.
    fn nothing_is_needless(
        &self,
        frame: &luminaire_graph::dirty::Frame,
        due: &BTreeSet<(usize, Option<u32>)>,
        before: &Simulation,
    ) -> Result<(), TestCaseError> {
        let mut units: BTreeMap<u32, BTreeSet<(usize, Option<u32>)>> = BTreeMap::new();
        for run in &frame.runs {
            let iterations: Vec<Option<u32>> =
                if run.iterations.is_empty() { vec![None] } else { run.iterations.iter().copied().map(Some).collect() };
            for iteration in iterations {
                units.entry(self.tracker.unit(run.step, iteration)).or_default().insert((run.step, iteration));
            }
        }
        for nodes in units.into_values().filter(|nodes| nodes.is_disjoint(due)) {
            let mut device = Simulation { without: nodes.clone(), ..before.clone() };
            let _ = execute::execute(&self.plan, frame, &mut device);
            let missed = !device.wrong.is_empty() || !self.wrong_ends(&mut device).is_empty();
            let names: Vec<&str> = nodes.iter().map(|(step, _)| &*self.plan.steps[*step].name).collect();
            prop_assert!(missed, "nobody needs {:?}", names);
        }
        Ok(())
    }
}

fn cases() -> u32 {
    std::env::var("INCREMENTAL_CASES").ok().and_then(|count| count.parse().ok()).unwrap_or(2_000)
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: cases(),
        failure_persistence: Some(Box::new(FileFailurePersistence::Off)),
        max_shrink_iters: 3_000,
        ..ProptestConfig::default()
    })]

    #[test]
    fn loops_batches_parts_and_versions(numbers in prop::collection::vec(any::<u16>(), 30..400), changes in prop::collection::vec(any::<u16>(), 0..120)) {
        incremental_is_full(Kinds { history: false, amortised: false }, &numbers, &changes)?;
    }

    #[test]
    fn history(numbers in prop::collection::vec(any::<u16>(), 30..400), changes in prop::collection::vec(any::<u16>(), 0..120)) {
        incremental_is_full(Kinds { history: true, amortised: false }, &numbers, &changes)?;
    }

    #[test]
    fn spread_and_accumulate(numbers in prop::collection::vec(any::<u16>(), 30..400), changes in prop::collection::vec(any::<u16>(), 0..120)) {
        incremental_is_full(Kinds { history: false, amortised: true }, &numbers, &changes)?;
    }

    #[test]
    fn everything(numbers in prop::collection::vec(any::<u16>(), 30..400), changes in prop::collection::vec(any::<u16>(), 0..120)) {
        incremental_is_full(Kinds { history: true, amortised: true }, &numbers, &changes)?;
    }
}

fn incremental_is_full(kinds: Kinds, numbers: &[u16], changes: &[u16]) -> Result<(), TestCaseError> {
    let Some(mut world) = World::new(random(&mut Choices(numbers.iter()), kinds)) else { return Ok(()) };
    let mut choose = Choices(changes.iter());
    let mut story = world.frame();
    for _ in 0..20 {
        story = story.and_then(|()| world.change(&mut choose)).and_then(|_| world.frame());
    }
    story.map_err(|error| TestCaseError::fail(format!("{error}\n{}", world.told())))
}
