//! Where buffers and images come from: data URIs, and files inside of the asset's folder.
//!
//! Guarantees: a scene file from a stranger reads nothing outside of the folder that the caller named. Absolute paths, schemes,
//! `..` that leaves the folder, symbolic links that leave it, folders and devices are refused; nothing is fetched from a network.

use std::io::Read;
use std::path::{Component, Path, PathBuf};

use base64::Engine;
use base64::alphabet;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};

use super::json::clip;

/// Standard base64; some writers leave the padding out.
const BASE64: GeneralPurpose =
    GeneralPurpose::new(&alphabet::STANDARD, GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent));

/// The folders that URIs are resolved against.
pub(super) enum Folder {
    /// The file is in memory, and names no others.
    Nowhere,
    /// The file is on disk.
    At {
        /// Where the file is: URIs are relative to it.
        base: PathBuf,
        /// Canonical; nothing outside of it is read.
        root: PathBuf,
    },
}

impl Folder {
    /// The folder of `file`, confined to `root`, or to that folder where there is no root.
    pub(super) fn of(file: &Path, root: Option<&Path>) -> Result<Folder, String> {
        let parent = match file.parent() {
            Some(parent) if parent != Path::new("") => parent,
            _ => Path::new("."),
        };
        let canonical = |path: &Path| path.canonicalize().map_err(|error| format!("the folder {} can't be read: {error}", path.display()));
        let base = canonical(parent)?;
        let root = root.map_or_else(|| Ok(base.clone()), canonical)?;
        if !base.starts_with(&root) {
            return Err(format!("lies outside of the asset folder {}", root.display()));
        }
        Ok(Folder::At { base, root })
    }

    /// The bytes behind a URI, at most `limit` of them.
    pub(super) fn read(&self, uri: &str, limit: u64) -> Result<Vec<u8>, String> {
        if let Some(data) = strip_scheme(uri, "data") {
            return decode_data(data, limit);
        }
        let path = self.resolve(uri)?;
        let unreadable = |error: std::io::Error| format!("the file `{}` can't be read: {error}", clip(uri));
        if !std::fs::metadata(&path).map_err(unreadable)?.is_file() {
            return Err(format!("`{}` is not a file", clip(uri)));
        }
        let mut bytes = Vec::new();
        std::fs::File::open(&path).and_then(|file| file.take(limit).read_to_end(&mut bytes)).map_err(unreadable)?;
        Ok(bytes)
    }

    fn resolve(&self, uri: &str) -> Result<PathBuf, String> {
        let Folder::At { base, root } = self else {
            return Err(format!("`{}` names a file, and only data URIs are read where there is no folder", clip(uri)));
        };
        let outside = || format!("`{}` leaves the asset folder", clip(uri));
        if let Some(scheme) = scheme(uri) {
            return Err(format!("`{}` has the scheme `{scheme}`; only files and data URIs are read", clip(uri)));
        }
        let decoded = percent_encoding::percent_decode_str(uri)
            .decode_utf8()
            .map_err(|_| format!("`{}` is not UTF-8 once its percent signs are decoded", clip(uri)))?;
        if decoded.is_empty() || decoded.contains('\0') {
            return Err(format!("`{}` names no file", clip(uri)));
        }
        if decoded.starts_with(['/', '\\']) {
            return Err(outside());
        }
        let mut path = base.clone();
        for component in Path::new(decoded.as_ref()).components() {
            match component {
                Component::Normal(name) => path.push(name),
                Component::CurDir => {}
                Component::ParentDir => {
                    if path == *root || !path.pop() {
                        return Err(outside());
                    }
                }
                Component::RootDir | Component::Prefix(_) => return Err(outside()),
            }
        }
        // The text is fine; a symbolic link could still lead elsewhere.
        let real = path.canonicalize().map_err(|error| format!("the file `{}` can't be read: {error}", clip(uri)))?;
        if real.starts_with(root) { Ok(real) } else { Err(outside()) }
    }
}

/// The scheme of a URI: letters, digits, `+`, `-`, `.` before a colon. A Windows drive letter looks the same, and is as unwelcome.
fn scheme(uri: &str) -> Option<&str> {
    let (scheme, _) = uri.split_once(':')?;
    let valid = scheme.starts_with(|first: char| first.is_ascii_alphabetic())
        && scheme.chars().all(|c| c.is_ascii_alphanumeric() || matches!(c, '+' | '-' | '.'));
    valid.then_some(scheme)
}

fn strip_scheme<'a>(uri: &'a str, wanted: &str) -> Option<&'a str> {
    let found = scheme(uri)?;
    if found.eq_ignore_ascii_case(wanted) { uri.get(found.len() + 1..) } else { None }
}

