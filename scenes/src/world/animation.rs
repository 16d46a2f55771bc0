//! Animations of glTF files, played.
//!
//! A player stands on the entity that an asset was spawned below, or on one of its own. Until [`super::set_time`] is called for
//! the first time everything stands as the file has it at rest; from then on the first animation plays, again and again, as
//! viewers do.
//!
//! Guarantees: where a node stands depends on the time, the player and the [`RestPose`] alone, not on what was shown before; a
//! [`Transform`] is written only if it differs. Accepted downside: a node that any of the asset's animations moves goes back to
//! its rest pose when none of them is played.

use std::sync::Arc;

use bevy_ecs::prelude::{Component, Entity, World};
use glam::Affine3A;
use luminaire_graph::diagnostic::{Diagnostic, did_you_mean, list_names};

use super::transform::place;
use super::{Repeat, sample};
use crate::asset::{Animation, Pose};

/// Where an entity stands that animations move, for as long as they leave it alone. Changes by name change it, too.
#[derive(Component, Debug, Clone, Copy, PartialEq, Default)]
pub struct RestPose(pub Pose);

/// Plays animations of one spawned asset.
#[derive(Component, Debug, Clone)]
pub struct AnimationPlayer {
    /// Indices into [`AnimationPlayer::clips`]: these play, all at once, each for its own duration. Where two move the same, the
    /// later one in this list counts. Others stand still.
    pub playing: Vec<usize>,
    /// Seconds of a clip in a second; negative plays backwards, from the end.
    pub speed: f64,
    /// The time at which clips begin, seconds. Before it they stand at their beginning.
    pub start: f64,
    /// What comes after the end.
    pub repeat: Repeat,
    clips: Arc<[Animation]>,
    /// Each node that any clip moves, in order, and its entity.
    driven: Vec<(usize, Entity)>,
}

/// A clip that can be played.
#[derive(Debug, Clone, PartialEq)]
pub struct Clip {
    /// Who plays it.
    pub player: Entity,
    /// Index into [`AnimationPlayer::clips`].
    pub index: usize,
    /// Of the file; not always unique.
    pub name: String,
    /// Seconds.
    pub duration: f32,
}

impl AnimationPlayer {
    /// A player of the first clip, in a loop from time 0. `driven` are the nodes that clips move, in order, and their entities.
    pub(super) fn new(clips: Arc<[Animation]>, driven: Vec<(usize, Entity)>) -> AnimationPlayer {
        AnimationPlayer { playing: vec![0], speed: 1.0, start: 0.0, repeat: Repeat::Loop, clips, driven }
    }

    /// The animations of the asset, in the order of the file.
    pub fn clips(&self) -> &[Animation] {
        &self.clips
    }
}

/// The nodes that animations move, in order.
pub(super) fn driven_nodes(animations: &[Animation]) -> Vec<usize> {
    let mut nodes: Vec<usize> = animations.iter().flat_map(|animation| &animation.channels).map(|channel| channel.node).collect();
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}

/// Every clip of the world, by player in the order in which they were spawned.
pub fn clips(world: &mut World) -> Vec<Clip> {
    let mut query = world.query::<(Entity, &AnimationPlayer)>();
    let mut players: Vec<(Entity, &AnimationPlayer)> = query.iter(world).collect();
    players.sort_unstable_by_key(|(entity, _)| entity.index_u32());
    let clips_of = |(entity, player): (Entity, &AnimationPlayer)| {
        let clip =
            move |(index, clip): (usize, &Animation)| Clip { player: entity, index, name: clip.name.clone(), duration: clip.duration };
        player.clips.iter().enumerate().map(clip).collect::<Vec<_>>()
    };
    players.into_iter().flat_map(clips_of).collect()
}

/// Plays the clips of these names instead of what plays now, on every player that has one of them. A number is taken as an index
/// from 0 where no clip has it as its name. Nothing changes if there is an error.
/// Errors: `world::unknown-clip`, for each that no player has.
pub fn play_clips(world: &mut World, names: &[&str]) -> Result<(), Vec<Diagnostic>> {
    let all = clips(world);
    let mut chosen: Vec<(Entity, usize)> = Vec::new();
    let mut problems = Vec::new();
    for name in names {
        let mut found: Vec<&Clip> = all.iter().filter(|clip| clip.name == *name).collect();
        if found.is_empty() {
            let index = name.parse::<usize>().ok();
            found = all.iter().filter(|clip| Some(clip.index) == index).collect();
        }
        if found.is_empty() {
            let known: Vec<&str> = all.iter().map(|clip| clip.name.as_str()).collect();
            problems.push(
                Diagnostic::error("world::unknown-clip", format!("the scene has no animation `{name}`"))
                    .note(format!("its animations: {}", list_names(known.iter().copied())))
                    .maybe_hint(did_you_mean(name, known)),
            );
        }
        chosen.extend(found.into_iter().map(|clip| (clip.player, clip.index)));
    }
    if !problems.is_empty() {
        return Err(problems);
    }
    let mut query = world.query::<(Entity, &mut AnimationPlayer)>();
    for (entity, mut player) in query.iter_mut(world) {
        let playing: Vec<usize> = chosen.iter().filter(|(player, _)| *player == entity).map(|(_, index)| *index).collect();
        if !playing.is_empty() {
            player.playing = playing;
        }
    }
    Ok(())
}

/// Places everything that animations move.
pub(super) fn animate(world: &mut World, time: f64) {
    let mut moved: Vec<(Entity, Affine3A)> = Vec::new();
    let mut players = world.query::<&AnimationPlayer>();
    for player in players.iter(world) {
        let rest = |(_, entity): &(usize, Entity)| world.get::<RestPose>(*entity).map(|rest| rest.0);
        let mut poses: Vec<Option<Pose>> = player.driven.iter().map(rest).collect();
        for clip in player.playing.iter().filter_map(|index| player.clips.get(*index)) {
            let at = player.repeat.phase(time - player.start, player.speed, f64::from(clip.duration));
            for channel in &clip.channels {
                let known = player.driven.binary_search_by_key(&channel.node, |(node, _)| *node);
                if let Some(Some(pose)) = known.ok().and_then(|index| poses.get_mut(index)) {
                    sample::apply(channel, at, pose);
                }
            }
        }
        moved.extend(player.driven.iter().zip(poses).filter_map(|((_, entity), pose)| Some((*entity, pose?.matrix()))));
    }
    for (entity, local) in moved {
        place(world, entity, local);
    }
}
