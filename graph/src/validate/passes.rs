//! Passes and loops: every name in them resolved.

use super::error::ValidateError;
use super::loops;
use super::resources::plain_clear;
use super::scope::Scope;
use super::types::{CascadeDecl, Condition, Item, PartExpr, PassDecl, PassKindDecl, PlacedExpr, RunDecl, View, WorkDecl};
use crate::expand::types::Located;
use crate::plan::Cull;
use crate::published::DrawFilter;
use crate::source::Span;
use crate::syntax::document::{BlendDoc, CullDoc, DepthDoc, Entries, Expr, IndirectDoc, ObjectsDoc, PassDoc, RunDoc, Text, ViewDoc};
use crate::syntax::spanned::Spanned;

/// Loops inside loops beyond this are refused.
pub(super) const MAX_LOOP_DEPTH: usize = 8;

/// The paths of all passes and loops, in the order of the file.
pub(super) fn paths(passes: &Entries<PassDoc>, outer: &str, depth: usize, found: &mut Vec<String>) {
    for (name, pass) in passes {
        let path = if outer.is_empty() { name.value.clone() } else { format!("{outer}.{}", name.value) };
        if let PassDoc::Repeat { passes, .. } = pass
            && depth < MAX_LOOP_DEPTH
        {
            paths(passes, &path, depth + 1, found);
        }
        found.push(path);
    }
}

/// Checks passes and loops, in the order of the file.
pub(super) fn items(scope: &mut Scope<'_>, passes: &Entries<PassDoc>) -> Vec<Item> {
    passes.iter().filter_map(|(name, pass)| item(scope, name, pass)).collect()
}

fn item(scope: &mut Scope<'_>, name: &Text, pass: &PassDoc) -> Option<Item> {
    scope.check_name(name);
    if scope.loops.batched.is_some() && !matches!(pass, PassDoc::Compute { .. }) {
        let hint = "the iterations of a batched loop run as one dispatch: move the pass out of it, or leave `batched` out";
        bad(scope, name, "a batched loop holds only Compute passes".to_owned(), Some(hint), name.span);
        return None;
    }
    match pass {
        PassDoc::Repeat { .. } => loops::repeat(scope, name, pass).map(|decl| Item::Repeat(Box::new(decl))),
        _ => self::pass(scope, name, pass).map(|pass| Item::Pass(Box::new(pass))),
    }
}

