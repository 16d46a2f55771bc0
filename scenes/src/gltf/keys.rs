//! Keys of animations, read for the nodes that the scene uses.
//!
//! Guarantees: times never go back, and values are finite and no larger than a transform may be; rotations have unit length,
//! except those of cubic splines, which count as they are. A channel with a value that is no such number is left out, with a
//! warning. Samplers that several channels share are read once, and share their memory.

use std::collections::BTreeMap;
use std::rc::Rc;
use std::sync::Arc;

use glam::Vec4;

use super::accessor::Accessor;
use super::animation::{AnimationSource, ChannelSource, Track};
use super::node::{LARGEST, unit_quaternion};
use super::report::Report;
use super::topology::Budget;
use crate::asset::{Animation, Channel, Interpolation, Property};

/// Keys of an accessor whose times do not go back, and their times.
type Times = (Rc<[usize]>, Arc<[f32]>);
/// The places of input and output, elements for each key, and whether they are rotations.
type Id<'a> = (&'a str, &'a str, usize, bool);

/// What was read so far.
struct Reader<'a, 'r> {
    times: BTreeMap<&'a str, Times>,
    values: BTreeMap<Id<'a>, Option<Arc<[Vec4]>>>,
    budget: &'r mut Budget,
    report: &'r Report,
}

/// The animations, with nodes numbered by `numbers`, from the file's index to the asset's.
pub(super) fn build(
    sources: &[AnimationSource<'_>],
    numbers: &BTreeMap<usize, usize>,
    budget: &mut Budget,
    report: &Report,
) -> Vec<Animation> {
    let mut reader = Reader { times: BTreeMap::new(), values: BTreeMap::new(), budget, report };
    let mut animations = Vec::with_capacity(sources.len());
    for source in sources {
        let channels = source.channels.iter().filter_map(|channel| reader.channel(channel, *numbers.get(&channel.node)?)).collect();
        animations.push(Animation { name: source.name.clone(), duration: source.duration, channels });
    }
    animations
}

impl<'a> Reader<'a, '_> {
    fn channel(&mut self, source: &ChannelSource<'a>, node: usize) -> Option<Channel> {
        let ChannelSource { property, ref track, .. } = *source;
        let (kept, times) = self.times(track)?;
        let values = self.values(track, property, &kept)?;
        Some(Channel { node, property, interpolation: track.interpolation, times, values })
    }

    fn times(&mut self, track: &Track<'a>) -> Option<Times> {
        let input: &'a Accessor<'a> = track.input;
        if let Some(known) = self.times.get(input.place.as_str()) {
            return Some(known.clone());
        }
        self.budget.take_keys(input.count, &track.place, self.report)?;
        let mut last = f32::NEG_INFINITY;
        let mut kept = Vec::with_capacity(input.count);
        let mut times = Vec::with_capacity(input.count);
        for key in 0..input.count {
            let [time] = input.floats(key);
            if time.is_finite() && time >= last {
                last = time;
                kept.push(key);
                times.push(time);
            }
        }
        let times = (Rc::from(kept), Arc::from(times));
        self.times.insert(&input.place, times);
        self.times.get(input.place.as_str()).cloned()
    }

    /// `None` if the channel is left out.
    fn values(&mut self, track: &Track<'a>, property: Property, kept: &[usize]) -> Option<Arc<[Vec4]>> {
        let is_rotation = property == Property::Rotation;
        let id: Id<'a> = (&track.input.place, &track.output.place, track.per_key(), is_rotation);
        if let Some(known) = self.values.get(&id) {
            return known.clone();
        }
        let values = self.read(track, is_rotation, kept).map(Arc::from);
        self.values.insert(id, values.clone());
        values
    }

    fn read(&mut self, track: &Track<'a>, is_rotation: bool, kept: &[usize]) -> Option<Vec<Vec4>> {
        let per_key = track.per_key();
        self.budget.take_keys(kept.len().saturating_mul(per_key), &track.place, self.report)?;
        if kept.is_empty() {
            self.report.warning("gltf::animation-values", &track.place, "has no key at a time that is a number, and is not played", "");
            return None;
        }
        let mut values = Vec::with_capacity(kept.len() * per_key);
        let mut is_short = false;
        for element in kept.iter().flat_map(|key| key * per_key..(key + 1) * per_key) {
            let value: [f32; 4] = track.output.floats(element);
            if !value.iter().all(|component| component.abs() <= LARGEST) {
                let problem = format!("element {element} of its output is {value:?}; its channels are not played");
                self.report.warning("gltf::animation-values", &track.place, problem, "export the animation again");
                return None;
            }
            values.push(match track.interpolation {
                Interpolation::Step | Interpolation::Linear if is_rotation => {
                    let unit = unit_quaternion(value);
                    is_short |= unit.is_none();
                    Vec4::from(unit.unwrap_or_default())
                }
                _ => Vec4::from_array(value),
            });
        }
        if is_short {
            let problem = "a quaternion of length 0 is no rotation, and taken as none";
            self.report.warning("gltf::rotation", &track.place, problem, "");
        }
        Some(values)
    }
}
