//! The output of binding: each pass as a step, with every part that it touches.

use crate::expand::types::{Expanded, ResourceId};
use crate::format::Format;
use crate::plan::{Input, Requirement, Step, Usage};
use crate::published::{DrawFilter, ViewKind, ViewRequest};
use crate::reflect::interface::Shader;

/// A pipeline whose passes are complete, in no order yet.
#[derive(Debug, Clone)]
pub struct Bound {
    /// Resources, outputs and parameters.
    pub expanded: Expanded,
    /// Shaders that steps name by index.
    pub shaders: Vec<Shader>,
    /// By pass id, in the order of the file.
    pub steps: Vec<Step>,
    /// By resource id: the chosen format of textures.
    pub formats: Vec<Option<Format>>,
    /// Views that the steps name by index.
    pub views: Vec<ViewRequest>,
    /// Draw lists that the steps name by index.
    pub draw_lists: Vec<(DrawFilter, ViewKind)>,
    /// Outside inputs that the steps name by index.
    pub inputs: Vec<Input>,
    /// Features that steps need, in the order of the steps.
    pub requirements: Vec<Requirement>,
}

impl Bound {
    /// The part of `usage` that a step adds to a resource.
    pub fn usage_of(step: &Step, resource: ResourceId) -> Usage {
        let mut usage = Usage::default();
        for touched in step.uses.iter().filter(|touched| touched.resource == resource) {
            usage = usage.union(touched.access.usage());
        }
        usage
    }
}