/// The fields that several kinds share.
struct Common<'a> {
    when: Option<&'a Expr>,
    has: Option<&'a Text>,
    shader: Option<&'a Text>,
    constants: Option<&'a Entries<Expr>>,
    read: Vec<(Located<String>, &'a Text)>,
    write: Vec<(Located<String>, &'a Text)>,
    modify: Vec<(Located<String>, &'a Text)>,
    run: &'a Spanned<RunDoc>,
    after: &'a [Text],
}

impl<'a> Common<'a> {
    /// Of a kind with a shader; `parts` are read, written and modified.
    fn of_shader(
        shader: &'a Text,
        constants: &'a Entries<Expr>,
        parts: [&'a Entries<Text>; 3],
        (run, after): (&'a Spanned<RunDoc>, &'a [Text]),
    ) -> Common<'a> {
        let [read, write, modify] = parts.map(slots);
        Common { when: None, has: None, shader: Some(shader), constants: Some(constants), read, write, modify, run, after }
    }
}

/// Every expression is looked at, so that all problems come at once.
fn drawn_from(scope: &mut Scope<'_>, view: &ViewDoc) -> Option<View> {
    match view {
        ViewDoc::Camera => Some(View::Camera),
        ViewDoc::DirectionalLight(index) => scope.expression(index).map(View::DirectionalLight),
        ViewDoc::Cascade { light, index, count, distance, lambda, snap } => {
            let [light, index, count, distance, lambda] = [light, index, count, distance, lambda].map(|expr| scope.expression(expr));
            let snap = snap.as_ref().map(|snap| scope.expression(snap));
            Some(View::Cascade(Box::new(CascadeDecl {
                light: light?,
                index: index?,
                count: count?,
                distance: distance?,
                lambda: lambda?,
                snap: match snap {
                    None => None,
                    Some(snap) => Some(snap?),
                },
            })))
        }
        ViewDoc::PointLight(index, face) => {
            let (index, face) = (scope.expression(index), scope.expression(face));
            Some(View::PointLight(index?, face?))
        }
        ViewDoc::SpotLight(index) => scope.expression(index).map(View::SpotLight),
        ViewDoc::RectangleLight(index, face) => {
            let (index, face) = (scope.expression(index), scope.expression(face));
            Some(View::RectangleLight(index?, face?))
        }
        ViewDoc::WholeScene(index) => scope.expression(index).map(View::WholeScene),
        ViewDoc::ReflectionProbe(index, face) => {
            let (index, face) = (scope.expression(index), scope.expression(face));
            Some(View::ReflectionProbe(index?, face?))
        }
    }
}

fn slots(entries: &Entries<Text>) -> Vec<(Located<String>, &Text)> {
    entries.iter().map(|(name, part)| (located(name), part)).collect()
}

fn pass(scope: &mut Scope<'_>, name: &Text, pass: &PassDoc) -> Option<PassDecl> {
    let (common, kind) = match pass {
        PassDoc::Draw {
            when,
            has,
            shader,
            vertex,
            fragment,
            constants,
            objects,
            view,
            depth,
            cull,
            blend,
            read,
            write,
            modify,
            run,
            after,
            ..
        } => {
            let view = drawn_from(scope, &view.value);
            check_depth(scope, name, depth.as_ref(), [read, write, modify]);
            let kind = view.map(|view| PassKindDecl::Draw {
                vertex: vertex.as_ref().map(located),
                fragment: fragment.as_ref().map(located),
                objects: filter(*objects),
                view,
                depth: depth.as_ref().map(|depth| depth.value),
                cull: culling(*cull),
                blend: blends(scope, name, blend, write, modify),
            });
            (
                Common {
                    when: when.as_ref(),
                    has: has.as_ref(),
                    ..Common::of_shader(shader, constants, [read, write, modify], (run, after))
                },
                kind,
            )
        }
        PassDoc::Procedural {
            when,
            has,
            shader,
            vertex,
            fragment,
            constants,
            vertices,
            instances,
            depth,
            cull,
            blend,
            read,
            write,
            modify,
            run,
            after,
            ..
        } => {
            check_depth(scope, name, depth.as_ref(), [read, write, modify]);
            let instances = match instances {
                None => Some(None),
                Some(instances) => scope.expression(instances).map(Some),
            };
            let kind = match (scope.expression(vertices), instances) {
                (Some(vertices), Some(instances)) => Some(PassKindDecl::Procedural {
                    vertex: vertex.as_ref().map(located),
                    fragment: fragment.as_ref().map(located),
                    vertices,
                    instances,
                    depth: depth.as_ref().map(|depth| depth.value),
                    cull: culling(*cull),
                    blend: blends(scope, name, blend, write, modify),
                }),
                _ => None,
            };
            (
                Common {
                    when: when.as_ref(),
                    has: has.as_ref(),
                    ..Common::of_shader(shader, constants, [read, write, modify], (run, after))
                },
                kind,
            )
        }
        PassDoc::Fullscreen { when, has, shader, entry, constants, blend, read, write, modify, run, after, .. } => {
            let kind = PassKindDecl::Fullscreen { entry: entry.as_ref().map(located), blend: blends(scope, name, blend, write, modify) };
            (
                Common {
                    when: when.as_ref(),
                    has: has.as_ref(),
                    ..Common::of_shader(shader, constants, [read, write, modify], (run, after))
                },
                Some(kind),
            )
        }
        PassDoc::Compute {
            when, has, shader, entry, constants, cover, count, groups, indirect, read, write, modify, run, after, ..
        } => {
            let work = match (cover, count, groups, indirect) {
                (Some(cover), None, None, None) => scope.part(cover).map(WorkDecl::Cover),
                (None, Some(count), None, None) => scope.expression(count).map(WorkDecl::Count),
                (None, None, Some(groups), None) => {
                    let (x, y, z) = &groups.value;
                    match (scope.expression(x), scope.expression(y), scope.expression(z)) {
                        (Some(x), Some(y), Some(z)) => Some(WorkDecl::Groups(x, y, z)),
                        _ => None,
                    }
                }
                (None, None, None, Some(indirect)) => self::indirect(scope, name, indirect, [read, write, modify]),
                _ => {
                    let hint = Some(
                        "`cover` runs once per texel of a part, `count` so many times, `groups` so many workgroups, `indirect` as \
                         many as a buffer says",
                    );
                    bad(scope, name, "a Compute says exactly one of `cover`, `count`, `groups` and `indirect`".to_owned(), hint, name.span);
                    None
                }
            };
            let kind = work.map(|work| PassKindDecl::Compute { entry: entry.as_ref().map(located), work });
            (
                Common {
                    when: when.as_ref(),
                    has: has.as_ref(),
                    ..Common::of_shader(shader, constants, [read, write, modify], (run, after))
                },
                kind,
            )
        }
        PassDoc::Copy { when, has, read, write, run, after, .. } => {
            let slot = |name: &str, text: &Text| Located { value: name.to_owned(), span: text.span };
            (
                Common {
                    when: when.as_ref(),
                    has: has.as_ref(),
                    shader: None,
                    constants: None,
                    read: vec![(slot("read", read), read)],
                    write: vec![(slot("write", write), write)],
                    modify: Vec::new(),
                    run,
                    after,
                },
                Some(PassKindDecl::Copy),
            )
        }
        PassDoc::Clear { when, has, write, value, run, after, .. } => (
            Common {
                when: when.as_ref(),
                has: has.as_ref(),
                shader: None,
                constants: None,
                read: Vec::new(),
                write: vec![(Located { value: "write".to_owned(), span: write.span }, write)],
                modify: Vec::new(),
                run,
                after,
            },
            Some(PassKindDecl::Clear { value: value.as_ref().map(|value| plain_clear(value.value)) }),
        ),
        PassDoc::Repeat { .. } => return None,
    };
    finish(scope, name, common, kind)
}

fn finish(scope: &mut Scope<'_>, name: &Text, common: Common<'_>, kind: Option<PassKindDecl>) -> Option<PassDecl> {
    let condition = condition(scope, common.when, common.has);
    let before = scope.problems.len();
    let mut parts = |slots: Vec<(Located<String>, &Text)>, writes: bool| -> Vec<(Located<String>, PartExpr)> {
        let mut found = Vec::new();
        for (slot, text) in slots {
            let found_part = if writes { scope.part(text) } else { scope.readable(text) };
            let Some(part) = found_part else { continue };
            if writes && let Some(version) = &part.version {
                bad(scope, name, "`@pass` names a value to read, and nothing can be written there".to_owned(), None, version.span);
                continue;
            }
            // What is written is the block's own, whether it stands or not.
            let otherwise = if writes { Vec::new() } else { part.otherwise };
            found.push((slot, PartExpr { otherwise, ..part }));
        }
        found
    };
    let mut reads = parts(common.read, false);
    let writes = parts(common.write, true);
    let modifies = parts(common.modify, true);
    if writes.is_empty() && modifies.is_empty() && scope.problems.len() == before {
        bad(scope, name, "it writes nothing, so that nothing could ever need it".to_owned(), Some("add `write` or `modify`"), name.span);
    }
    check_slots_distinct(scope, name, &[("read", &reads), ("write", &writes), ("modify", &modifies)]);
    if let Some(PassKindDecl::Compute { work: WorkDecl::Indirect(buffer, _), .. }) = &kind {
        reads.push((Located { value: INDIRECT.to_owned(), span: buffer.span }, buffer.clone()));
    }
    let run = run(scope, name, common.run);
    let mut constants = Vec::new();
    for (constant, value) in common.constants.into_iter().flatten() {
        if let Some(value) = scope.expression(value) {
            constants.push((located(constant), value));
        }
    }
    let after = after(scope, common.after);
    Some(PassDecl {
        name: located(name),
        file: scope.instance().loaded.placed.get(&name.span).copied().unwrap_or(name.span.file),
        condition: condition?,
        kind: kind?,
        shader: common.shader.map(located),
        constants,
        reads,
        writes,
        modifies,
        run: run?,
        after,
    })
}

/// The slot of the buffer that says how much work there is.
const INDIRECT: &str = "indirect";

fn indirect(scope: &mut Scope<'_>, name: &Text, doc: &Spanned<IndirectDoc>, slots: [&Entries<Text>; 3]) -> Option<WorkDecl> {
    if let Some((slot, _)) = slots.iter().find_map(|entries| entries.get_key_value(INDIRECT)) {
        let hint = Some("give the variable and its slot another name");
        bad(scope, name, "`indirect` is the slot of the buffer that says how much work there is".to_owned(), hint, slot.span);
    }
    let (buffer, offset) = match &doc.value {
        IndirectDoc::First(buffer) => (buffer, None),
        IndirectDoc::At(buffer, offset) => (buffer, Some(offset)),
    };
    let buffer = scope.part(&Spanned::new(buffer.clone(), doc.span));
    let offset = match offset {
        None => None,
        Some(offset) => Some(scope.expression(&Spanned::new(offset.clone(), doc.span))?),
    };
    Some(WorkDecl::Indirect(buffer?, offset))
}

fn run(scope: &mut Scope<'_>, name: &Text, doc: &Spanned<RunDoc>) -> Option<RunDecl> {
    if scope.loops.spread && doc.value != RunDoc::OnChange {
        scope.report(ValidateError::BadRun {
            pass: name.value.clone(),
            reason: "a loop around it says when its iterations run".to_owned(),
            hint: "leave `run` out here, or move the pass out of the loop",
            span: doc.span,
        });
        return None;
    }
    Some(match &doc.value {
        RunDoc::OnChange => RunDecl::OnChange,
        RunDoc::EveryFrame => RunDecl::EveryFrame,
        RunDoc::Accumulate(count) => RunDecl::Accumulate(scope.expression(count)?),
    })
}

type Group<'a> = (&'static str, &'a [(Located<String>, PartExpr)]);

fn check_slots_distinct(scope: &mut Scope<'_>, name: &Text, groups: &[Group<'_>]) {
    for (index, (list, slots)) in groups.iter().enumerate() {
        for (slot, _) in *slots {
            let elsewhere = groups[..index].iter().find(|(_, others)| others.iter().any(|(other, _)| other.value == slot.value));
            if let Some((other, _)) = elsewhere {
                let reason = format!("the slot `{}` stands under `{other}` and under `{list}`", slot.value);
                bad(scope, name, reason, Some("what keeps its content and is changed belongs under `modify` alone"), slot.span);
            }
        }
    }
}

fn blends(
    scope: &mut Scope<'_>,
    name: &Text,
    blend: &Entries<BlendDoc>,
    write: &Entries<Text>,
    modify: &Entries<Text>,
) -> Vec<(Located<String>, BlendDoc)> {
    for slot in blend.keys() {
        if !write.contains_key(slot) && !modify.contains_key(slot) {
            let known: Vec<String> = write.keys().chain(modify.keys()).map(|key| key.value.clone()).collect();
            scope.report(ValidateError::Unknown { what: "slot", name: slot.value.clone(), known, span: slot.span });
        } else if slot.value == "depth" {
            bad(scope, name, "depth can't be blended".to_owned(), None, slot.span);
        }
    }
    blend.iter().map(|(slot, blend)| (located(slot), *blend)).collect()
}

pub(super) fn condition(scope: &mut Scope<'_>, when: Option<&Expr>, has: Option<&Text>) -> Option<Condition> {
    let when: Option<Option<PlacedExpr>> = match when {
        None => Some(None),
        Some(when) => scope.expression(when).map(Some),
    };
    if let Some(has) = has
        && !scope.counts.contains(&has.value)
    {
        let known = scope.counts.to_vec();
        scope.report(ValidateError::Unknown { what: "scene count", name: has.value.clone(), known, span: has.span });
        return None;
    }
    Some(Condition { when: when?, has: has.map(|has| has.value.clone()) })
}

fn culling(cull: CullDoc) -> Cull {
    match cull {
        CullDoc::None => Cull::None,
        CullDoc::Front => Cull::Front,
        CullDoc::Back => Cull::Back,
    }
}

/// What is tested and written has to be attached, and the other way round.
fn check_depth(scope: &mut Scope<'_>, name: &Text, depth: Option<&Spanned<DepthDoc>>, [read, write, modify]: [&Entries<Text>; 3]) {
    let written = |slot: &str, entries: &Entries<Text>| entries.keys().any(|key| key.value == slot);
    let attached = written("depth", write) || written("depth", modify) || written("depth", read);
    match depth {
        Some(depth) if !attached => {
            let hint = Some("name the depth texture: write: {\"depth\": \"..\"}");
            bad(scope, name, "it tests depth, and has no slot `depth`".to_owned(), hint, depth.span);
        }
        None if attached => {
            let hint = Some("add depth: (test: Less), or whatever the pass needs");
            bad(scope, name, "it has a slot `depth`, and says no depth test".to_owned(), hint, name.span);
        }
        Some(depth) if depth.value.write && written("depth", read) => {
            let hint = Some("add `write: false` to `depth`, or move the slot to `modify`");
            bad(scope, name, "it writes depth, and its slot `depth` is under `read`".to_owned(), hint, depth.span);
        }
        Some(depth) if !depth.value.write && written("depth", write) => {
            let hint = Some("move the slot `depth` to `read`");
            bad(scope, name, "it does not write depth, and its slot `depth` is under `write`".to_owned(), hint, depth.span);
        }
        _ => {}
    }
    if let Some(depth) = depth
        && !depth.value.slope_bias.is_finite()
    {
        bad(scope, name, "its slope bias is not a finite number".to_owned(), None, depth.span);
    }
}

fn filter(objects: ObjectsDoc) -> DrawFilter {
    match objects {
        ObjectsDoc::Opaque => DrawFilter::Opaque,
        ObjectsDoc::Masked => DrawFilter::Masked,
        ObjectsDoc::Solid => DrawFilter::Solid,
        ObjectsDoc::Blended => DrawFilter::Blended,
        ObjectsDoc::All => DrawFilter::All,
    }
}

/// Passes that must come first.
pub(super) fn after(scope: &mut Scope<'_>, paths: &[Text]) -> Vec<Located<String>> {
    paths.iter().filter_map(|path| scope.pass_path(&path.value, path.span)).collect()
}

pub(super) fn located(text: &Text) -> Located<String> {
    Located { value: text.value.clone(), span: text.span }
}

pub(super) fn bad(scope: &mut Scope<'_>, pass: &Text, reason: String, hint: Option<&str>, span: Span) {
    scope.report(ValidateError::BadPass { pass: pass.value.clone(), reason, hint: hint.map(str::to_owned), span });
}
