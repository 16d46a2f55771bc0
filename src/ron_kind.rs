//! Whether a RON file is a pipeline or a scene, which share their extension: the names of its outermost fields tell.
//!
//! Works on broken texts too, since it decides which reader's messages people see. Accepted downside: a text with none of the
//! names is of no kind, and read as a pipeline.

/// Fields that only pipelines have.
const PIPELINE: [&str; 7] = ["params", "resources", "passes", "outputs", "blocks", "inputs", "extend"];
/// Fields that only scenes have.
const SCENE: [&str; 9] = ["environment", "materials", "groups", "cameras", "lights", "objects", "files", "markers", "timeline"];

/// What a RON file is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RonKind {
    /// It has passes, or what comes with them.
    Pipeline,
    /// It has objects, lights or materials.
    Scene,
}

impl RonKind {
    /// The kind that most of the outermost fields belong to; `None` if it is a draw.
    pub fn of(text: &str) -> Option<RonKind> {
        let fields = outermost_fields(text);
        let count = |known: &[&str]| fields.iter().filter(|field| known.contains(field)).count();
        match count(&PIPELINE).cmp(&count(&SCENE)) {
            std::cmp::Ordering::Greater => Some(RonKind::Pipeline),
            std::cmp::Ordering::Less => Some(RonKind::Scene),
            std::cmp::Ordering::Equal => None,
        }
    }
}

/// Names with a colon behind them, inside one bracket; comments and strings are passed over.
fn outermost_fields(text: &str) -> Vec<&str> {
    let mut fields = Vec::new();
    let mut depth = 0_usize;
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let length = match first {
            '/' if rest.starts_with("//") => rest.find('\n').unwrap_or(rest.len()),
            '/' if rest.starts_with("/*") => rest[2..].find("*/").map_or(rest.len(), |end| end + 4),
            '"' => string_length(rest),
            '(' | '[' | '{' => {
                depth += 1;
                1
            }
            ')' | ']' | '}' => {
                depth = depth.saturating_sub(1);
                1
            }
            c if c.is_ascii_alphabetic() => {
                let length = rest.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(rest.len());
                if depth == 1 && rest[length..].trim_start().starts_with(':') {
                    fields.push(&rest[..length]);
                }
                length
            }
            c => c.len_utf8(),
        };
        rest = &rest[length..];
    }
    fields
}

/// A string literal with its quotes, or all that is left.
fn string_length(text: &str) -> usize {
    let mut escaped = false;
    for (at, c) in text.char_indices().skip(1) {
        match c {
            '"' if !escaped => return at + 1,
            '\\' => escaped = !escaped,
            _ => escaped = false,
        }
    }
    text.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_decide() {
        assert_eq!(RonKind::of("(doc: \"objects: {\", passes: {\"objects\": 1}, outputs: {})"), Some(RonKind::Pipeline));
        assert_eq!(RonKind::of("// passes:\n(doc: \"\\\"\", objects: {}, /* passes: */ lights: {})"), Some(RonKind::Scene));
        assert_eq!(RonKind::of("( doc: \"x\", params: {"), Some(RonKind::Pipeline));
        assert_eq!(RonKind::of(""), None);
        assert_eq!(RonKind::of("(\"é"), None);
    }
}
