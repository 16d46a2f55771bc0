//! Buffers and the ranges in them.
//!
//! Guarantees: a [`View`] lies inside of bytes that exist. Buffers are read up to their `byteLength`, whatever the file's size.

use super::json::Json;
use super::uri::Folder;

/// Bytes of all buffers together.
const MOST_BYTES: u64 = 1 << 31;

/// A range of a buffer.
#[derive(Clone, Copy)]
pub(super) struct View<'a> {
    /// The whole range.
    pub(super) bytes: &'a [u8],
    /// Distance of vertices, if the file gives one.
    pub(super) stride: Option<usize>,
}

/// Reads every buffer. A broken one is reported, and `None`.
pub(super) fn read_buffers(root: &Json<'_>, binary: Option<Vec<u8>>, folder: &Folder) -> Vec<Option<Vec<u8>>> {
    let mut binary = binary;
    let mut left = MOST_BYTES;
    let buffers = root.objects("buffers");
    let read = |(index, buffer)| {
        let bytes = read_buffer(buffer, binary.take_if(|_| index == 0), folder, left)?;
        left = left.saturating_sub(bytes.len() as u64);
        Some(bytes)
    };
    buffers.iter().enumerate().map(read).collect()
}

/// The bytes of all buffers together.
pub(super) fn total(buffers: &[Option<Vec<u8>>]) -> u64 {
    buffers.iter().flatten().map(|buffer| buffer.len() as u64).fold(0, u64::saturating_add)
}

fn read_buffer(buffer: &Json<'_>, binary: Option<Vec<u8>>, folder: &Folder, most: u64) -> Option<Vec<u8>> {
    let length = buffer.required_count("byteLength")?;
    if length == 0 {
        buffer.error_at("byteLength", "gltf::empty-buffer", "must be at least 1");
        return None;
    }
    let mut bytes = if buffer.has("uri") {
        let uri = buffer.text("uri")?;
        match folder.read(uri, length.min(most)) {
            Ok(bytes) if length > most && bytes.len() as u64 == most => {
                buffer.error("gltf::too-large", format_args!("the buffers have more than {MOST_BYTES} bytes together"));
                return None;
            }
            Ok(bytes) => bytes,
            Err(problem) => {
                let hint = "keep the buffer beside the glTF file";
                buffer.report().error("gltf::unreadable-uri", buffer.place_of("uri"), problem, hint);
                return None;
            }
        }
    } else {
        match binary {
            Some(bytes) => bytes,
            None => {
                let extension = buffer.members("extensions").first().map(|(name, _)| format!("; it may need the extension {name}"));
                let problem = format!("has no `uri`, and the file has no binary chunk for it{}", extension.unwrap_or_default());
                buffer.error("gltf::no-buffer-data", problem);
                return None;
            }
        }
    };
    match usize::try_from(length) {
        Ok(length) if length <= bytes.len() => {
            // A binary chunk is padded to a multiple of four.
            bytes.truncate(length);
            Some(bytes)
        }
        _ => {
            let problem = format!("promises {length} bytes, but {} exist", bytes.len());
            buffer.error_at("byteLength", "gltf::buffer-too-short", problem);
            None
        }
    }
}

/// Checks every buffer view.
pub(super) fn read_views<'b>(root: &Json<'_>, buffers: &'b [Option<Vec<u8>>]) -> Vec<Option<View<'b>>> {
    root.objects("bufferViews").iter().map(|view| read_view(view, buffers)).collect()
}

fn read_view<'b>(view: &Json<'_>, buffers: &'b [Option<Vec<u8>>]) -> Option<View<'b>> {
    let buffer = view.required_index("buffer", "buffers", buffers.len());
    let length = view.required_count("byteLength")?;
    let offset = if view.has("byteOffset") { view.count("byteOffset")? } else { 0 };
    let stride = if view.has("byteStride") { Some(view.count("byteStride")?) } else { None };
    if let Some(stride) = stride
        && !(4..=252).contains(&stride)
    {
        view.error_at("byteStride", "gltf::stride", format_args!("expected 4 to 252, found {stride}"));
        return None;
    }
    if length == 0 {
        view.error_at("byteLength", "gltf::empty-view", "must be at least 1");
        return None;
    }
    let bytes = buffers.get(buffer?)?.as_deref()?;
    match slice(bytes, offset, length) {
        Some(bytes) => Some(View { bytes, stride: stride.and_then(|stride| usize::try_from(stride).ok()) }),
        None => {
            let problem = format!("starts at byte {offset} and has {length} bytes, but its buffer has {}", bytes.len());
            view.error("gltf::view-out-of-range", problem);
            None
        }
    }
}

/// A range, if all of it exists.
fn slice(bytes: &[u8], offset: u64, length: u64) -> Option<&[u8]> {
    let start = usize::try_from(offset).ok()?;
    let end = start.checked_add(usize::try_from(length).ok()?)?;
    bytes.get(start..end)
}
