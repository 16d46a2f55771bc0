//! Limits and features between wgpu's terms and the planner's.
//!
//! Planning happens before a device is opened, from an adapter's numbers alone; a noop device is opened from such numbers.

use luminaire_graph::device::{DeviceFacts, Feature};

/// Every feature that a plan can require, and wgpu's flag for it.
const FEATURES: [(Feature, wgpu::Features); 6] = [
    (Feature::Float32Filterable, wgpu::Features::FLOAT32_FILTERABLE),
    (Feature::Float32Blendable, wgpu::Features::FLOAT32_BLENDABLE),
    (Feature::Rg11b10UfloatRenderable, wgpu::Features::RG11B10UFLOAT_RENDERABLE),
    (Feature::ShaderF16, wgpu::Features::SHADER_F16),
    (Feature::PrimitiveIndex, wgpu::Features::PRIMITIVE_INDEX),
    (Feature::Subgroups, wgpu::Features::SUBGROUP),
];

/// wgpu's flag for a feature.
pub(crate) fn wgpu_feature(feature: Feature) -> wgpu::Features {
    FEATURES.iter().find(|(known, _)| *known == feature).map_or(wgpu::Features::empty(), |(_, flag)| *flag)
}

/// What the planner must know of an adapter. `memory_budget` is in bytes: wgpu cannot ask how much memory there is.
pub fn facts(name: &str, limits: &wgpu::Limits, features: wgpu::Features, memory_budget: u64) -> DeviceFacts {
    DeviceFacts {
        name: name.to_owned(),
        max_texture_1d: limits.max_texture_dimension_1d,
        max_texture_2d: limits.max_texture_dimension_2d,
        max_texture_3d: limits.max_texture_dimension_3d,
        max_layers: limits.max_texture_array_layers,
        max_buffer_bytes: limits.max_buffer_size,
        max_storage_binding_bytes: limits.max_storage_buffer_binding_size,
        max_uniform_binding_bytes: limits.max_uniform_buffer_binding_size,
        max_workgroups: limits.max_compute_workgroups_per_dimension,
        max_workgroup_invocations: limits.max_compute_invocations_per_workgroup,
        max_workgroup_size: [limits.max_compute_workgroup_size_x, limits.max_compute_workgroup_size_y, limits.max_compute_workgroup_size_z],
        max_color_attachments: limits.max_color_attachments,
        max_attachment_bytes: limits.max_color_attachment_bytes_per_sample,
        max_sampled_textures: limits.max_sampled_textures_per_shader_stage,
        max_samplers: limits.max_samplers_per_shader_stage,
        max_storage_textures: limits.max_storage_textures_per_shader_stage,
        max_storage_buffers: limits.max_storage_buffers_per_shader_stage,
        max_uniform_buffers: limits.max_uniform_buffers_per_shader_stage,
        features: FEATURES.iter().filter(|(_, flag)| features.contains(*flag)).map(|(feature, _)| *feature).collect(),
        memory_budget,
    }
}

/// What Mesa 22.3's lavapipe, the software Vulkan driver of Debian 12, offers. For noop devices.
pub fn lavapipe() -> DeviceFacts {
    DeviceFacts {
        name: "lavapipe's limits".to_owned(),
        max_texture_1d: 16384,
        max_texture_2d: 16384,
        max_texture_3d: 4096,
        max_layers: 2048,
        max_buffer_bytes: (2 << 30) - 1,
        max_storage_binding_bytes: 128 << 20,
        max_uniform_binding_bytes: 64 << 10,
        max_workgroups: 65535,
        max_workgroup_invocations: 1024,
        max_workgroup_size: [1024; 3],
        max_color_attachments: 8,
        max_attachment_bytes: 128,
        max_sampled_textures: 37,
        max_samplers: 32,
        max_storage_textures: 36,
        max_storage_buffers: 32,
        max_uniform_buffers: 15,
        features: FEATURES.iter().map(|(feature, _)| *feature).collect(),
        memory_budget: 4 << 30,
    }
}

/// WebGPU's default limits, changed to what the facts say. Used for noop devices.
pub(crate) fn limits_of(facts: &DeviceFacts) -> wgpu::Limits {
    wgpu::Limits {
        max_texture_dimension_1d: facts.max_texture_1d,
        max_texture_dimension_2d: facts.max_texture_2d,
        max_texture_dimension_3d: facts.max_texture_3d,
        max_texture_array_layers: facts.max_layers,
        max_buffer_size: facts.max_buffer_bytes,
        max_storage_buffer_binding_size: facts.max_storage_binding_bytes,
        max_uniform_buffer_binding_size: facts.max_uniform_binding_bytes,
        max_compute_workgroups_per_dimension: facts.max_workgroups,
        max_compute_invocations_per_workgroup: facts.max_workgroup_invocations,
        max_compute_workgroup_size_x: facts.max_workgroup_size[0],
        max_compute_workgroup_size_y: facts.max_workgroup_size[1],
        max_compute_workgroup_size_z: facts.max_workgroup_size[2],
        max_color_attachments: facts.max_color_attachments,
        max_color_attachment_bytes_per_sample: facts.max_attachment_bytes,
        max_sampled_textures_per_shader_stage: facts.max_sampled_textures,
        max_samplers_per_shader_stage: facts.max_samplers,
        max_storage_textures_per_shader_stage: facts.max_storage_textures,
        max_storage_buffers_per_shader_stage: facts.max_storage_buffers,
        max_uniform_buffers_per_shader_stage: facts.max_uniform_buffers,
        max_buffers_and_acceleration_structures_per_shader_stage: facts
            .max_storage_buffers
            .saturating_add(facts.max_uniform_buffers)
            .saturating_add(wgpu::Limits::defaults().max_vertex_buffers),
        ..wgpu::Limits::defaults()
    }
}

/// wgpu's flags for some features.
pub(crate) fn wgpu_features(features: impl IntoIterator<Item = Feature>) -> wgpu::Features {
    features.into_iter().fold(wgpu::Features::empty(), |all, feature| all | wgpu_feature(feature))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn facts_survive_the_way_to_wgpu_and_back() {
        let mut given = DeviceFacts::webgpu_defaults();
        given.features = FEATURES.iter().map(|(feature, _)| *feature).collect();
        given.max_storage_textures = 7;
        let back = facts(&given.name, &limits_of(&given), wgpu_features(given.features.iter().copied()), given.memory_budget);
        assert_eq!(back, given);
    }

    #[test]
    fn the_planner_and_wgpu_agree_on_webgpus_defaults() {
        let ours = DeviceFacts::webgpu_defaults();
        assert_eq!(facts(&ours.name, &wgpu::Limits::defaults(), wgpu::Features::empty(), ours.memory_budget), ours);
    }
}
