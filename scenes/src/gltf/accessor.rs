//! Accessors: typed arrays over buffer views, with sparse replacements.
//!
//! Guarantees: once read, every element of an [`Accessor`] lies inside of bytes that exist (or is an implied zero), and every
//! sparse index is in range. Unaligned data is accepted, since elements are decoded from bytes.

use std::collections::BTreeMap;

use super::buffer::View;
use super::element::{Component, Kind};
use super::json::{Json, clip};

/// How many elements an accessor without a buffer view may have if all of the file's buffers are smaller.
const MOST_IMPLIED: u64 = 1 << 16;

/// A checked accessor.
pub(super) struct Accessor<'b> {
    /// The JSON path, for messages.
    pub(super) place: String,
    /// Type of one component.
    pub(super) component: Component,
    /// Components of an element.
    pub(super) kind: Kind,
    /// Whether integers stand for 0..1 or -1..1.
    pub(super) normalized: bool,
    /// Elements, at least 1.
    pub(super) count: usize,
    /// Bytes and stride; `None` is zeros.
    base: Option<(&'b [u8], usize)>,
    /// Bytes of the elements that differ from the base.
    replaced: BTreeMap<usize, &'b [u8]>,
}

impl<'b> Accessor<'b> {
    /// The bytes of an element; `None` for zeros and past the end.
    pub(super) fn element(&self, index: usize) -> Option<&'b [u8]> {
        if !self.replaced.is_empty()
            && let Some(bytes) = self.replaced.get(&index)
        {
            return Some(bytes);
        }
        let (bytes, stride) = self.base?;
        let start = index.checked_mul(stride)?;
        bytes.get(start..start.checked_add(self.size())?)
    }

    /// Whether no byte of the file stands behind it: all elements are zero.
    pub(super) fn is_implied(&self) -> bool {
        self.base.is_none() && self.replaced.is_empty()
    }

    /// Bytes of an element.
    pub(super) fn size(&self) -> usize {
        self.kind.size(self.component)
    }

    /// For messages, for example `VEC3 of FLOAT`.
    pub(super) fn shown(&self) -> String {
        format!("{} of {}{}", self.kind.name(), if self.normalized { "normalized " } else { "" }, self.component.name())
    }
}

/// What accessors may ask for beyond a range of bytes. Many accessors over the same few bytes must not multiply them.
struct Limits {
    /// Elements of one accessor without a buffer view.
    implied: u64,
    /// Sparse elements that all accessors together may still have.
    sparse: u64,
}

