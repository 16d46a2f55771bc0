//! Rectangles of mip levels and layers, and how messages and dumps name them.
//!
//! A part is a rectangle: a range of mip levels times a range of layers. Buffers and volumes have one layer.

use std::fmt::Write;
use std::ops::Range;

use crate::expand::types::{Dimension, Indices, PartRef, Resource, Shape, TextureShape};
use crate::plan::PartView;
use crate::reflect::interface::ViewDimension;

/// Mip levels and layers.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct Rect {
    pub(crate) mips: (u32, u32),
    pub(crate) layers: (u32, u32),
}

impl Rect {
    /// The rectangle of two ranges.
    pub(crate) fn new(mips: &Range<u32>, layers: &Range<u32>) -> Rect {
        Rect { mips: (mips.start, mips.end), layers: (layers.start, layers.end) }
    }

    /// All of a resource.
    pub(crate) fn whole(shape: &Shape) -> Rect {
        match shape {
            Shape::Buffer { .. } => Rect { mips: (0, 1), layers: (0, 1) },
            Shape::Texture(texture) => {
                let layers = if texture.dimension == Dimension::D3 { 1 } else { texture.layers.max(1) };
                Rect { mips: (0, texture.mips.max(1)), layers: (0, layers) }
            }
        }
    }

    /// The part that a reference names.
    pub(crate) fn of_reference(part: &PartRef, shape: &Shape) -> Rect {
        let whole = Rect::whole(shape);
        let some = |indices: Option<Indices>, all: (u32, u32)| indices.map_or(all, |some| (some.range().start, some.range().end));
        Rect { mips: some(part.mips, whole.mips), layers: some(part.layers, whole.layers) }
    }

    /// What both have; `None` if they share nothing.
    pub(crate) fn intersection(&self, other: &Rect) -> Option<Rect> {
        let both = |a: (u32, u32), b: (u32, u32)| (a.0.max(b.0), a.1.min(b.1));
        let rect = Rect { mips: both(self.mips, other.mips), layers: both(self.layers, other.layers) };
        (rect.mips.0 < rect.mips.1 && rect.layers.0 < rect.layers.1).then_some(rect)
    }

    /// As a view, as a shader would see all of it.
    pub(crate) fn view(&self, resource: crate::expand::types::ResourceId, shape: &Shape) -> PartView {
        let several = self.layers.1 - self.layers.0 > 1;
        let dimension = match shape {
            Shape::Texture(TextureShape { dimension: Dimension::D1, .. }) => ViewDimension::D1,
            Shape::Texture(TextureShape { dimension: Dimension::D3, .. }) => ViewDimension::D3,
            Shape::Texture(_) if several => ViewDimension::D2Array,
            _ => ViewDimension::D2,
        };
        PartView { resource, mips: self.mips.0..self.mips.1, layers: self.layers.0..self.layers.1, dimension }
    }

    /// The same for a planned resource.
    pub(crate) fn view_in(&self, resource: crate::expand::types::ResourceId, shape: &crate::plan::PlannedShape) -> PartView {
        match shape {
            crate::plan::PlannedShape::Texture(shape, _) => self.view(resource, &Shape::Texture(shape.clone())),
            crate::plan::PlannedShape::Buffer(bytes) => self.view(resource, &Shape::Buffer { bytes: *bytes }),
        }
    }

    /// The name of this part of a resource: `x`, `x.mip(2)`, `x.face(1)`, `x.mips(2..5).layer(0)`.
    pub(crate) fn name(&self, resource: &Resource) -> String {
        let dimension = match &resource.shape {
            Shape::Texture(texture) => Some(texture.dimension),
            Shape::Buffer { .. } => None,
        };
        self.name_in(&resource.name, dimension, &Rect::whole(&resource.shape))
    }

    /// The same where only the pieces are at hand.
    pub(crate) fn name_in(&self, resource: &str, dimension: Option<Dimension>, whole: &Rect) -> String {
        let layer_word = if dimension == Some(Dimension::Cube) && whole.layers.1 == 6 { "face" } else { "layer" };
        let mut name = resource.to_owned();
        for (word, range, all) in [("mip", self.mips, whole.mips), (layer_word, self.layers, whole.layers)] {
            if range == all {
                continue;
            }
            // Writing to a String cannot fail.
            let _ = if range.1.saturating_sub(range.0) == 1 {
                write!(name, ".{word}({})", range.0)
            } else {
                write!(name, ".{word}s({}..{})", range.0, range.1)
            };
        }
        name
    }
}

/// Joins rectangles that lie side by side, so that one clear or one name covers many cells. The input comes from one grid.
pub(crate) fn merged(mut rects: Vec<Rect>) -> Vec<Rect> {
    for along_layers in [true, false] {
        if along_layers {
            rects.sort_unstable_by_key(|rect| (rect.mips, rect.layers));
        } else {
            rects.sort_unstable_by_key(|rect| (rect.layers, rect.mips));
        }
        let mut joined: Vec<Rect> = Vec::with_capacity(rects.len());
        for rect in rects {
            match joined.last_mut() {
                Some(last) if along_layers && last.mips == rect.mips && last.layers.1 == rect.layers.0 => last.layers.1 = rect.layers.1,
                Some(last) if !along_layers && last.layers == rect.layers && last.mips.1 == rect.mips.0 => last.mips.1 = rect.mips.1,
                _ => joined.push(rect),
            }
        }
        rects = joined;
    }
    rects.sort_unstable();
    rects
}

/// The names of several parts of a resource, as a list.
pub(crate) fn names(rects: Vec<Rect>, resource: &Resource) -> String {
    let names: Vec<String> = merged(rects).iter().map(|rect| rect.name(resource)).collect();
    crate::diagnostic::list_names(names.iter().map(String::as_str))
}
