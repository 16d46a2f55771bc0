//! From where a pass draws, with numbers.

use super::passes::Unroller;
use crate::published::{CascadeSplit, CascadeView, Positive, ViewKind};
use crate::validate::types::{CascadeDecl, PlacedExpr, View};

impl Unroller<'_, '_> {
    /// The view of a pass; `None` if a number of it is wrong. That the light or probe exists is for the scene to say.
    pub(super) fn view(&mut self, view: &View, name: &str) -> Option<ViewKind> {
        Some(match view {
            View::Camera => ViewKind::Camera,
            View::DirectionalLight(index) => ViewKind::DirectionalLight(self.small(index, "the light of", name)?),
            View::WholeScene(index) => ViewKind::WholeScene(self.small(index, "the light of", name)?),
            View::SpotLight(index) => ViewKind::SpotLight(self.small(index, "the light of", name)?),
            View::PointLight(index, face) => {
                let (light, face) = self.cube_face(index, "the light of", face, name)?;
                ViewKind::PointLight(light, face)
            }
            View::RectangleLight(index, face) => {
                let (light, face) = self.cube_face(index, "the light of", face, name)?;
                ViewKind::RectangleLight(light, face)
            }
            View::ReflectionProbe(index, face) => {
                let (probe, face) = self.cube_face(index, "the probe of", face, name)?;
                ViewKind::ReflectionProbe(probe, face)
            }
            View::Cascade(cascade) => {
                let CascadeDecl { light, index, count, distance, lambda, snap } = &**cascade;
                let count_of = self.at_least_one(count, "the number of cascades of", name);
                let index_of = self.small(index, "the cascade of", name);
                let light = self.small(light, "the light of", name);
                let distance = self.positive(distance, "the distance of", name, f64::INFINITY);
                let lambda = self.positive(lambda, "the lambda of", name, 1.0);
                let what = format!("the snapping of `{name}`");
                let snap = snap.as_ref().map_or(Some(true), |snap| self.environment.truth(snap, &what));
                let (count, at) = (count_of?, index_of?);
                if at >= count {
                    let reason = format!("there are the cascades 0 to {}, not {at}", count - 1);
                    return self.environment.bad(&format!("the cascade of `{name}`"), reason, index.span);
                }
                let split = CascadeSplit { count, distance: distance?, lambda: lambda?, snap: snap? };
                ViewKind::Cascade(CascadeView { light: light?, index: at, split })
            }
        })
    }

    /// A light or probe, and a face of its cube.
    fn cube_face(&mut self, of: &PlacedExpr, what: &str, face: &PlacedExpr, name: &str) -> Option<(u32, u32)> {
        let (of, index) = (self.small(of, what, name)?, self.small(face, "the face of", name)?);
        if index > 5 {
            let reason = format!("a cube has faces 0 to 5, not {index}");
            return self.environment.bad(&format!("the face of `{name}`"), reason, face.span);
        }
        Some((of, index))
    }

    /// A number from 0 to `most`.
    fn positive(&mut self, expr: &PlacedExpr, what: &str, name: &str, most: f64) -> Option<Positive> {
        let what = format!("{what} `{name}`");
        let value = self.environment.number(expr, &what)?;
        if !(0.0..=most).contains(&value) {
            let least = if most.is_finite() { format!("between 0 and {most}") } else { "at least 0".to_owned() };
            return self.environment.bad(&what, format!("it is {value}, and must be {least}"), expr.span);
        }
        Some(Positive::new(value as f32))
    }
}
