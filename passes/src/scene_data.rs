//! The published scene on the device: tables, views, geometry, material textures and samplers.
//!
//! Only what the plan names is uploaded. A new scene is compared with the one that stands, page by page: equal bytes are left alone,
//! other bytes of equal length are written in place, and only a new length (or a new texture) makes new objects.
//!
//! Accepted downside: a table that changes its length often makes bind groups anew often; scenes should pad such tables.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::plan::{BindingTarget, Plan, StepKind};
use luminaire_graph::published::{
    PublishedMaterials, PublishedSampler, PublishedScene, PublishedSchema, PublishedTexels, PublishedTexture, Table, TableKind,
};

use crate::device::Gpu;
use crate::errors::{Subject, catch};
use crate::samplers;
use crate::scene_check;

/// Uploads wait in host memory until they are submitted; this many bytes are let to wait.
const UPLOAD_BATCH: usize = 64 << 20;

/// Which parts of a scene a plan uses.
#[derive(Debug, Clone, Default)]
pub(crate) struct Needs {
    /// Tables by name, and how they bind.
    pub(crate) tables: BTreeMap<String, TableKind>,
    /// Rows that are bound by themselves.
    pub(crate) rows: BTreeSet<(String, u32)>,
    /// Textures of the scene by name.
    pub(crate) textures: BTreeSet<String>,
    /// Some step binds a view.
    pub(crate) views: bool,
    /// Some step draws.
    pub(crate) geometry: bool,
    /// Some step binds what materials bring.
    pub(crate) materials: bool,
}

impl Needs {
    pub(crate) fn of(plan: &Plan) -> Needs {
        let mut needs = Needs::default();
        for step in &plan.steps {
            needs.geometry |= matches!(step.kind, StepKind::Draw { .. });
            for binding in &step.bindings {
                match &binding.target {
                    BindingTarget::UniformTable(name) => {
                        needs.tables.insert(name.clone(), TableKind::Uniform);
                    }
                    BindingTarget::StorageTable(name) => {
                        needs.tables.insert(name.clone(), TableKind::Storage);
                    }
                    BindingTarget::TableRow(table, row) => {
                        needs.rows.insert((table.clone(), *row));
                    }
                    BindingTarget::SceneTexture(name) => {
                        needs.textures.insert(name.clone());
                    }
                    BindingTarget::View(_) => needs.views = true,
                    BindingTarget::MaterialTexture(_) | BindingTarget::MaterialSampler(_) => needs.materials = true,
                    _ => {}
                }
            }
        }
        needs
    }
}

/// What a new scene changed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Changed {
    /// Objects that bind groups hold were replaced.
    pub(crate) bound: bool,
    /// Draw lists or materials differ.
    pub(crate) draws: bool,
}

/// The scene that stands on the device.
#[derive(Debug, Clone)]
pub(crate) struct SceneData {
    pub(crate) scene: Arc<PublishedScene>,
    needs: Needs,
    tables: BTreeMap<String, wgpu::Buffer>,
    rows: BTreeMap<(String, u32), wgpu::Buffer>,
    named_textures: BTreeMap<String, wgpu::TextureView>,
    created: u64,
    views: Vec<wgpu::Buffer>,
    vertices: Option<wgpu::Buffer>,
    indices: Option<wgpu::Buffer>,
    textures: Vec<wgpu::TextureView>,
    samplers: Vec<wgpu::Sampler>,
}

impl SceneData {
    /// Checks and uploads a scene.
    pub(crate) fn new(gpu: &Gpu, plan: &Plan, schema: &PublishedSchema, scene: Arc<PublishedScene>) -> Result<SceneData, Vec<Diagnostic>> {
        let mut data = SceneData {
            scene: Arc::default(),
            needs: Needs::of(plan),
            tables: BTreeMap::new(),
            rows: BTreeMap::new(),
            named_textures: BTreeMap::new(),
            created: 0,
            views: Vec::new(),
            vertices: None,
            indices: None,
            textures: Vec::new(),
            samplers: Vec::new(),
        };
        data.update(gpu, plan, schema, scene)?;
        Ok(data)
    }

