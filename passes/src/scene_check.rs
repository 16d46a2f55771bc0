//! Checks of a published scene against the plan, the schema and the device, before anything of it is uploaded.
//!
//! After these checks every index of a draw list, a material and a texture level is in range.

use luminaire_graph::diagnostic::{Diagnostic, did_you_mean};
use luminaire_graph::plan::Plan;
use luminaire_graph::published::{DrawBatch, PublishedGeometry, PublishedScene, PublishedSchema, PublishedTexture, TableKind};

use crate::scene_data::Needs;

/// Everything wrong with the scene, as far as the plan uses it.
pub(crate) fn check(
    plan: &Plan,
    schema: &PublishedSchema,
    needs: &Needs,
    scene: &PublishedScene,
    limits: &wgpu::Limits,
) -> Vec<Diagnostic> {
    let mut problems = Vec::new();
    check_tables(needs, scene, limits, &mut problems);
    check_views(plan, schema, needs, scene, &mut problems);
    if needs.geometry {
        check_geometry(schema, &scene.geometry, limits, &mut problems);
        check_draw_lists(plan, needs, scene, &mut problems);
    }
    for name in &needs.textures {
        problems.extend(match scene.textures.get(name) {
            Some(texture) => check_texture(texture, limits),
            None => Some(Diagnostic::error("execute::missing-texture", format!("the scene does not publish the texture `{name}`"))),
        });
    }
    if needs.materials {
        check_materials(schema, scene, &mut problems);
        problems.extend(scene.materials.textures.iter().filter_map(|texture| check_texture(texture, limits)));
    }
    problems
}

fn check_tables(needs: &Needs, scene: &PublishedScene, limits: &wgpu::Limits, problems: &mut Vec<Diagnostic>) {
    for (name, kind) in &needs.tables {
        let Some(bytes) = scene.tables.get(name) else {
            problems.push(
                Diagnostic::error("execute::missing-table", format!("the scene does not publish the table `{name}`"))
                    .maybe_hint(did_you_mean(name, scene.tables.keys().map(String::as_str))),
            );
            continue;
        };
        let binding = match kind {
            TableKind::Storage => limits.max_storage_buffer_binding_size,
            TableKind::Uniform | TableKind::View => limits.max_uniform_buffer_binding_size,
        };
        too_large(&format!("the published table `{name}`"), bytes.len() as u64, binding.min(limits.max_buffer_size), problems);
    }
}

fn check_views(plan: &Plan, schema: &PublishedSchema, needs: &Needs, scene: &PublishedScene, problems: &mut Vec<Diagnostic>) {
    if needs.views && scene.views.len() < plan.views.len() {
        let message = format!("the scene publishes {} of the {} views that the plan asks for", scene.views.len(), plan.views.len());
        problems.push(Diagnostic::error("execute::missing-view", message));
    }
    let stride = schema.tables.values().find(|table| table.kind == TableKind::View).map_or(0, |table| table.stride);
    if needs.views && scene.views.iter().any(|view| view.len() > stride.next_multiple_of(16) as usize) {
        problems.push(Diagnostic::error("execute::view-size", format!("a published view has more than {stride} bytes")));
    }
}

fn check_geometry(schema: &PublishedSchema, geometry: &PublishedGeometry, limits: &wgpu::Limits, problems: &mut Vec<Diagnostic>) {
    let before = problems.len();
    too_large("the scene's vertex buffer", geometry.vertices.len() as u64, limits.max_buffer_size, problems);
    too_large("the scene's index buffer", geometry.indices.len() as u64 * 4, limits.max_buffer_size, problems);
    if problems.len() > before
        && let Some(last) = problems.last_mut()
    {
        last.hint = Some("use a scene with fewer triangles".to_owned());
    }
    let stride = u64::from(schema.vertex.stride);
    if stride == 0 || !(geometry.vertices.len() as u64).is_multiple_of(stride) {
        let message = format!("the scene's vertex buffer has {} bytes, no multiple of a vertex ({stride})", geometry.vertices.len());
        problems.push(Diagnostic::error("execute::vertex-buffer", message));
    }
}

fn check_draw_lists(plan: &Plan, needs: &Needs, scene: &PublishedScene, problems: &mut Vec<Diagnostic>) {
    for (filter, view) in &plan.draw_lists {
        let Some(batches) = scene.draw_list(*filter, *view) else {
            let message = format!("the scene does not publish the draw list {filter:?} from {view:?}");
            problems.push(Diagnostic::error("execute::missing-draw-list", message));
            continue;
        };
        if let Some(wrong) = batches.iter().position(|batch| !batch_is_sound(batch, needs, scene)) {
            let message = format!("batch {wrong} of the draw list {filter:?} from {view:?} is out of range");
            problems.push(Diagnostic::error("execute::draw-list", message));
        }
    }
}