/// Checks every accessor; the file's buffers have `bytes` bytes together. A broken accessor is reported, and `None`.
pub(super) fn read_accessors<'b>(root: &Json<'_>, views: &[Option<View<'b>>], bytes: u64) -> Vec<Option<Accessor<'b>>> {
    // A sparse element takes at least two bytes, for its index and its value.
    let mut limits = Limits { implied: bytes.max(MOST_IMPLIED), sparse: bytes };
    root.objects("accessors").iter().map(|accessor| read_accessor(accessor, views, &mut limits)).collect()
}

fn read_accessor<'b>(json: &Json<'_>, views: &[Option<View<'b>>], limits: &mut Limits) -> Option<Accessor<'b>> {
    let component = component(json);
    let kind = json.required("type").and_then(|_| json.text("type")).and_then(|name| {
        let kind = Kind::named(name);
        if kind.is_none() {
            let expected = "expected SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3 or MAT4";
            json.error_at("type", "gltf::accessor-type", format_args!("{expected}, found `{}`", clip(name)));
        }
        kind
    });
    let count = json.required_count("count")?;
    if count == 0 {
        json.error_at("count", "gltf::accessor-empty", "must be at least 1");
        return None;
    }
    let normalized = json.boolean("normalized").unwrap_or(false);
    let (component, kind) = (component?, kind?);
    if normalized && matches!(component, Component::F32 | Component::U32) {
        json.error_at("normalized", "gltf::accessor-type", format_args!("{} can't be normalized", component.name()));
        return None;
    }
    let size = kind.size(component);
    let base = match json.has("bufferView") {
        true => {
            let view = views.get(json.index("bufferView", "bufferViews", views.len())?).copied().flatten()?;
            let offset = offset(json)?;
            let stride = view.stride.unwrap_or(size);
            if stride < size {
                json.error(
                    "gltf::stride",
                    format_args!("its elements have {size} bytes, more than the stride of {stride} of its buffer view"),
                );
                return None;
            }
            Some((range(json, view.bytes, offset, stride, size, count)?, stride))
        }
        false if count > limits.implied => {
            json.error_at(
                "count",
                "gltf::accessor-too-large",
                format_args!("promises {count} elements, and has no buffer view that holds them"),
            );
            return None;
        }
        false => None,
    };
    let count = usize::try_from(count).ok()?;
    let replaced = match json.object("sparse") {
        Some(sparse) => read_sparse(&sparse, views, count, size, limits)?,
        None => BTreeMap::new(),
    };
    Some(Accessor { place: json.place().to_owned(), component, kind, normalized, count, base, replaced })
}

fn component(json: &Json<'_>) -> Option<Component> {
    let code = json.required_count("componentType")?;
    let component = Component::coded(code);
    if component.is_none() {
        let expected = "expected 5120, 5121, 5122, 5123, 5125 or 5126";
        json.error_at("componentType", "gltf::accessor-type", format_args!("{expected}, found {code}"));
    }
    component
}

fn offset(json: &Json<'_>) -> Option<u64> {
    if json.has("byteOffset") { json.count("byteOffset") } else { Some(0) }
}

/// The bytes from the first element to the end of the view, if they hold `count` elements.
fn range<'b>(json: &Json<'_>, bytes: &'b [u8], offset: u64, stride: usize, size: usize, count: u64) -> Option<&'b [u8]> {
    let needed = (count.saturating_sub(1)).checked_mul(stride as u64).and_then(|before| before.checked_add(size as u64));
    let end = needed.and_then(|needed| needed.checked_add(offset));
    match (usize::try_from(offset), end) {
        (Ok(start), Some(end)) if end <= bytes.len() as u64 => bytes.get(start..),
        _ => {
            let problem = format!("{count} elements of {size} bytes from byte {offset} on leave the buffer view of {} bytes", bytes.len());
            json.error("gltf::accessor-out-of-range", problem);
            None
        }
    }
}

fn read_sparse<'b>(
    json: &Json<'_>,
    views: &[Option<View<'b>>],
    count: usize,
    size: usize,
    limits: &mut Limits,
) -> Option<BTreeMap<usize, &'b [u8]>> {
    let replaced = json.required_count("count")?;
    if replaced > count as u64 {
        json.error_at("count", "gltf::sparse", format_args!("replaces {replaced} of {count} elements"));
        return None;
    }
    let Some(rest) = limits.sparse.checked_sub(replaced) else {
        json.error_at("count", "gltf::sparse", "the sparse accessors replace more elements than the buffers have bytes");
        return None;
    };
    limits.sparse = rest;
    let part = |key: &str| {
        let part = json.required(key).and_then(|_| json.object(key))?;
        let view = views.get(part.required_index("bufferView", "bufferViews", views.len())?).copied().flatten()?;
        Some((part, view.bytes))
    };
    let (indices, values) = (part("indices"), part("values"));
    let ((indices, index_bytes), (values, value_bytes)) = (indices?, values?);
    let component = component(&indices)?;
    if !matches!(component, Component::U8 | Component::U16 | Component::U32) {
        indices.error_at("componentType", "gltf::accessor-type", format_args!("indices can't be {}", component.name()));
        return None;
    }
    if replaced == 0 {
        return Some(BTreeMap::new());
    }
    let index_bytes = range(&indices, index_bytes, offset(&indices)?, component.size(), component.size(), replaced)?;
    let value_bytes = range(&values, value_bytes, offset(&values)?, size, size, replaced)?;
    let mut map = BTreeMap::new();
    let pairs = index_bytes.chunks_exact(component.size()).zip(value_bytes.chunks_exact(size));
    for (index, value) in pairs.take(usize::try_from(replaced).ok()?) {
        match component.unsigned(index) {
            Some(index) if (index as usize) < count => map.insert(index as usize, value),
            found => {
                indices.error("gltf::sparse", format_args!("replaces element {} of {count}", found.unwrap_or_default()));
                return None;
            }
        };
    }
    Some(map)
}
