//! In which order resources get their extents: each behind those that its size names.

use super::environment::Environment;
use super::error::ExpandError;
use crate::validate::types::{Mips, PartExpr, PlacedExpr, ResourceDecl, ResourceKind, Size, Validated};

/// Indices of all resources, in the order of the file where nothing is against it; `None` where sizes depend on themselves.
pub(super) fn order(environment: &mut Environment<'_>, validated: &Validated) -> Option<Vec<usize>> {
    let decls = &validated.resources;
    let mut ordered = Vec::with_capacity(decls.len());
    let mut done = vec![false; decls.len()];
    for start in 0..decls.len() {
        // Those that wait for others, each for the next.
        let mut waiting = vec![start];
        while let Some(index) = waiting.last().copied() {
            let next = named(&decls[index], &validated.measured).find(|other| done.get(*other) == Some(&false));
            match next {
                _ if done[index] => {}
                None => {
                    done[index] = true;
                    ordered.push(index);
                }
                Some(next) => {
                    if let Some(first) = waiting.iter().position(|other| *other == next) {
                        let names = waiting[first..].iter().chain([&next]).map(|index| format!("`{}`", decls[*index].name.value));
                        let chain = names.collect();
                        let name = &decls[next].name;
                        environment.report(ExpandError::CircularExtent { name: name.value.clone(), chain, span: name.span });
                        return None;
                    }
                    waiting.push(next);
                    continue;
                }
            }
            waiting.pop();
        }
    }
    Some(ordered)
}

/// The resources that the size of one names.
pub(super) fn named(decl: &ResourceDecl, measured: &[PartExpr]) -> impl Iterator<Item = usize> {
    let mut names = Vec::new();
    for expr in expressions(&decl.kind) {
        expr.expression.names(&mut names);
    }
    let mut found = Vec::new();
    for (name, _) in &names {
        let index = name.strip_prefix('$').and_then(|name| name.split_once('.')?.0.parse::<usize>().ok());
        index.and_then(|index| measured.get(index)).into_iter().for_each(|part| resources(part, &mut found));
    }
    found.into_iter()
}

/// A part's resource, and those that may take its place.
fn resources(part: &PartExpr, found: &mut Vec<usize>) {
    found.push(part.resource.index());
    part.otherwise.iter().for_each(|otherwise| resources(&otherwise.part, found));
}

fn expressions(kind: &ResourceKind) -> Vec<&PlacedExpr> {
    match kind {
        ResourceKind::Buffer { size } => vec![size],
        ResourceKind::Texture { size, layers, mips, samples, .. } => {
            let mut found = match size {
                Size::Output => Vec::new(),
                Size::Scaled(one) | Size::Line(one) | Size::Square(one) | Size::Cube(one) => vec![one],
                Size::Exact(x, y) => vec![x, y],
                Size::Volume(x, y, z) => vec![x, y, z],
            };
            found.extend(layers.iter().chain(samples));
            if let Some(Mips::Count(count)) = mips {
                found.push(count);
            }
            found
        }
    }
}