    /// Takes another scene over. After an error the old one stands.
    pub(crate) fn update(
        &mut self,
        gpu: &Gpu,
        plan: &Plan,
        schema: &PublishedSchema,
        scene: Arc<PublishedScene>,
    ) -> Result<Changed, Vec<Diagnostic>> {
        if Arc::ptr_eq(&self.scene, &scene) {
            return Ok(Changed::default());
        }
        self.take(gpu, plan, schema, scene)
    }

    /// For another plan: what stands is kept, and what the plan needs in addition is created.
    pub(crate) fn successor(
        &self,
        gpu: &Gpu,
        plan: &Plan,
        schema: &PublishedSchema,
        scene: Arc<PublishedScene>,
    ) -> Result<(SceneData, Changed), Vec<Diagnostic>> {
        let mut next = self.clone();
        next.needs = Needs::of(plan);
        let changed = next.take(gpu, plan, schema, scene)?;
        Ok((next, changed))
    }

    /// Forgets what stands on the device, so that the next scene is written anew.
    pub(crate) fn forget(&mut self) {
        self.scene = Arc::default();
    }

    fn take(&mut self, gpu: &Gpu, plan: &Plan, schema: &PublishedSchema, scene: Arc<PublishedScene>) -> Result<Changed, Vec<Diagnostic>> {
        let problems = scene_check::check(plan, schema, &self.needs, &scene, &gpu.device.limits());
        if !problems.is_empty() {
            return Err(problems);
        }
        let (changed, errors) = catch(&gpu.device, || self.upload(gpu, schema, &scene));
        Subject::nowhere("uploading the scene").check(&errors).map_err(|problem| vec![problem])?;
        self.scene = scene;
        self.created += u64::from(changed.bound);
        Ok(changed)
    }

    /// A table's buffer.
    pub(crate) fn table(&self, name: &str) -> Option<&wgpu::Buffer> {
        self.tables.get(name)
    }

    /// The buffer of a table's row.
    pub(crate) fn row(&self, table: &str, row: u32) -> Option<&wgpu::Buffer> {
        self.rows.get(&(table.to_owned(), row))
    }

    /// How many buffers, textures and samplers were created.
    pub(crate) fn created(&self) -> u64 {
        self.created
    }

    /// The buffer of a view's table.
    pub(crate) fn view(&self, index: usize) -> Option<&wgpu::Buffer> {
        self.views.get(index)
    }

    /// Vertices and indices.
    pub(crate) fn geometry(&self) -> Option<(&wgpu::Buffer, &wgpu::Buffer)> {
        self.vertices.as_ref().zip(self.indices.as_ref())
    }

    /// A texture of the scene.
    pub(crate) fn named_texture(&self, name: &str) -> Option<&wgpu::TextureView> {
        self.named_textures.get(name)
    }

    /// A material's texture, by its index in the scene.
    pub(crate) fn texture(&self, index: usize) -> Option<&wgpu::TextureView> {
        self.textures.get(index)
    }

    /// A material's sampler, by its index in the scene.
    pub(crate) fn sampler(&self, index: usize) -> Option<&wgpu::Sampler> {
        self.samplers.get(index)
    }

