//! From a path to JSON text and the binary chunk: `.gltf` and `.glb`, told apart by their first bytes.
//!
//! Guarantees: nothing is read from a folder or a device, chunk lengths are held against the bytes that exist, and JSON nested
//! deeper than the reader's limit (128) is an error. Downside: the whole file is in memory at once.

use std::path::Path;

use serde_json::Value;

use super::report::Report;

/// The largest `.gltf` or `.glb`, in bytes: what the length field of a GLB can say.
const LARGEST_FILE: u64 = u32::MAX as u64;
/// The largest JSON text, in bytes. Its tree takes many times as much.
const LARGEST_JSON: usize = 512 << 20;

const GLB_MAGIC: &[u8] = b"glTF";
const GLB_HEADER: usize = 12;
const CHUNK_HEADER: usize = 8;
const CHUNK_JSON: u32 = 0x4E4F_534A;
const CHUNK_BIN: u32 = 0x004E_4942;

/// What a file holds before anything in it is understood.
pub(super) struct Container {
    /// An object.
    pub(super) json: Value,
    /// The BIN chunk of a GLB.
    pub(super) binary: Option<Vec<u8>>,
}

/// Reads a file. `None` means that the report says why not.
pub(super) fn read(path: &Path, report: &Report) -> Option<Container> {
    let bytes = read_file(path, report)?;
    parse(&bytes, report)
}

/// Splits and parses a file's bytes.
pub(super) fn parse(bytes: &[u8], report: &Report) -> Option<Container> {
    let (text, binary) = if bytes.starts_with(GLB_MAGIC) { split_glb(bytes, report)? } else { (bytes, None) };
    let text = match text.strip_prefix(b"\xEF\xBB\xBF") {
        Some(rest) => {
            report.warning("gltf::byte-order-mark", "", "starts with a byte order mark, which glTF forbids", "save it without one");
            rest
        }
        None => text,
    };
    if text.len() > LARGEST_JSON {
        let problem = format!("the JSON has {} bytes, more than the {LARGEST_JSON} that are read", text.len());
        report.error("gltf::too-large", "", problem, "keep binary data in a .bin file or use .glb");
        return None;
    }
    match serde_json::from_slice::<Value>(text) {
        Ok(json) if json.is_object() => Some(Container { json, binary }),
        Ok(_) => {
            report.error("gltf::not-an-object", "", "expected a JSON object at the top", "is this a glTF file?");
            None
        }
        Err(error) => {
            let hint = if text.is_empty() { "the file is empty" } else { "is this a glTF file, and complete?" };
            report.error("gltf::invalid-json", "", format_args!("is neither GLB nor valid JSON: {error}"), hint);
            None
        }
    }
}

fn read_file(path: &Path, report: &Report) -> Option<Vec<u8>> {
    let refuse = |problem: String| {
        report.error("gltf::unreadable", "", problem, "");
        None
    };
    // A pipe or a device would block or never end.
    match std::fs::metadata(path) {
        Err(error) => return refuse(format!("can't be read: {error}")),
        Ok(data) if !data.is_file() => return refuse("is not a file".to_owned()),
        Ok(data) if data.len() > LARGEST_FILE => {
            return refuse(format!("has {} bytes, more than the {LARGEST_FILE} that are read", data.len()));
        }
        Ok(_) => {}
    }
    std::fs::read(path).or_else(|error| refuse(format!("can't be read: {error}")).ok_or(())).ok()
}

/// The JSON and BIN chunks of a GLB.
fn split_glb<'a>(bytes: &'a [u8], report: &Report) -> Option<(&'a [u8], Option<Vec<u8>>)> {
    let refuse = |code, problem: String| {
        report.error(code, "", problem, "the file is damaged or incomplete; copy or export it again");
        None
    };
    let (Some(version), Some(length)) = (word(bytes, 4), word(bytes, 8)) else {
        return refuse("gltf::truncated", format!("has {} bytes, less than a GLB header", bytes.len()));
    };
    if version != 2 {
        return refuse("gltf::version", format!("is GLB version {version}; version 2 is supported"));
    }
    let Some(body) = bytes.get(..length as usize) else {
        return refuse("gltf::truncated", format!("has {} bytes, but its GLB header promises {length}", bytes.len()));
    };
    if body.len() < bytes.len() {
        let problem = format!("{} bytes follow the end that the GLB header gives, and are ignored", bytes.len() - body.len());
        report.warning("gltf::trailing-bytes", "", problem, "");
    }
    let mut json = None;
    let mut binary = None;
    let mut at = GLB_HEADER;
    for number in 0.. {
        if at >= body.len() {
            break;
        }
        let (Some(size), Some(kind)) = (word(body, at), word(body, at + 4)) else {
            return refuse("gltf::truncated", format!("chunk {number} has no complete header"));
        };
        let start = at + CHUNK_HEADER;
        let Some(chunk) = start.checked_add(size as usize).and_then(|end| body.get(start..end)) else {
            let left = body.len().saturating_sub(start);
            return refuse("gltf::truncated", format!("chunk {number} promises {size} bytes, but {left} are left"));
        };
        match (number, kind) {
            (0, CHUNK_JSON) => json = Some(chunk),
            (0, _) => return refuse("gltf::no-json-chunk", "the first chunk of a GLB must be JSON".to_owned()),
            (1, CHUNK_BIN) => binary = Some(chunk.to_vec()),
            // Chunks of other kinds are for extensions.
            _ => {}
        }
        // Chunks start at multiples of four.
        at = (start + chunk.len()).next_multiple_of(4);
    }
    match json {
        Some(json) => Some((json, binary)),
        None => refuse("gltf::no-json-chunk", "has no JSON chunk".to_owned()),
    }
}

/// A little endian 32-bit word.
fn word(bytes: &[u8], at: usize) -> Option<u32> {
    bytes.get(at..)?.first_chunk::<4>().map(|four| u32::from_le_bytes(*four))
}
