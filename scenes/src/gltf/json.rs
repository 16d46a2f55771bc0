//! A cursor over the file's JSON that knows where it stands.
//!
//! Guarantees: a value of the wrong type, a number that is not finite in 32 bits, a reference out of range and a missing
//! property are each reported with their JSON path, and read as absent, so that one pass over the file finds every problem.
//! Unknown properties are left alone, as glTF demands.

use serde_json::Value;

use super::report::Report;

/// What to do about a value that breaks the format's rules.
const FIX_EXPORT: &str = "export the file again, or check it with the glTF validator";

/// A JSON value, its path, and where its problems go.
#[derive(Clone)]
pub(super) struct Json<'a> {
    value: &'a Value,
    place: String,
    report: &'a Report,
}

impl<'a> Json<'a> {
    /// The root of the file.
    pub(super) fn root(value: &'a Value, report: &'a Report) -> Json<'a> {
        Json { value, place: String::new(), report }
    }

    /// The JSON path, for messages.
    pub(super) fn place(&self) -> &str {
        &self.place
    }

    /// The path of a member.
    pub(super) fn place_of(&self, key: &str) -> String {
        if self.place.is_empty() { key.to_owned() } else { format!("{}.{key}", self.place) }
    }

    /// Where problems go.
    pub(super) fn report(&self) -> &'a Report {
        self.report
    }

    /// The bare value.
    pub(super) fn value(&self) -> &'a Value {
        self.value
    }

    /// Reports a broken rule here.
    pub(super) fn error(&self, code: &'static str, problem: impl std::fmt::Display) {
        self.report.error(code, &self.place, problem, FIX_EXPORT);
    }

    /// Reports a broken rule at a member.
    pub(super) fn error_at(&self, key: &str, code: &'static str, problem: impl std::fmt::Display) {
        self.report.error(code, self.place_of(key), problem, FIX_EXPORT);
    }

    /// Reports something odd at a member.
    pub(super) fn warning_at(&self, key: &str, code: &'static str, problem: impl std::fmt::Display) {
        self.report.warning(code, self.place_of(key), problem, "");
    }

    /// Whether the member is there.
    pub(super) fn has(&self, key: &str) -> bool {
        self.value.get(key).is_some()
    }

    /// A member of any type.
    pub(super) fn get(&self, key: &str) -> Option<Json<'a>> {
        Some(Json { value: self.value.get(key)?, place: self.place_of(key), report: self.report })
    }

    /// A member that is an object.
    pub(super) fn object(&self, key: &str) -> Option<Json<'a>> {
        let member = self.get(key)?;
        if member.value.is_object() { Some(member) } else { member.wrong_type("an object") }
    }

    /// A member of `extensions`.
    pub(super) fn extension(&self, name: &str) -> Option<Json<'a>> {
        self.object("extensions")?.object(name)
    }

    /// The members of an object member, in the order of the file; none if it is absent.
    pub(super) fn members(&self, key: &str) -> Vec<(&'a str, Json<'a>)> {
        let Some(member) = self.object(key) else { return Vec::new() };
        let Some(map) = member.value.as_object() else { return Vec::new() };
        map.iter().map(|(name, value)| (name.as_str(), Json { value, place: member.place_of(name), report: self.report })).collect()
    }

    /// The elements of an array member, of any type; none if it is absent.
    pub(super) fn list(&self, key: &str) -> Vec<Json<'a>> {
        let Some(member) = self.get(key) else { return Vec::new() };
        let Some(elements) = member.value.as_array() else {
            member.wrong_type::<()>("an array");
            return Vec::new();
        };
        let at = |index: usize| format!("{}[{index}]", member.place);
        elements.iter().enumerate().map(|(index, value)| Json { value, place: at(index), report: self.report }).collect()
    }

    /// The elements of an array of objects. An element of another type is reported, and stays in the list, where it reads as empty.
    pub(super) fn objects(&self, key: &str) -> Vec<Json<'a>> {
        let elements = self.list(key);
        for element in &elements {
            if !element.value.is_object() {
                element.wrong_type::<()>("an object");
            }
        }
        elements
    }

    /// A text member.
    pub(super) fn text(&self, key: &str) -> Option<&'a str> {
        let member = self.get(key)?;
        member.value.as_str().or_else(|| member.wrong_type("a string"))
    }

    /// The `name` member, or `{kind} {index}`.
    pub(super) fn name_or(&self, kind: &str, index: usize) -> String {
        match self.text("name") {
            Some(name) if !name.is_empty() => name.to_owned(),
            _ => format!("{kind} {index}"),
        }
    }

    /// A boolean member.
    pub(super) fn boolean(&self, key: &str) -> Option<bool> {
        let member = self.get(key)?;
        member.value.as_bool().or_else(|| member.wrong_type("true or false"))
    }

    /// A whole number of at least 0. A number with a zero fraction counts as whole, as in JSON schema.
    pub(super) fn count(&self, key: &str) -> Option<u64> {
        self.get(key)?.as_count()
    }

    /// This value as a whole number of at least 0.
    pub(super) fn as_count(&self) -> Option<u64> {
        let whole = self.value.as_u64().or_else(|| {
            let number = self.value.as_f64()?;
            // Above 2^53 a float no longer names one integer.
            (number >= 0.0 && number.fract() == 0.0 && number <= 9_007_199_254_740_992.0).then_some(number as u64)
        });
        whole.or_else(|| self.wrong_type("a whole number of at least 0"))
    }

    /// A whole number that must be there.
    pub(super) fn required_count(&self, key: &str) -> Option<u64> {
        self.required(key)?.as_count()
    }

    /// A number member, finite in 32 bits.
    pub(super) fn number(&self, key: &str) -> Option<f32> {
        self.get(key)?.as_number()
    }

    /// This value as a number that is finite in 32 bits.
    pub(super) fn as_number(&self) -> Option<f32> {
        let Some(number) = self.value.as_f64() else { return self.wrong_type("a number") };
        let small = number as f32;
        if small.is_finite() {
            return Some(small);
        }
        self.error("gltf::number-range", format_args!("{number:e} does not fit a 32-bit float"));
        None
    }

    /// An array member of exactly `N` numbers.
    pub(super) fn numbers<const N: usize>(&self, key: &str) -> Option<[f32; N]> {
        let elements = self.get(key).map(|_| self.list(key))?;
        if elements.len() != N {
            if self.value.get(key).is_some_and(Value::is_array) {
                self.error_at(key, "gltf::number-count", format_args!("expected {N} numbers, found {}", elements.len()));
            }
            return None;
        }
        let mut out = [0.0; N];
        for (slot, element) in out.iter_mut().zip(&elements) {
            *slot = element.as_number()?;
        }
        Some(out)
    }

    /// A reference to element 0 to `count - 1` of the array `what`.
    pub(super) fn index(&self, key: &str, what: &str, count: usize) -> Option<usize> {
        self.get(key)?.as_index(what, count)
    }

    /// A reference that must be there.
    pub(super) fn required_index(&self, key: &str, what: &str, count: usize) -> Option<usize> {
        self.required(key)?.as_index(what, count)
    }

    /// This value as a reference to an element of the array `what`.
    pub(super) fn as_index(&self, what: &str, count: usize) -> Option<usize> {
        let index = self.as_count()?;
        match usize::try_from(index) {
            Ok(index) if index < count => Some(index),
            _ => {
                self.error("gltf::index-out-of-range", format_args!("refers to {what}[{index}], but the file has {count} {what}"));
                None
            }
        }
    }

    /// A member that must be there.
    pub(super) fn required(&self, key: &str) -> Option<Json<'a>> {
        let member = self.get(key);
        // What is no object was reported where it was read.
        if member.is_none() && self.value.is_object() {
            self.error_at(key, "gltf::missing-property", "is missing");
        }
        member
    }

    fn wrong_type<T>(&self, expected: &str) -> Option<T> {
        self.error("gltf::wrong-type", format_args!("expected {expected}, found {}", shown(self.value)));
        None
    }
}

