//! Changes by name, for command lines, timelines and tests.

use bevy_ecs::prelude::{Entity, World};
use glam::Vec3;
use luminaire_graph::diagnostic::{Diagnostic, did_you_mean};

use super::{Name, RestPose, Transform};

/// The one entity of a name. Errors: no entity has it, or several have.
pub fn find_by_name(world: &mut World, name: &str) -> Result<Entity, Diagnostic> {
    let mut query = world.query::<(Entity, &Name)>();
    let mut found = query.iter(world).filter(|(_, known)| known.as_str() == name).map(|(entity, _)| entity);
    match (found.next(), found.next()) {
        (Some(entity), None) => Ok(entity),
        (Some(_), Some(_)) => {
            Err(Diagnostic::error("world::ambiguous-node", format!("several nodes are named `{name}`"))
                .hint("give the node a name of its own"))
        }
        (None, _) => {
            let mut known: Vec<&str> = query.iter(world).map(|(_, known)| known.as_str()).collect();
            known.sort_unstable();
            Err(Diagnostic::error("world::unknown-node", format!("the scene has no node `{name}`")).maybe_hint(did_you_mean(name, known)))
        }
    }
}

/// Moves the node of that name to `translation`, in its parent's space, metres; rotation and scale stay. An animation that moves it
/// overrides this as soon as the time is set.
/// Errors: see [`find_by_name`]; a translation that is not finite.
pub fn set_translation(world: &mut World, name: &str, translation: Vec3) -> Result<(), Diagnostic> {
    if !translation.is_finite() {
        return Err(Diagnostic::error("world::bad-translation", format!("the translation of `{name}` is not finite: {translation}")));
    }
    let entity = find_by_name(world, name)?;
    match world.get_mut::<Transform>(entity) {
        Some(mut transform) => transform.0.translation = translation.into(),
        None => return Err(Diagnostic::error("world::no-place", format!("`{name}` has no place in the scene"))),
    }
    if let Some(mut rest) = world.get_mut::<RestPose>(entity) {
        rest.0.translation = translation;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use glam::Affine3A;

    use super::*;
    use crate::world::new_world;

    #[test]
    fn moves_the_named_node_and_hints_at_near_names() {
        let mut world = new_world();
        let entity = world.spawn((Name::new("moving_box"), Transform(Affine3A::from_scale(Vec3::splat(2.0))))).id();
        set_translation(&mut world, "moving_box", Vec3::new(-1.6, 0.6, -1.4)).unwrap();
        let moved = world.get::<Transform>(entity).unwrap().0;
        assert_eq!(moved, Affine3A { translation: Vec3::new(-1.6, 0.6, -1.4).into(), ..Affine3A::from_scale(Vec3::splat(2.0)) });
        let error = set_translation(&mut world, "moving_bax", Vec3::ZERO).unwrap_err();
        assert_eq!((error.code, error.hint.as_deref()), ("world::unknown-node", Some("did you mean `moving_box`?")));
        assert_eq!(set_translation(&mut world, "moving_box", Vec3::NAN).unwrap_err().code, "world::bad-translation");
        world.spawn(Name::new("moving_box"));
        assert_eq!(set_translation(&mut world, "moving_box", Vec3::ZERO).unwrap_err().code, "world::ambiguous-node");
    }
}
