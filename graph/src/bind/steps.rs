//! One pass to one step.

use std::collections::HashMap;
use std::hash::Hash;

use super::error::BindError;
use super::program::Program;
use super::slots::{Taken, Taker};
use super::{BindInput, formats as format_choice, limits, params, tables, targets, views, work};
use crate::device::Feature;
use crate::expand::types::{BatchIteration, ClearValue, Element, Expanded, PartRef, Pass, PassId, PassKind, Run, Shape, Work};
use crate::format::Format;
use crate::plan::{
    Access, Binding, BindingTarget, DrawReads, Input, InputId, PartView, Requirement, Role, Step, StepIteration, StepKind, Use,
};
use crate::published::{DrawFilter, RowReads, ViewKind, ViewRequest};
use crate::reflect::interface::{GlobalKind, Shader, StorageAccess};

/// Distinct values in the order of their first use, by index.
pub(super) struct Interner<T> {
    values: Vec<T>,
    indices: HashMap<T, usize>,
}

impl<T: Clone + Eq + Hash> Interner<T> {
    fn new() -> Interner<T> {
        Interner { values: Vec::new(), indices: HashMap::new() }
    }

    fn index(&mut self, value: T) -> usize {
        let next = self.values.len();
        if let Some(index) = self.indices.get(&value) {
            return *index;
        }
        self.indices.insert(value.clone(), next);
        self.values.push(value);
        next
    }

    pub(super) fn into_vec(self) -> Vec<T> {
        self.values
    }
}

/// Builds steps, and collects what they share.
pub(super) struct Builder<'a> {
    expanded: &'a Expanded,
    input: &'a BindInput<'a>,
    shaders: &'a [Shader],
    formats: &'a [Option<Format>],
    problems: &'a mut Vec<BindError>,
    pub views: Interner<ViewRequest>,
    pub draw_lists: Interner<(DrawFilter, ViewKind)>,
    pub inputs: Interner<Input>,
    pub requirements: Vec<Requirement>,
}