fn batch_is_sound(batch: &DrawBatch, needs: &Needs, scene: &PublishedScene) -> bool {
    let indices = batch.first_index.checked_add(batch.index_count).is_some_and(|end| end as usize <= scene.geometry.indices.len());
    let instances = batch.first_instance.checked_add(batch.instance_count).is_some();
    indices && instances && (!needs.materials || batch.material < scene.materials.bindings.len())
}

fn check_materials(schema: &PublishedSchema, scene: &PublishedScene, problems: &mut Vec<Diagnostic>) {
    for (index, material) in scene.materials.bindings.iter().enumerate() {
        let textures = material.textures.len() == schema.material_textures.len()
            && material.textures.iter().all(|texture| *texture < scene.materials.textures.len());
        let samplers = material.samplers.len() == schema.material_samplers.len()
            && material.samplers.iter().all(|sampler| *sampler < scene.materials.samplers.len());
        if !textures || !samplers {
            let message = format!("material {index} of the scene names textures or samplers that are not there");
            problems.push(Diagnostic::error("execute::material", message));
        }
    }
}

fn check_texture(texture: &PublishedTexture, limits: &wgpu::Limits) -> Option<Diagnostic> {
    let name = &texture.name;
    let (width, height) = (texture.width, texture.height);
    let limit = limits.max_texture_dimension_2d;
    if width == 0 || height == 0 || width.max(height) > limit {
        let message = format!("the texture `{name}` is {width}x{height} texels; this device takes 1 to {limit}");
        return Some(Diagnostic::error("execute::texture-size", message));
    }
    let levels = width.max(height).ilog2() + 1;
    if texture.mips.is_empty() || texture.mips.len() > levels as usize {
        let message = format!("the texture `{name}` has {} levels; {width}x{height} texels take 1 to {levels}", texture.mips.len());
        return Some(Diagnostic::error("execute::texture-levels", message));
    }
    let bytes = |level: usize| u64::from((width >> level).max(1)) * u64::from((height >> level).max(1)) * u64::from(texture.texels.bytes());
    let wrong = texture.mips.iter().enumerate().find(|(level, content)| content.len() as u64 != bytes(*level))?;
    let message = format!("level {} of the texture `{name}` has {} bytes instead of {}", wrong.0, wrong.1.len(), bytes(wrong.0));
    Some(Diagnostic::error("execute::texture-levels", message))
}

fn too_large(what: &str, bytes: u64, limit: u64, problems: &mut Vec<Diagnostic>) {
    if bytes > limit {
        let message = format!("{what} has {bytes} bytes; this device takes {limit}");
        problems.push(Diagnostic::error("execute::too-large", message));
    }
}

#[cfg(test)]
mod tests {
    use luminaire_graph::published::PublishedTexels;

    use super::*;

    fn texture(width: u32, mips: &[usize]) -> PublishedTexture {
        let mips = mips.iter().map(|bytes| vec![0; *bytes].into()).collect();
        PublishedTexture { name: "brick".to_owned(), texels: PublishedTexels::Unorm8, width, height: 2, mips }
    }

    #[test]
    fn texture_levels_must_be_complete() {
        let limits = wgpu::Limits::defaults();
        assert_eq!(check_texture(&texture(4, &[32, 8, 4]), &limits), None);
        assert!(check_texture(&texture(4, &[32, 7]), &limits).is_some_and(|problem| problem.message.contains("`brick`")));
        assert!(check_texture(&texture(4, &[]), &limits).is_some());
        assert!(check_texture(&texture(4, &[32, 8, 4, 4]), &limits).is_some());
        assert!(check_texture(&texture(0, &[0]), &limits).is_some_and(|problem| problem.code == "execute::texture-size"));
    }

    #[test]
    fn batches_must_stay_in_the_index_buffer() {
        let geometry = PublishedGeometry { indices: vec![0, 1, 2], ..PublishedGeometry::default() };
        let scene = PublishedScene { geometry: geometry.into(), ..PublishedScene::default() };
        let batch = DrawBatch {
            material: 9,
            first_index: 0,
            index_count: 3,
            base_vertex: 0,
            first_instance: 0,
            instance_count: 1,
            mirrored: false,
            double_sided: false,
        };
        assert!(batch_is_sound(&batch, &Needs::default(), &scene));
        assert!(!batch_is_sound(&DrawBatch { first_index: 1, ..batch }, &Needs::default(), &scene));
        assert!(!batch_is_sound(&DrawBatch { first_index: u32::MAX, ..batch }, &Needs::default(), &scene));
        let needs = Needs { materials: true, ..Needs::default() };
        assert!(!batch_is_sound(&batch, &needs, &scene));
    }
}
