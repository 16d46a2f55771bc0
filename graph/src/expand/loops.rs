//! Loops: unrolled, or batched to one pass per pass of theirs.

use super::passes::{MAX_PASSES, Unroller};
use super::types::{Batch, BatchIteration, Element, PartRef, ResourceId, Run, Shape, Slot, Spread};
use crate::validate::types::{Each, Item, PassDecl, PassKindDecl, RepeatDecl, WorkDecl};

impl Unroller<'_, '_> {
    /// Makes the passes of a loop.
    pub(super) fn repeat(&mut self, decl: &RepeatDecl, scope: &str) {
        let name = decl.name.value.as_str();
        if !self.environment.stands(&decl.condition, name) {
            return;
        }
        let Some((first, end)) = self.range(decl) else { return };
        // Enough to find that it is too long.
        let indices = (first..end.min(first.saturating_add(MAX_PASSES as u64 + 1))).map(|index| index as u32);
        let Some(spread) = self.spread(decl, scope) else { return };
        let outer = self.after.len();
        self.wait_for(&decl.after, scope);
        if decl.batched {
            self.iteration = spread.map(|spread| Run::Spread { spread, iteration: 0 }).or(self.iteration);
            for item in &decl.items {
                if let Item::Pass(pass) = item {
                    self.batch(decl, pass, indices.clone(), scope);
                }
            }
        } else {
            for index in indices {
                self.iteration = spread.map(|spread| Run::Spread { spread, iteration: index }).or(self.iteration);
                let element = element(&decl.each, index);
                let depth = self.elements.len();
                self.elements.extend(element);
                self.environment.indices.push((decl.variable.clone(), index));
                self.items(&decl.items, &format!("{scope}{name}[{index}]."));
                self.environment.indices.pop();
                self.elements.truncate(depth);
                if !self.grow(0, &decl.name) {
                    break;
                }
            }
        }
        if spread.is_some() {
            self.iteration = None;
        }
        self.after.truncate(outer);
    }

    /// The first index and one past the last.
    fn range(&mut self, decl: &RepeatDecl) -> Option<(u64, u64)> {
        let what = format!("the count of `{}`", decl.name.value);
        let texture = |resource: ResourceId| match &self.resources[resource.index()].shape {
            Shape::Texture(shape) => (shape.layers, shape.mips),
            Shape::Buffer { .. } => (1, 1),
        };
        Some(match &decl.each {
            Each::Face => (0, 6),
            Each::Axis => (0, 3),
            Each::Count(count) => (0, self.environment.count(count, &what)?),
            Each::Layer(of) => (0, u64::from(texture(*of).0)),
            Each::Mip(of, from) => {
                let mips = u64::from(texture(*of).1);
                let from = match from {
                    None => 0,
                    Some(from) => self.environment.count(from, &format!("the first mip of `{}`", decl.name.value))?,
                };
                (from.min(mips), mips)
            }
            Each::Scene { count, most, .. } => {
                let there = u64::from(self.environment.counts.get(count).copied().unwrap_or(0));
                let most = match most {
                    None => there,
                    Some(most) => self.environment.count(most, &what)?,
                };
                (0, there.min(most))
            }
        })
    }

    /// `Some(None)` where iterations run like other passes, `None` where a number is wrong.
    fn spread(&mut self, decl: &RepeatDecl, scope: &str) -> Option<Option<u32>> {
        let Some(spread) = &decl.spread else { return Some(None) };
        let name = format!("{scope}{}", decl.name.value);
        let per_frame = self.at_least_one(&spread.per_frame, "the iterations a frame of", &name);
        let rounds = match &spread.rounds {
            None => Some(1),
            Some(rounds) => self.at_least_one(rounds, "the rounds of", &name),
        };
        self.spreads.push(Spread { name, span: decl.name.span, per_frame: per_frame?, rounds: rounds? });
        Some(Some(self.spreads.len() as u32 - 1))
    }

    /// One pass for all iterations of a pass of a batched loop.
    fn batch(&mut self, decl: &RepeatDecl, pass: &PassDecl, indices: impl Iterator<Item = u32> + Clone, scope: &str) {
        let scope = format!("{scope}{}.", decl.name.value);
        let name = format!("{scope}{}", pass.name.value);
        if !self.environment.stands(&pass.condition, &name) || !self.grow(indices.clone().count(), &decl.name) {
            return;
        }
        let mut iterations = Vec::new();
        let mut joined: Option<[Vec<Slot>; 3]> = None;
        let mut cover: Option<PartRef> = None;
        for index in indices {
            self.environment.indices.push((decl.variable.clone(), index));
            let slots = self.slots(pass, &format!("{name}[{index}]"));
            let covered = match &pass.kind {
                PassKindDecl::Compute { work: WorkDecl::Cover(part), .. } => self.part(part, &name),
                _ => None,
            };
            self.environment.indices.pop();
            let parts: Vec<PartRef> = slots.iter().flatten().map(|slot| slot.part).collect();
            if let (Some(first), Some(part)) = (cover, covered)
                && first.mips != part.mips
            {
                let reason = "iterations cover mips of different sizes, and one number of workgroups is for all".to_owned();
                self.environment.bad::<()>(&format!("the work of `{name}`"), reason, part.span);
                return;
            }
            cover = cover.or(covered);
            match &mut joined {
                None => joined = Some(slots),
                Some(joined) => join(joined.iter_mut().flatten(), &parts),
            }
            iterations.push(BatchIteration { parts, element: element(&decl.each, index) });
        }
        let Some(slots) = joined else { return };
        // Parts of the work may name the index, which is that of the first iteration here.
        self.environment.indices.push((decl.variable.clone(), 0));
        let made = self.finish(pass, name, &scope, slots);
        if let Some(made) = made {
            made.indices.pop();
            made.batch = Some(Batch { variable: decl.variable.clone(), iterations });
        }
        self.environment.indices.pop();
    }
}

/// Widens each slot's part until it holds that of another iteration, too.
fn join<'a>(slots: impl Iterator<Item = &'a mut Slot>, parts: &[PartRef]) {
    for (slot, part) in slots.zip(parts) {
        slot.part.mips = slot.part.mips.zip(part.mips).map(|(a, b)| a.join(b));
        slot.part.layers = slot.part.layers.zip(part.layers).map(|(a, b)| a.join(b));
    }
}

fn element(each: &Each, row: u32) -> Option<Element> {
    match each {
        Each::Scene { table, element, .. } => Some(Element { variable: element.clone(), table: table.clone(), row }),
        _ => None,
    }
}