impl<'a> Builder<'a> {
    pub(super) fn new(
        expanded: &'a Expanded,
        input: &'a BindInput<'a>,
        shaders: &'a [Shader],
        formats: &'a [Option<Format>],
        problems: &'a mut Vec<BindError>,
    ) -> Builder<'a> {
        Builder {
            expanded,
            input,
            shaders,
            formats,
            problems,
            views: Interner::new(),
            draw_lists: Interner::new(),
            inputs: Interner::new(),
            requirements: Vec::new(),
        }
    }

    /// The step of a pass; `None` if something is wrong with it.
    pub(super) fn step(&mut self, index: usize, pass: &Pass, program: Option<&Program>, taken: &[Taken]) -> Option<Step> {
        let id = PassId(index as u32);
        let (kind, view) = match program {
            None if matches!(pass.kind, PassKind::Remember) => return self.remember(id, pass),
            None => (self.transfer(pass, taken)?, None),
            Some(program) => self.kind(pass, program, taken)?,
        };
        let mut bindings = Vec::new();
        let mut constants = Vec::new();
        if let Some(program) = program {
            bindings = self.bindings(pass, program, taken, view);
            let shader = &self.shaders[program.shader];
            let entries: Vec<_> = [program.vertex(self.shaders), program.main(self.shaders)].into_iter().flatten().collect();
            constants = params::constants(pass, shader, &entries, self.problems);
            for feature in &shader.features {
                self.require(*feature, pass, format!("for `{}`", shader.path));
            }
        }
        for slot in taken {
            if let Some(format) = self.formats[slot.part.resource.index()]
                && let Some((feature, what)) = format_choice::feature_for(format, &slot.taker)
                // Where it is missing, the choice of formats has said so.
                && self.input.device.features.contains(&feature)
            {
                let resource = &self.expanded.resources[slot.part.resource.index()].name;
                self.require(feature, pass, format!("{what} `{resource}` ({format})"));
            }
        }
        let clears = self.clears(pass, taken);
        let uses: Vec<Use> = taken.iter().map(|slot| self.touch(pass, slot)).collect();
        let inputs = self.step_inputs(pass, program, &kind, &bindings);
        let batch = pass.batch.as_ref().map_or_else(Vec::new, |batch| {
            batch.iterations.iter().map(|iteration| self.iteration(pass, program, &uses, iteration)).collect()
        });
        Some(Step {
            pass: id,
            name: pass.name.clone(),
            span: pass.span,
            shader: program.map(|program| program.shader),
            kind,
            bindings,
            constants,
            clears,
            uses,
            run: pass.run,
            batch,
            inputs,
        })
    }

    /// A generated pass: what its history's resource held at the end of the last frame.
    fn remember(&self, id: PassId, pass: &Pass) -> Option<Step> {
        let target = pass.writes.first()?.part;
        let history = self.expanded.resources[target.resource.index()].history?;
        let source = PartRef { resource: history.of, ..target };
        let view = |part: &PartRef| views::whole(&self.expanded.resources[part.resource.index()], part);
        let used = |part: &PartRef, role, access, slot: &str| {
            let PartView { mips, layers, .. } = view(part);
            Use { resource: part.resource, mips, layers, role, access, version: None, slot: slot.to_owned(), span: pass.span }
        };
        Some(Step {
            pass: id,
            name: pass.name.clone(),
            span: pass.span,
            shader: None,
            kind: StepKind::Remember { source: view(&source), target: view(&target), first: history.first, on_resize: history.on_resize },
            bindings: Vec::new(),
            constants: Vec::new(),
            clears: Vec::new(),
            uses: vec![used(&source, Role::Recall, Access::CopySource, "read"), used(&target, Role::Produce, Access::CopyTarget, "write")],
            run: Run::OnChange,
            batch: Vec::new(),
            inputs: Vec::new(),
        })
    }

    /// What a step takes from outside. Rows of a Draw and of a batched pass come with what it draws and with its iterations.
    fn step_inputs(&mut self, pass: &Pass, program: Option<&Program>, kind: &StepKind, bindings: &[Binding]) -> Vec<InputId> {
        let mut found = Vec::new();
        let draws = matches!(kind, StepKind::Draw { .. });
        let mut drawn = DrawReads::default();
        let batched = |table: &str| {
            let mut elements = pass.batch.iter().flat_map(|batch| &batch.iterations).filter_map(|iteration| iteration.element.as_ref());
            elements.any(|element| element.table == table)
        };
        for binding in bindings {
            match &binding.target {
                BindingTarget::UniformTable(name) | BindingTarget::StorageTable(name) => {
                    let table = self.input.published.tables.get(name);
                    let reads = self.reads(program, &binding.variable, name);
                    if draws && table.is_some_and(|table| table.per_draw) {
                        drawn.rows.insert(name.clone(), reads);
                    } else if !batched(name) {
                        found.push(Input::Table(name.clone(), reads));
                    }
                }
                BindingTarget::TableRow(table, row) => {
                    let reads = self.reads(program, &binding.variable, table);
                    found.push(Input::Row(table.clone(), *row, reads));
                }
                BindingTarget::SceneTexture(name) => found.push(Input::Texture(name.clone())),
                BindingTarget::MaterialTexture(_) | BindingTarget::MaterialSampler(_) => drawn.textures = true,
                BindingTarget::View(view) => found.extend(self.views.values.get(*view).copied().map(Input::View)),
                BindingTarget::Params { .. } => {
                    let globals = program.into_iter().flat_map(|program| &program.globals);
                    let layout = globals.filter(|(global, _)| global.name == binding.variable).find_map(|(global, _)| match &global.kind {
                        GlobalKind::Uniform { layout } => Some(layout),
                        _ => None,
                    });
                    let live = layout.into_iter().flat_map(|layout| params::live(pass, &self.expanded.params, layout));
                    found.extend(live.map(|name| Input::Param(name.to_owned())));
                }
                _ => {}
            }
        }
        if let PassKind::Draw { objects, view, .. } = &pass.kind {
            found.push(Input::Draws(*objects, *view, drawn));
        }
        self.intern(found)
    }

    /// What a program reads of a table by a variable.
    fn reads(&self, program: Option<&Program>, variable: &str, table: &str) -> RowReads {
        let reads = program.and_then(|program| program.global(variable)).map_or(RowReads::Whole, |global| global.reads.clone());
        let members = self.input.published.tables.get(table).map_or(&[][..], |table| &table.members);
        reads.of_table(members)
    }

    fn intern(&mut self, found: Vec<Input>) -> Vec<InputId> {
        let mut ids: Vec<InputId> = found.into_iter().map(|input| InputId(self.inputs.index(input) as u32)).collect();
        ids.sort_unstable();
        ids.dedup();
        ids
    }

    fn iteration(&mut self, pass: &Pass, program: Option<&Program>, uses: &[Use], iteration: &BatchIteration) -> StepIteration {
        let slots = pass.reads.iter().chain(&pass.writes).chain(&pass.modifies);
        let parts = uses.iter().map(|used| {
            let place = slots.clone().position(|slot| slot.name.value == used.slot);
            let part = place.and_then(|place| iteration.parts.get(place));
            part.map_or((used.mips.clone(), used.layers.clone()), |part| {
                let view = views::whole(&self.expanded.resources[part.resource.index()], part);
                (view.mips, view.layers)
            })
        });
        let parts = parts.collect();
        // A batched pass finds its element's row in the table.
        let row = |element: &Element| Input::Row(element.table.clone(), element.row, self.reads(program, &element.table, &element.table));
        let element = iteration.element.iter().map(row).collect();
        StepIteration { parts, inputs: self.intern(element) }
    }

    fn require(&mut self, feature: Feature, pass: &Pass, why: String) {
        if !self.input.device.features.contains(&feature) {
            let device = self.input.device.name.clone();
            self.problems.push(BindError::MissingFeature {
                pass: pass.name.clone(),
                feature: feature.name(),
                why,
                device,
                span: pass.span,
            });
        } else if !self.requirements.iter().rev().any(|known| known.feature == feature && known.pass == pass.name) {
            self.requirements.push(Requirement { feature, pass: pass.name.clone(), span: pass.span, why });
        }
    }

    fn kind(&mut self, pass: &Pass, program: &Program, taken: &[Taken]) -> Option<(StepKind, Option<ViewRequest>)> {
        let main = program.main(self.shaders);
        match &pass.kind {
            PassKind::Draw { objects, view, cull, .. } => {
                let vertex = program.vertex(self.shaders)?;
                let targets = targets::targets(pass, taken, main, self.expanded, self.formats, self.input.device, self.problems)?;
                let attributes = work::attributes(pass, vertex, self.input.published, self.problems);
                let request = ViewRequest { kind: *view, width: targets.extent[0], height: targets.extent[1] };
                let kind = StepKind::Draw {
                    vertex: vertex.name.clone(),
                    fragment: main.map(|main| main.name.clone()),
                    list: self.draw_lists.index((*objects, *view)),
                    view: self.views.index(request),
                    cull: *cull,
                    attributes,
                    targets,
                };
                Some((kind, Some(request)))
            }
            PassKind::Procedural { vertices, instances, cull, .. } => {
                let vertex = program.vertex(self.shaders)?;
                let targets = targets::targets(pass, taken, main, self.expanded, self.formats, self.input.device, self.problems)?;
                work::check_procedural(pass, vertex, *vertices, self.problems);
                let kind = StepKind::Procedural {
                    vertex: vertex.name.clone(),
                    fragment: main.map(|main| main.name.clone()),
                    vertices: *vertices,
                    instances: *instances,
                    cull: *cull,
                    targets,
                };
                Some((kind, None))
            }
            PassKind::Fullscreen { .. } => {
                let main = main?;
                let targets = targets::targets(pass, taken, Some(main), self.expanded, self.formats, self.input.device, self.problems)?;
                Some((StepKind::Fullscreen { fragment: main.name.clone(), targets }, None))
            }
            PassKind::Compute { work, .. } => {
                let main = main?;
                let groups =
                    work::groups(pass, work, &self.shaders[program.shader], main, self.expanded, self.input.device, self.problems)?;
                Some((StepKind::Compute { entry: main.name.clone(), groups }, None))
            }
            PassKind::Copy | PassKind::Clear { .. } | PassKind::Image(_) | PassKind::Remember => None,
        }
    }

    fn transfer(&mut self, pass: &Pass, taken: &[Taken]) -> Option<StepKind> {
        let view = |slot: &Taken| views::whole(&self.expanded.resources[slot.part.resource.index()], &slot.part);
        match (&pass.kind, taken) {
            (PassKind::Copy, [source, target]) => {
                work::check_copy(pass, source, target, self.expanded, self.formats, self.problems);
                Some(StepKind::Copy { source: view(source), target: view(target) })
            }
            (PassKind::Clear { value }, [target]) => {
                let resource = &self.expanded.resources[target.part.resource.index()];
                let value = value.or(resource.clear).unwrap_or(ClearValue::Zero);
                work::check_clear(pass, target, value, self.formats, self.problems);
                Some(StepKind::Clear { target: view(target), value })
            }
            (PassKind::Image(image), [target]) => Some(StepKind::Image { target: view(target), image: image.clone() }),
            _ => None,
        }
    }

    /// What every variable of the program gets.
    fn bindings(&mut self, pass: &Pass, program: &Program, taken: &[Taken], view: Option<ViewRequest>) -> Vec<Binding> {
        let mut bindings = Vec::new();
        let [width, height] = self.input.output;
        let request = view.unwrap_or(ViewRequest { kind: ViewKind::Camera, width, height });
        for (global, stages) in &program.globals {
            let slot = taken.iter().find(|slot| slot.name == global.name && matches!(slot.taker, Taker::Variable(..)));
            let target = if let Some(slot) = slot {
                views::bind(pass, slot, global, self.expanded, self.formats)
            } else if let (true, GlobalKind::Uniform { layout }) = (global.name == "params", &global.kind) {
                Ok(params::pack(pass, &self.expanded.params, layout, self.problems))
            } else {
                let views = &mut self.views;
                match tables::bind(pass, global, self.input.published, &mut || views.index(request)) {
                    Some(target) => target,
                    None => Err(self.unfed(pass, global, taken)),
                }
            };
            match target {
                Ok(target) => bindings.push(Binding {
                    group: global.group,
                    binding: global.binding,
                    variable: global.name.clone(),
                    stages: *stages,
                    target,
                }),
                Err(problem) => self.problems.push(problem),
            }
        }
        limits::check(pass, &bindings, self.input.device, self.problems);
        bindings
    }

    fn unfed(&self, pass: &Pass, global: &crate::reflect::interface::Global, taken: &[Taken]) -> BindError {
        let published = self.input.published;
        let slots = pass.reads.iter().chain(&pass.writes).chain(&pass.modifies).map(|slot| slot.name.value.clone());
        let free = slots.filter(|slot| !taken.iter().any(|taken| taken.name == *slot));
        let names = published
            .tables
            .keys()
            .chain(&published.textures)
            .chain(&published.material_textures)
            .chain(&published.material_samplers)
            .cloned();
        let builtin = crate::plan::BuiltinSampler::ALL.into_iter().map(|sampler| sampler.name().to_owned());
        BindError::Unfed {
            pass: pass.name.clone(),
            variable: global.name.clone(),
            known: free.chain(names).chain(builtin).chain(["params".to_owned()]).collect(),
            span: global.span,
            pass_span: pass.span,
        }
    }

    /// Parts that a pass produces and may leave texels of: they start from the declared value. Attachments have load operations.
    fn clears(&self, pass: &Pass, taken: &[Taken]) -> Vec<(PartView, ClearValue)> {
        let covered = match &pass.kind {
            PassKind::Compute { work: Work::Cover(part), .. } => match &self.expanded.resources[part.resource.index()].shape {
                Shape::Texture(shape) => Some(views::extent(shape, part.mips.map_or(0, |mips| mips.first))),
                Shape::Buffer { .. } => None,
            },
            _ => None,
        };
        let mut clears = Vec::new();
        for slot in taken {
            if slot.role != Role::Produce || !matches!(slot.taker, Taker::Variable(..)) {
                continue;
            }
            let resource = &self.expanded.resources[slot.part.resource.index()];
            let view = views::whole(resource, &slot.part);
            let full = match &resource.shape {
                Shape::Texture(shape) => covered == Some(views::extent(shape, view.mips.start)),
                Shape::Buffer { .. } => false,
            };
            if !full {
                clears.push((view, resource.clear.unwrap_or(ClearValue::Zero)));
            }
        }
        clears
    }

    fn touch(&self, pass: &Pass, slot: &Taken) -> Use {
        let view = views::whole(&self.expanded.resources[slot.part.resource.index()], &slot.part);
        let access = match &slot.taker {
            Taker::Color { .. } => Access::ColorAttachment,
            Taker::Depth if slot.role == Role::Read => Access::DepthReadOnly,
            Taker::Depth => Access::DepthAttachment,
            Taker::Transfer if slot.name == "read" => Access::CopySource,
            Taker::Transfer if matches!(pass.kind, PassKind::Clear { .. }) => Access::Clear,
            Taker::Transfer => Access::CopyTarget,
            Taker::Indirect => Access::Indirect,
            Taker::Variable(global) => match (&global.kind, slot.role) {
                (GlobalKind::Uniform { .. }, _) => Access::Uniform,
                (GlobalKind::Storage { .. }, Role::Read) => Access::StorageRead,
                (GlobalKind::Storage { .. }, Role::Produce) => Access::StorageWrite,
                (GlobalKind::Storage { .. }, Role::Modify) => Access::StorageReadWrite,
                (GlobalKind::StorageTexture { access, .. }, _) => match access {
                    StorageAccess::Read => Access::StorageRead,
                    StorageAccess::Write => Access::StorageWrite,
                    StorageAccess::ReadWrite => Access::StorageReadWrite,
                },
                _ => Access::Sampled,
            },
        };
        Use {
            resource: slot.part.resource,
            mips: view.mips,
            layers: view.layers,
            role: slot.role,
            access,
            version: slot.part.version,
            slot: slot.name.clone(),
            span: slot.part.span,
        }
    }
}
