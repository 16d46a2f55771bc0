//! Loops: what they run over, how their iterations run, and what may stand inside.

use super::error::ValidateError;
use super::instances::Declared;
use super::passes::{MAX_LOOP_DEPTH, after, bad, condition, items, located};
use super::scope::Scope;
use super::types::{Each, RepeatDecl, SpreadDecl};
use crate::expand::types::ResourceId;
use crate::syntax::document::{DimensionDoc, EachDoc, Expr, PassDoc, RepeatRunDoc, Text};
use crate::syntax::spanned::Spanned;

/// Checks a loop and its passes.
pub(super) fn repeat(scope: &mut Scope<'_>, name: &Text, pass: &PassDoc) -> Option<RepeatDecl> {
    let PassDoc::Repeat { when, has, each, r#as, batched, run, passes, after, .. } = pass else { return None };
    let condition = condition(scope, when.as_ref(), has.as_ref());
    let each_decl = self::each(scope, name, each);
    let spread = spread(scope, name, run.as_ref());
    let after = self::after(scope, after);
    scope.check_name(r#as);
    if scope.loops.variables.len() >= MAX_LOOP_DEPTH {
        bad(scope, name, format!("loops are nested deeper than {MAX_LOOP_DEPTH} levels"), None, name.span);
        return None;
    }
    if scope.loops.variables.contains(&r#as.value) || scope.is_param(&r#as.value) {
        let reason = format!("`{}` is already the name of a parameter or of an outer loop's index", r#as.value);
        bad(scope, name, reason, Some("choose another name under `as`"), r#as.span);
    }
    if passes.is_empty() {
        bad(scope, name, "this loop repeats no pass".to_owned(), None, name.span);
    }
    if *batched {
        if scope.loops.spread {
            let hint = Some("spread the batched loop itself, or leave `batched` out");
            bad(scope, name, "a batched loop can't stand in a loop that spreads over frames".to_owned(), hint, name.span);
        }
        if let EachDoc::Mip(_, Some(from)) = &each.value {
            let hint = Some("leave the first level out, or `batched`");
            bad(scope, name, "the iterations of a batched loop are counted from 0".to_owned(), hint, from.span);
        }
        scope.loops.batched = Some(r#as.value.clone());
    }
    let outer = scope.loops.spread;
    scope.loops.spread |= run.is_some();
    scope.loops.variables.push(r#as.value.clone());
    let items = items(scope, passes);
    scope.loops.variables.pop();
    scope.loops.spread = outer;
    scope.loops.batched = None;
    Some(RepeatDecl {
        name: located(name),
        condition: condition?,
        each: each_decl?,
        variable: r#as.value.clone(),
        batched: *batched,
        spread: spread?,
        after,
        items,
    })
}

/// `Some(None)` where iterations run like other passes, `None` where what is given is wrong.
fn spread(scope: &mut Scope<'_>, name: &Text, run: Option<&Spanned<RepeatRunDoc>>) -> Option<Option<SpreadDecl>> {
    let Some(run) = run else { return Some(None) };
    if scope.loops.spread {
        scope.report(ValidateError::BadRun {
            pass: name.value.clone(),
            reason: "a loop around it spreads its iterations over frames already".to_owned(),
            hint: "leave one `run` out: an iteration of the outer loop runs as a whole",
            span: run.span,
        });
        return None;
    }
    let RepeatRunDoc::Spread { per_frame, rounds } = &run.value;
    let per_frame = scope.expression(per_frame);
    let rounds = match rounds {
        None => None,
        Some(rounds) => Some(scope.expression(rounds)?),
    };
    Some(Some(SpreadDecl { per_frame: per_frame?, rounds }))
}

fn each(scope: &mut Scope<'_>, name: &Text, each: &Spanned<EachDoc>) -> Option<Each> {
    Some(match &each.value {
        EachDoc::Count(count) => Each::Count(scope.expression(count)?),
        EachDoc::Axis => Each::Axis,
        EachDoc::Face(cube) => {
            let resource = texture(scope, name, cube)?;
            if !matches!(scope.declaration(resource), Some(Declared::Texture(DimensionDoc::Cube, _))) {
                let hint = Some("loop over a count instead");
                bad(scope, name, format!("`{}` has no faces: it is not a cube texture", cube.value), hint, cube.span);
                return None;
            }
            Each::Face
        }
        EachDoc::Layer(of) => Each::Layer(texture(scope, name, of)?),
        EachDoc::Mip(of, from) => {
            let resource = texture(scope, name, of)?;
            Each::Mip(resource, optional(scope, from.as_ref())?)
        }
        EachDoc::Scene(count, most) => {
            let most = optional(scope, most.as_ref())?;
            let Some(collection) = scope.collections.get(&count.value) else {
                let known = scope.collections.keys().cloned().collect();
                scope.report(ValidateError::Unknown { what: "collection", name: count.value.clone(), known, span: count.span });
                return None;
            };
            Each::Scene { count: count.value.clone(), table: collection.table.clone(), element: collection.element.clone(), most }
        }
    })
}

fn optional(scope: &mut Scope<'_>, expr: Option<&Expr>) -> Option<Option<super::types::PlacedExpr>> {
    match expr {
        None => Some(None),
        Some(expr) => scope.expression(expr).map(Some),
    }
}

/// A texture whose parts a loop runs over.
fn texture(scope: &mut Scope<'_>, name: &Text, text: &Text) -> Option<ResourceId> {
    let part = scope.part(text)?;
    let is_part = part.mip.is_some() || part.layer.is_some() || part.version.is_some();
    let is_texture = matches!(scope.declaration(part.resource), Some(Declared::Texture(..)));
    if is_part || !is_texture {
        let reason = format!("`{}` is {}", text.value, if is_part { "a part of a texture" } else { "no texture" });
        bad(scope, name, reason, Some("a loop over faces, layers or mips names a whole texture"), text.span);
        return None;
    }
    Some(part.resource)
}
