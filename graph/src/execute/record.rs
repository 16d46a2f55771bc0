//! A backend that writes each verb down as a line of text and touches no GPU.
//!
//! The lines name resources and passes, never indices alone, so that a test reads like the plan that it checks.

use std::convert::Infallible;

use super::Backend;
use crate::dirty::StepRun;
use crate::expand::types::{ClearValue, ResourceId};
use crate::plan::{Memory, MemoryId, MemoryKind, PartView, Plan, StepKind, Workgroups};

/// What a plan made a backend do.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Recorder {
    /// One verb each, in order.
    pub lines: Vec<String>,
}

impl Recorder {
    /// All lines as one text.
    pub fn text(&self) -> String {
        self.lines.iter().flat_map(|line| [line.as_str(), "\n"]).collect()
    }
}

impl Backend for Recorder {
    type Error = Infallible;

    fn create_memory(&mut self, plan: &Plan, memory: MemoryId) -> Result<(), Infallible> {
        let held = &plan.memories[memory.index()];
        self.lines.push(format!("create memory {}: {} for {}", memory.0, describe(held), names(plan, held)));
        Ok(())
    }

    fn prepare_step(&mut self, plan: &Plan, step: usize) -> Result<(), Infallible> {
        self.lines.push(format!("prepare {}", plan.steps[step].name));
        Ok(())
    }

    fn fill(&mut self, plan: &Plan, filled: &PartView, value: ClearValue) -> Result<(), Infallible> {
        self.lines.push(format!("fill {} with {}", part(plan, filled), value_text(&value)));
        Ok(())
    }

    fn run_step(&mut self, plan: &Plan, run: &StepRun) -> Result<(), Infallible> {
        let step = &plan.steps[run.step];
        let what = match &step.kind {
            StepKind::Draw { .. } => "draw".to_owned(),
            StepKind::Procedural { .. } => "procedural".to_owned(),
            StepKind::Fullscreen { .. } => "fullscreen".to_owned(),
            StepKind::Compute { groups: Workgroups::Fixed([x, y, z]), .. } => format!("compute {x}x{y}x{z}"),
            StepKind::Compute { groups: Workgroups::Indirect { buffer, .. }, .. } => format!("compute by {}", name(plan, *buffer)),
            StepKind::Remember { source, target, .. } => format!("remember {} in {}", part(plan, source), part(plan, target)),
            StepKind::Copy { source, target } => format!("copy {} to {}", part(plan, source), part(plan, target)),
            StepKind::Image { target, image } => format!("image {} in {}", image.name, part(plan, target)),
            StepKind::Clear { target, value } => format!("clear {} to {}", part(plan, target), value_text(value)),
        };
        let iterations = if run.iterations.is_empty() { String::new() } else { format!(" {:?}", run.iterations) };
        self.lines.push(format!("run {}{iterations}: {what}", step.name));
        Ok(())
    }

    fn poison(&mut self, plan: &Plan, resource: ResourceId) -> Result<(), Infallible> {
        self.lines.push(format!("poison {}", name(plan, resource)));
        Ok(())
    }

    fn submit(&mut self, _plan: &Plan) -> Result<(), Infallible> {
        self.lines.push("submit".to_owned());
        Ok(())
    }

    fn abandon(&mut self) {
        self.lines.push("abandon".to_owned());
    }
}

fn describe(memory: &Memory) -> String {
    match &memory.kind {
        MemoryKind::Texture(shape, format) => format!(
            "texture {:?} {format} {}x{}x{}, {} layers, {} mips, {} samples",
            shape.dimension, shape.width, shape.height, shape.depth, shape.layers, shape.mips, shape.samples
        ),
        MemoryKind::Arena => format!("arena of {} bytes", memory.bytes),
    }
}

fn names(plan: &Plan, memory: &Memory) -> String {
    let names: Vec<&str> = memory.holders.iter().map(|holder| name(plan, *holder)).collect();
    names.join(", ")
}

fn name(plan: &Plan, resource: ResourceId) -> &str {
    &plan.resources[resource.index()].name
}