    fn upload(&mut self, gpu: &Gpu, schema: &PublishedSchema, new: &PublishedScene) -> Changed {
        let old = Arc::clone(&self.scene);
        let mut changed = Changed { bound: false, draws: old.draw_lists != new.draw_lists || old.materials != new.materials };
        for (name, kind) in &self.needs.tables {
            let Some(bytes) = new.tables.get(name) else { continue };
            let stride = schema.tables.get(name).map_or(0, |table| table.stride);
            let usage = if *kind == TableKind::Storage { wgpu::BufferUsages::STORAGE } else { wgpu::BufferUsages::UNIFORM };
            let mut slot = self.tables.remove(name);
            changed.bound |= put_table(gpu, &mut slot, name, old.tables.get(name), bytes, u64::from(stride), usage);
            self.tables.extend(slot.map(|buffer| (name.clone(), buffer)));
        }
        for (name, row) in &self.needs.rows {
            let stride = schema.tables.get(name).map_or(0, |table| table.stride as usize);
            let bytes_of = |scene: &PublishedScene| {
                // A row that the scene has no more is zero.
                scene.tables.get(name).and_then(|table| table.row(*row as usize)).map_or_else(|| vec![0; stride], <[u8]>::to_vec)
            };
            let (before, after) = (bytes_of(&old), bytes_of(new));
            let mut slot = self.rows.remove(&(name.clone(), *row));
            let known = (!old.tables.is_empty()).then_some(before.as_slice());
            changed.bound |= put(gpu, &mut slot, name, known, &after, stride as u64, wgpu::BufferUsages::UNIFORM);
            self.rows.extend(slot.map(|buffer| ((name.clone(), *row), buffer)));
        }
        if self.needs.views {
            changed.bound |= self.views.len() != new.views.len();
            let stride = schema.tables.values().find(|table| table.kind == TableKind::View).map_or(0, |table| table.stride);
            let mut slots: Vec<Option<wgpu::Buffer>> = self.views.drain(..).map(Some).collect();
            slots.resize(new.views.len(), None);
            for (index, (slot, bytes)) in slots.iter_mut().zip(&new.views).enumerate() {
                let before = old.views.get(index).map(Vec::as_slice);
                changed.bound |= put(gpu, slot, "view", before, bytes, u64::from(stride), wgpu::BufferUsages::UNIFORM);
            }
            self.views = slots.into_iter().flatten().collect();
        }
        if self.needs.geometry {
            // Draws fetch these anew each frame, so that replacing them binds nothing.
            if self.vertices.is_none() || !Arc::ptr_eq(&old.geometry, &new.geometry) {
                put(
                    gpu,
                    &mut self.vertices,
                    "vertices",
                    Some(&old.geometry.vertices),
                    &new.geometry.vertices,
                    4,
                    wgpu::BufferUsages::VERTEX,
                );
                let [before, after] = [&old, new].map(|scene| bytemuck::cast_slice(&scene.geometry.indices));
                put(gpu, &mut self.indices, "indices", Some(before), after, 4, wgpu::BufferUsages::INDEX);
            }
        }
        for name in &self.needs.textures {
            let Some(texture) = new.textures.get(name) else { continue };
            let same = old.textures.get(name).is_some_and(|old| same_texture(old, texture));
            if !same || !self.named_textures.contains_key(name) {
                changed.bound = true;
                let view = create_texture(gpu, texture).create_view(&wgpu::TextureViewDescriptor::default());
                self.named_textures.insert(name.clone(), view);
            }
        }
        if self.needs.materials {
            changed.bound |= self.upload_textures(gpu, &old.materials, &new.materials);
            changed.bound |= self.make_samplers(gpu, &old.materials.samplers, &new.materials.samplers);
        }
        changed
    }

    /// Whether anything was created. A texture that stands at the same place with the same content stays.
    fn upload_textures(&mut self, gpu: &Gpu, old: &PublishedMaterials, new: &PublishedMaterials) -> bool {
        let mut standing = std::mem::take(&mut self.textures).into_iter();
        let (mut waiting, mut created) = (0, old.textures.len() != new.textures.len());
        for (index, texture) in new.textures.iter().enumerate() {
            let stands = standing.next().filter(|_| old.textures.get(index).is_some_and(|old| same_texture(old, texture)));
            self.textures.push(stands.unwrap_or_else(|| {
                created = true;
                waiting += texture.mips.iter().map(|mip| mip.len()).sum::<usize>();
                if waiting > UPLOAD_BATCH {
                    gpu.queue.submit(None);
                    waiting = 0;
                }
                create_texture(gpu, texture).create_view(&wgpu::TextureViewDescriptor::default())
            }));
        }
        created
    }