/// The content of a data URI, after `data:`.
fn decode_data(data: &str, limit: u64) -> Result<Vec<u8>, String> {
    let Some((media_type, content)) = data.split_once(',') else {
        return Err("the data URI has no comma".to_owned());
    };
    let mut bytes = if media_type.trim_end().to_ascii_lowercase().ends_with(";base64") {
        BASE64.decode(content.trim_ascii()).map_err(|error| format!("the data URI is not valid base64: {error}"))?
    } else {
        percent_encoding::percent_decode_str(content).collect()
    };
    bytes.truncate(usize::try_from(limit).unwrap_or(usize::MAX));
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder() -> (tempfile::TempDir, Folder) {
        let dir = tempfile::tempdir().unwrap();
        let inner = dir.path().join("inner");
        std::fs::create_dir_all(inner.join("sub")).unwrap();
        std::fs::write(dir.path().join("secret.bin"), b"secret").unwrap();
        std::fs::write(inner.join("a b.bin"), b"content").unwrap();
        #[cfg(unix)]
        std::os::unix::fs::symlink(dir.path().join("secret.bin"), inner.join("link.bin")).unwrap();
        let folder = Folder::of(&inner.join("file.gltf"), None).unwrap();
        (dir, folder)
    }

    #[test]
    fn files_inside_are_read() {
        let (_dir, folder) = folder();
        assert_eq!(folder.read("a%20b.bin", 100).unwrap(), b"content");
        assert_eq!(folder.read("sub/../a b.bin", 3).unwrap(), b"con");
        assert_eq!(folder.read("data:application/octet-stream;base64,AQID", 100).unwrap(), [1, 2, 3]);
        assert_eq!(folder.read("data:;base64,AQI", 100).unwrap(), [1, 2]);
        assert_eq!(folder.read("data:,a%20b", 100).unwrap(), b"a b");
    }

    #[test]
    fn nothing_outside_is_read() {
        let (dir, folder) = folder();
        let absolute = dir.path().join("secret.bin").display().to_string();
        let bad = [
            "../secret.bin",
            "sub/../../secret.bin",
            "%2e%2e/secret.bin",
            "link.bin",
            "sub",
            "",
            "http://example.org/a",
            "file:///etc/hosts",
        ];
        for uri in bad.into_iter().chain([absolute.as_str()]) {
            assert!(folder.read(uri, 100).is_err(), "{uri} was read");
        }
    }

    #[test]
    fn bytes_in_memory_name_no_files() {
        let (dir, _folder) = folder();
        let absolute = dir.path().join("secret.bin").display().to_string();
        let zeros = format!("data:;base64,{}", "A".repeat(48));
        // Both exist: tests run in the folder of the crate.
        assert!(std::fs::exists("Cargo.toml").unwrap() && std::fs::exists(&absolute).unwrap());
        let text = |buffer: &str, image: &str| {
            format!(
                r#"{{ "asset": {{ "version": "2.0" }}, "scenes": [{{ "nodes": [0] }}], "nodes": [{{ "mesh": 0 }}],
                "buffers": [{{ "byteLength": 36, "uri": "{buffer}" }}], "bufferViews": [{{ "buffer": 0, "byteLength": 36 }}],
                "images": [{{ "uri": "{image}" }}], "textures": [{{ "source": 0 }}],
                "materials": [{{ "emissiveTexture": {{ "index": 0 }} }}],
                "accessors": [{{ "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3" }}],
                "meshes": [{{ "primitives": [{{ "attributes": {{ "POSITION": 0 }}, "material": 0 }}] }}] }}"#
            )
        };
        for uri in [absolute.as_str(), "Cargo.toml", "./Cargo.toml", "file:///etc/hosts", "src/../Cargo.toml"] {
            for (buffer, image) in [(uri, "data:image/png;base64,AAAA"), (zeros.as_str(), uri)] {
                let problems = crate::gltf::load_bytes("memory.gltf", text(buffer, image).as_bytes()).unwrap_err();
                let said = problems.iter().any(|problem| problem.message.contains("only data URIs are read where there is no folder"));
                assert!(said, "{uri}: {problems:?}");
            }
        }
    }

    #[test]
    fn a_wider_root_allows_neighbours() {
        let (dir, _) = folder();
        let folder = Folder::of(&dir.path().join("inner/file.gltf"), Some(dir.path())).unwrap();
        assert_eq!(folder.read("../secret.bin", 100).unwrap(), b"secret");
        assert!(folder.read("../../secret.bin", 100).is_err());
    }
}