fn part(plan: &Plan, view: &PartView) -> String {
    let range = |range: &std::ops::Range<u32>| {
        if range.end == range.start + 1 { range.start.to_string() } else { format!("{}..{}", range.start, range.end) }
    };
    format!("{}.mip({}).layer({})", name(plan, view.resource), range(&view.mips), range(&view.layers))
}

fn value_text(value: &ClearValue) -> String {
    match value {
        ClearValue::Zero => "zero".to_owned(),
        ClearValue::Color([r, g, b, a]) => format!("({r}, {g}, {b}, {a})"),
        ClearValue::Depth(depth) => format!("depth {depth}"),
        ClearValue::Uint([r, g, b, a]) => format!("uint ({r}, {g}, {b}, {a})"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;

    use crate::dirty::{Frame, Tracker};
    use crate::execute::{execute, execute_poisoned, prepare};
    use crate::expand::types::PassId;
    use crate::plan::{Access, MemoryFigures, Placement, PlannedResource, PlannedShape, Role, Step, Usage, Use};
    use crate::reflect::interface::ViewDimension;
    use crate::source::Span;

    fn view(resource: u32) -> PartView {
        PartView { resource: ResourceId(resource), mips: 0..1, layers: 0..1, dimension: ViewDimension::D2 }
    }

    fn step(name: &str, kind: StepKind) -> Step {
        Step {
            pass: PassId(0),
            name: name.into(),
            span: Span::NOWHERE,
            shader: None,
            kind,
            bindings: Vec::new(),
            constants: Vec::new(),
            clears: Vec::new(),
            uses: Vec::new(),
            run: Default::default(),
            batch: Vec::new(),
            inputs: Vec::new(),
        }
    }

    /// Two buffers in one arena; the second step is cleared first.
    fn plan() -> Plan {
        let resource = |(name, offset): (&str, u64)| PlannedResource {
            name: name.to_owned(),
            span: Span::NOWHERE,
            shape: PlannedShape::Buffer(16),
            usage: Usage::default(),
            bytes: 16,
            lifetime: 0..2,
            placement: Some(Placement { memory: MemoryId(0), offset }),
            retained: None,
            alone: None,
            clear: None,
            retained_for: Vec::new(),
            history: None,
        };
        let holders = vec![ResourceId(0), ResourceId(1)];
        let mut copy = step("copy", StepKind::Copy { source: view(0), target: view(1) });
        copy.clears.push((view(1), ClearValue::Uint([1, 2, 3, 4])));
        Plan {
            name: "test.ron".to_owned(),
            doc: String::new(),
            extent: [1, 1],
            params: Vec::new(),
            resources: [("a", 0), ("b", 256)].map(resource).to_vec(),
            memories: vec![Memory { kind: MemoryKind::Arena, usage: Usage::default(), bytes: 272, holders }],
            shaders: Vec::new(),
            steps: vec![step("reset", StepKind::Clear { target: view(0), value: ClearValue::Zero }), copy],
            culled: Vec::new(),
            inputs: Vec::new(),
            spreads: Vec::new(),
            views: Vec::new(),
            draw_lists: Vec::new(),
            outputs: Vec::new(),
            figures: MemoryFigures::default(),
            flow: Default::default(),
            requirements: Vec::new(),
        }
    }

    fn frame(plan: &Plan) -> Arc<Frame> {
        Tracker::new(Arc::new(plan.clone())).frame(&[])
    }

    #[test]
    fn verbs_come_in_the_promised_order() {
        let plan = plan();
        let mut recorder = Recorder::default();
        prepare(&plan, &[None], &mut recorder).unwrap();
        execute(&plan, &frame(&plan), &mut recorder).unwrap();
        let wanted = "create memory 0: arena of 272 bytes for a, b\n\
            prepare reset\n\
            prepare copy\n\
            run reset: clear a.mip(0).layer(0) to zero\n\
            fill b.mip(0).layer(0) with uint (1, 2, 3, 4)\n\
            run copy: copy a.mip(0).layer(0) to b.mip(0).layer(0)\n\
            submit\n";
        assert_eq!(recorder.text(), wanted);
    }

    #[test]
    fn what_is_taken_over_is_not_created_and_nothing_is_submitted_for_nothing() {
        let plan = plan();
        let mut recorder = Recorder::default();
        prepare(&plan, &[Some(MemoryId(0))], &mut recorder).unwrap();
        assert_eq!(recorder.text(), "prepare reset\nprepare copy\n");
        let mut tracker = Tracker::new(Arc::new(plan.clone()));
        let first = tracker.frame(&[]);
        tracker.commit(&first, &[]);
        let mut idle = Recorder::default();
        execute(&plan, &tracker.frame(&[]), &mut idle).unwrap();
        assert_eq!(idle.text(), "");
    }

    #[test]
    fn bytes_are_poisoned_when_they_change_hands_and_only_then() {
        // `b` lies in the bytes of `a`, and `a` is made again after it.
        let mut plan = plan();
        plan.resources[1].placement = Some(Placement { memory: MemoryId(0), offset: 0 });
        plan.steps.push(step("again", StepKind::Clear { target: view(0), value: ClearValue::Zero }));
        let writes = |resource| Use {
            resource: ResourceId(resource),
            mips: 0..1,
            layers: 0..1,
            role: Role::Produce,
            access: Access::Clear,
            version: None,
            slot: String::new(),
            span: Span::NOWHERE,
        };
        for (step, resource) in [(0, 0), (1, 1), (2, 0)] {
            plan.steps[step].uses = vec![writes(resource)];
        }
        let mut tracker = Tracker::new(Arc::new(plan.clone()));
        let mut recorder = Recorder::default();
        let frame = tracker.frame(&[]);
        execute_poisoned(&tracker, &frame, &mut recorder).unwrap();
        let wanted = "poison a\n\
            run reset: clear a.mip(0).layer(0) to zero\n\
            poison b\n\
            fill b.mip(0).layer(0) with uint (1, 2, 3, 4)\n\
            run copy: copy a.mip(0).layer(0) to b.mip(0).layer(0)\n\
            poison a\n\
            run again: clear a.mip(0).layer(0) to zero\n\
            submit\n";
        assert_eq!(recorder.text(), wanted);
        // Apart from each other, both are there after the first frame.
        plan.resources[1].placement = Some(Placement { memory: MemoryId(0), offset: 256 });
        tracker = Tracker::new(Arc::new(plan));
        let all = tracker.frame(&[]);
        tracker.commit(&all, &[]);
        let mut apart = Recorder::default();
        execute_poisoned(&tracker, &all, &mut apart).unwrap();
        assert!(!apart.text().contains("poison"), "{}", apart.text());
    }

    /// Fails at everything.
    struct Broken(Vec<&'static str>);

    impl Backend for Broken {
        type Error = &'static str;

        fn create_memory(&mut self, _: &Plan, _: MemoryId) -> Result<(), &'static str> {
            Ok(())
        }

        fn prepare_step(&mut self, _: &Plan, _: usize) -> Result<(), &'static str> {
            Err("prepare")
        }

        fn fill(&mut self, _: &Plan, _: &PartView, _: ClearValue) -> Result<(), &'static str> {
            Ok(())
        }

        fn run_step(&mut self, _: &Plan, _: &StepRun) -> Result<(), &'static str> {
            Err("run")
        }

        fn poison(&mut self, _: &Plan, _: ResourceId) -> Result<(), &'static str> {
            Ok(())
        }

        fn submit(&mut self, _: &Plan) -> Result<(), &'static str> {
            self.0.push("submit");
            Ok(())
        }

        fn abandon(&mut self) {
            self.0.push("abandon");
        }
    }

    #[test]
    fn all_errors_of_preparation_and_the_first_of_a_frame() {
        let mut broken = Broken(Vec::new());
        assert_eq!(prepare(&plan(), &[], &mut broken), Err(vec!["prepare"; 2]));
        assert_eq!(execute(&plan(), &frame(&plan()), &mut broken), Err("run"));
        assert_eq!(broken.0, ["abandon"]);
    }
}