    /// Whether anything was created.
    fn make_samplers(&mut self, gpu: &Gpu, old: &[PublishedSampler], new: &[PublishedSampler]) -> bool {
        if self.samplers.len() == new.len() && old == new {
            return false;
        }
        self.samplers = new.iter().map(|sampler| samplers::published(&gpu.device, sampler)).collect();
        true
    }
}

/// Brings a table's buffer to new content, whatever changed of it. Whether a new one was created.
fn put_table(
    gpu: &Gpu,
    slot: &mut Option<wgpu::Buffer>,
    label: &str,
    old: Option<&Table>,
    new: &Table,
    least: u64,
    usage: wgpu::BufferUsages,
) -> bool {
    match (slot.as_ref(), old) {
        // Rows are whole words, so that pages begin and end at multiples of 4.
        (Some(buffer), Some(old)) if old.len() == new.len() && new.stride().is_multiple_of(4) && new.len().is_multiple_of(4) => {
            for range in new.changes(old) {
                let mut start = range.start as u64;
                for bytes in new.slices(range) {
                    gpu.queue.write_buffer(buffer, start, bytes);
                    start += bytes.len() as u64;
                }
            }
            false
        }
        _ => put(gpu, slot, label, old.map(Table::bytes).as_deref(), &new.bytes(), least, usage),
    }
}

/// Brings a buffer to new content. Whether a new one was created. `least` is the least size in bytes.
fn put(
    gpu: &Gpu,
    slot: &mut Option<wgpu::Buffer>,
    label: &str,
    old: Option<&[u8]>,
    new: &[u8],
    least: u64,
    usage: wgpu::BufferUsages,
) -> bool {
    // Uniform structs are rounded up to 16 bytes by the language; all else to what copies need.
    let unit = if usage.contains(wgpu::BufferUsages::UNIFORM) { 16 } else { 4 };
    let size = (new.len() as u64).max(least).max(4).next_multiple_of(unit);
    let kept = slot.as_ref().filter(|buffer| buffer.size() == size).cloned();
    let created = kept.is_none();
    if !created && old == Some(new) {
        return false;
    }
    let buffer = kept.unwrap_or_else(|| {
        gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size,
            usage: usage | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        })
    });
    let whole = new.len() & !3;
    if whole > 0 {
        gpu.queue.write_buffer(&buffer, 0, &new[..whole]);
    }
    if whole < new.len() {
        let mut rest = [0; 4];
        rest[..new.len() - whole].copy_from_slice(&new[whole..]);
        gpu.queue.write_buffer(&buffer, whole as u64, &rest);
    }
    *slot = Some(buffer);
    created
}

/// Names do not count.
pub(crate) fn same_texture(old: &Arc<PublishedTexture>, new: &Arc<PublishedTexture>) -> bool {
    Arc::ptr_eq(old, new) || (old.texels, old.width, old.height) == (new.texels, new.width, new.height) && old.mips == new.mips
}

/// The texture has been checked: every level has its bytes.
fn create_texture(gpu: &Gpu, texture: &PublishedTexture) -> wgpu::Texture {
    let size = wgpu::Extent3d { width: texture.width, height: texture.height, depth_or_array_layers: 1 };
    let created = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some(&texture.name),
        size,
        mip_level_count: texture.mips.len() as u32,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: match texture.texels {
            PublishedTexels::Unorm8 => wgpu::TextureFormat::Rgba8Unorm,
            PublishedTexels::Srgb8 => wgpu::TextureFormat::Rgba8UnormSrgb,
            PublishedTexels::Float => wgpu::TextureFormat::Rgba32Float,
        },
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    for (level, bytes) in texture.mips.iter().enumerate() {
        let level_size = size.mip_level_size(level as u32, wgpu::TextureDimension::D2);
        gpu.queue.write_texture(
            wgpu::TexelCopyTextureInfo { mip_level: level as u32, ..created.as_image_copy() },
            bytes,
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(level_size.width * texture.texels.bytes()), rows_per_image: None },
            level_size,
        );
    }
    created
}
