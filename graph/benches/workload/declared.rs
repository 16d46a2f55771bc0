//! A graph as its file declares it, all by name: what every planner here starts from.

use std::path::Path;

use serde_json::Value as Json;

/// Bytes are counted in units of this.
pub const UNIT: u64 = 64 << 10;

/// A graph whose passes stand in an order that gives them their meaning.
pub struct Declared {
    pub passes: Vec<DeclaredPass>,
    pub resources: Vec<DeclaredResource>,
    pub outputs: Vec<String>,
}

/// A pass.
pub struct DeclaredPass {
    pub name: String,
    pub reads: Vec<String>,
    /// Replaced as a whole.
    pub writes: Vec<String>,
    pub modifies: Vec<String>,
}

/// A texture, or a buffer of `width` bytes.
pub struct DeclaredResource {
    pub name: String,
    pub format: String,
    pub extent: [u32; 3],
    pub mips: u32,
    pub layers: u32,
    /// What it costs, in whole units.
    pub bytes: u64,
}

impl Declared {
    /// Reads a file.
    pub fn read(path: &Path) -> Declared {
        let json: Json = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
        let list = |json: &Json, key: &str| json[key].as_array().unwrap().clone();
        let text = |json: &Json| json.as_str().unwrap().to_owned();
        let names = |json: &Json, key: &str| list(json, key).iter().map(text).collect::<Vec<String>>();
        let pass = |json: &Json| DeclaredPass {
            name: text(&json["name"]),
            reads: names(json, "reads"),
            writes: names(json, "writes"),
            modifies: names(json, "modifies"),
        };
        let resource = |json: &Json| {
            let number = |key: &str| json[key].as_u64().unwrap();
            DeclaredResource {
                name: text(&json["name"]),
                format: text(&json["format"]),
                extent: ["width", "height", "depth"].map(|key| number(key) as u32),
                mips: number("mips") as u32,
                layers: number("layers") as u32,
                bytes: number("bytes"),
            }
        };
        Declared {
            passes: list(&json, "passes").iter().map(pass).collect(),
            resources: list(&json, "resources").iter().map(resource).collect(),
            outputs: names(&json, "outputs"),
        }
    }
}