/// A short form of a value for messages.
fn shown(value: &Value) -> String {
    match value {
        Value::Array(elements) => format!("an array of {}", elements.len()),
        Value::Object(_) => "an object".to_owned(),
        Value::String(text) => format!("the string `{}`", clip(text)),
        other => other.to_string(),
    }
}

/// A text that is short enough for a message.
pub(super) fn clip(text: &str) -> String {
    const LONGEST: usize = 60;
    if text.chars().count() <= LONGEST {
        return text.escape_debug().to_string();
    }
    let start: String = text.chars().take(LONGEST).collect();
    format!("{}...", start.escape_debug())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrong_values_are_reported_with_their_path() {
        let value: Value = serde_json::from_str(r#"{"a": [{"n": -1, "f": 1e39, "i": 7, "w": 2.0, "v": [1, 2]}]}"#).unwrap();
        let report = Report::new("x.gltf");
        let root = Json::root(&value, &report);
        let element = root.objects("a").remove(0);
        assert_eq!(element.count("n"), None);
        assert_eq!(element.number("f"), None);
        assert_eq!(element.index("i", "nodes", 3), None);
        assert_eq!(element.count("w"), Some(2));
        assert_eq!(element.numbers::<3>("v"), None);
        let errors = report.finish().unwrap_err();
        let messages: Vec<&str> = errors.iter().map(|error| error.message.as_str()).collect();
        assert_eq!(
            messages,
            [
                "x.gltf: a[0].n: expected a whole number of at least 0, found -1",
                "x.gltf: a[0].f: 1e39 does not fit a 32-bit float",
                "x.gltf: a[0].i: refers to nodes[7], but the file has 3 nodes",
                "x.gltf: a[0].v: expected 3 numbers, found 2",
            ]
        );
    }
}
