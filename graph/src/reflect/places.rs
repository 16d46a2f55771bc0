//! Where the names of a shader stand: what naga's module does not keep.
//!
//! Reads the tokens of a text that naga has parsed already, so its shape is known to be right, and only the outermost level
//! is looked at. Where something is not found all the same, the answer is `None` and a message has one place less.

use std::collections::HashMap;
use std::ops::Range;

use super::text::JoinedText;
use super::tokens::{Token, TokenKind, scan};
use crate::source::Span;

/// A name, with the attributes before it (`@group(0)`).
#[derive(Debug, Clone, Default, PartialEq, Eq)]
struct Named {
    /// The name.
    name: String,
    /// Where it stands.
    range: Range<usize>,
    /// Each attribute's name and whole range.
    attributes: Vec<(String, Range<usize>)>,
}

/// A function or struct: its name and its parameters or members.
#[derive(Debug, Clone, Default)]
struct Item {
    /// Its own name.
    named: Named,
    /// Parameters or members, in order.
    parts: Vec<Named>,
    /// Of functions: from the arrow to before the body.
    result: Range<usize>,
}

/// Every outermost name of a text.
#[derive(Debug)]
pub(super) struct Places<'a> {
    joined: &'a JoinedText,
    functions: HashMap<String, Item>,
    structs: HashMap<String, Item>,
    /// `var`, `override`, `const` and `alias`: WGSL has one scope for all.
    values: HashMap<String, Named>,
}

impl Places<'_> {
    /// Where a function's name stands.
    pub(super) fn function_span(&self, function: &str) -> Span {
        self.span(self.functions.get(function).map(|item| &item.named.range))
    }

    /// Where a function's name stands in the joined text; after everything where it is not found.
    pub(super) fn function_order(&self, function: &str) -> usize {
        self.functions.get(function).map_or(usize::MAX, |item| item.named.range.start)
    }

    /// Where a parameter's name stands.
    pub(super) fn parameter_span(&self, function: &str, index: usize) -> Span {
        self.span(self.functions.get(function).and_then(|item| item.parts.get(index)).map(|part| &part.range))
    }

    /// Where the result of a function is declared.
    pub(super) fn result_span(&self, function: &str) -> Span {
        self.span(self.functions.get(function).map(|item| &item.result))
    }

    /// Where a member's name stands.
    pub(super) fn member_span(&self, structure: &str, index: usize) -> Span {
        self.span(self.structs.get(structure).and_then(|item| item.parts.get(index)).map(|part| &part.range))
    }

    /// Where the name of a variable, override or constant stands.
    pub(super) fn value_span(&self, name: &str) -> Span {
        self.span(self.values.get(name).map(|named| &named.range))
    }

    /// Where the name of a variable, override or constant stands in the joined text; after everything where it is not found.
    pub(super) fn value_order(&self, name: &str) -> usize {
        self.values.get(name).map_or(usize::MAX, |named| named.range.start)
    }

    /// The attributes of a variable whose names are among these, with the place of the first.
    pub(super) fn value_attributes(&self, name: &str, wanted: &[&str]) -> Option<(Vec<&str>, Span)> {
        let named = self.values.get(name)?;
        let found: Vec<_> = named.attributes.iter().filter(|(attribute, _)| wanted.contains(&attribute.as_str())).collect();
        let range = &found.first()?.1;
        Some((found.iter().map(|(attribute, _)| attribute.as_str()).collect(), self.joined.locate(range.clone())))
    }

    /// The place of something that naga knows the place of.
    pub(super) fn naga_span(&self, span: naga::Span) -> Span {
        self.joined.locate_naga(span).unwrap_or_default()
    }

    fn span(&self, range: Option<&Range<usize>>) -> Span {
        range.map_or(Span::NOWHERE, |range| self.joined.locate(range.clone()))
    }

    /// Reads the names of a text.
    pub(super) fn of(joined: &JoinedText) -> Places<'_> {
        let tokens = scan(joined.as_str()).tokens;
        let mut places = Places { joined, functions: HashMap::new(), structs: HashMap::new(), values: HashMap::new() };
        let mut reader = Reader { source: joined.as_str(), tokens: &tokens, at: 0 };
        while reader.at < tokens.len() {
            let attributes = reader.attributes();
            let keyword = reader.take_word();
            match keyword {
                Some("fn") => {
                    if let Some(item) = reader.function(attributes) {
                        places.functions.entry(item.named.name.clone()).or_insert(item);
                    }
                }
                Some("struct") => {
                    if let Some(item) = reader.structure(attributes) {
                        places.structs.entry(item.named.name.clone()).or_insert(item);
                    }
                }
                Some("var" | "override" | "const" | "alias") => {
                    reader.skip_template();
                    if let Some(named) = reader.name(attributes) {
                        places.values.entry(named.name.clone()).or_insert(named);
                    }
                    reader.skip_past(';');
                }
                Some("enable" | "requires" | "diagnostic" | "const_assert") => reader.skip_past(';'),
                _ => reader.at += 1,
            }
        }
        places
    }
}

/// Walks over tokens.
struct Reader<'a> {
    source: &'a str,
    tokens: &'a [Token],
    at: usize,
}

impl<'a> Reader<'a> {
    fn peek(&self) -> Option<&'a Token> {
        self.tokens.get(self.at)
    }

    fn at_mark(&self, mark: char) -> bool {
        self.peek().is_some_and(|token| token.is(mark))
    }

    /// The next token's text, if it is a word; it is consumed then.
    fn take_word(&mut self) -> Option<&'a str> {
        let token = self.peek().filter(|token| token.kind == TokenKind::Word)?;
        self.at += 1;
        Some(token.text(self.source))
    }

    /// The next word as a name.
    fn name(&mut self, attributes: Vec<(String, Range<usize>)>) -> Option<Named> {
        let range = self.peek()?.range.clone();
        let name = self.take_word()?.to_owned();
        Some(Named { name, range, attributes })
    }

    /// Any number of `@name` and `@name(...)`.
    fn attributes(&mut self) -> Vec<(String, Range<usize>)> {
        let mut found = Vec::new();
        while let Some(start) = self.peek().filter(|token| token.is('@')).map(|token| token.range.start) {
            self.at += 1;
            let Some(name) = self.take_word() else { break };
            if self.at_mark('(') {
                self.skip_group();
            }
            found.push((name.to_owned(), start..self.end_of_last()));
        }
        found
    }

    /// The end of the token before.
    fn end_of_last(&self) -> usize {
        self.at.checked_sub(1).and_then(|last| self.tokens.get(last)).map_or(0, |token| token.range.end)
    }

    /// From an opening bracket to after its partner. Texts are balanced, so counting all kinds together is enough.
    fn skip_group(&mut self) {
        let mut depth = 0_usize;
        while let Some(token) = self.peek() {
            self.at += 1;
            match token.kind {
                TokenKind::Mark('(' | '[' | '{') => depth += 1,
                TokenKind::Mark(')' | ']' | '}') => depth = depth.saturating_sub(1),
                _ => {}
            }
            if depth == 0 {
                return;
            }
        }
    }

    /// `<storage, read_write>` after `var`.
    fn skip_template(&mut self) {
        if self.at_mark('<') {
            self.skip_past('>');
        }
    }

    /// After the next such mark outside of brackets.
    fn skip_past(&mut self, mark: char) {
        while let Some(token) = self.peek() {
            if token.is(mark) {
                self.at += 1;
                return;
            }
            self.skip_group();
        }
    }

    /// Parameters or members up to the closing bracket, which is consumed: `@a name: type,` with commas inside of `<>` passed over.
    fn parts(&mut self, close: char) -> Vec<Named> {
        let mut parts = Vec::new();
        self.at += 1;
        while self.peek().is_some() && !self.at_mark(close) {
            let attributes = self.attributes();
            parts.extend(self.name(attributes));
            let mut angles = 0_usize;
            while let Some(token) = self.peek() {
                match token.kind {
                    TokenKind::Mark(mark) if mark == close => break,
                    TokenKind::Mark(',') if angles == 0 => {
                        self.at += 1;
                        break;
                    }
                    TokenKind::Mark('<') => angles += 1,
                    TokenKind::Mark('>') => angles = angles.saturating_sub(1),
                    _ => {}
                }
                self.skip_group();
            }
        }
        self.at += 1;
        parts
    }

    fn function(&mut self, attributes: Vec<(String, Range<usize>)>) -> Option<Item> {
        let named = self.name(attributes)?;
        let parts = if self.at_mark('(') { self.parts(')') } else { Vec::new() };
        let start = self.peek().map_or(0, |token| token.range.start);
        while self.peek().is_some() && !self.at_mark('{') {
            self.skip_group();
        }
        let result = start..self.end_of_last().max(start);
        self.skip_group();
        Some(Item { named, parts, result })
    }

    fn structure(&mut self, attributes: Vec<(String, Range<usize>)>) -> Option<Item> {
        let named = self.name(attributes)?;
        let parts = if self.at_mark('{') { self.parts('}') } else { Vec::new() };
        Some(Item { named, parts, result: 0..0 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::SourceMap;

    #[test]
    fn finds_every_outermost_name() {
        let source = "
            @id(3) override count: u32 = 4 * (2 + 1);
            @group(0) @binding(1 + 1) var<storage, read_write> cells: array<vec4<f32>, 7>;
            struct Light { @align(16) direction: vec3<f32>, weights: array<f32, 4>, @size(32) last: mat2x2<f32>, }
            var<private> hidden = array<i32, 2>(1, 2);
            @compute @workgroup_size(8, 8) fn main(@builtin(global_invocation_id) id: vec3<u32>, b: array<f32, 3>) -> f32 {
                var local = 1; struct_like(local);
            }
            fn last() {}
        ";
        let mut sources = SourceMap::default();
        let file = sources.add("x", source);
        let mut joined = JoinedText::default();
        joined.push(file, source, 0..source.len(), &[]);
        let places = Places::of(&joined);
        let at = |span| sources.text(span).to_owned();
        assert_eq!(at(places.value_span("count")), "count");
        let (attributes, span) = places.value_attributes("cells", &["group", "binding"]).unwrap();
        assert_eq!((attributes, at(span)), (vec!["group", "binding"], "@group(0)".to_owned()));
        assert!(places.value_attributes("hidden", &["group"]).is_none());
        assert_eq!(places.value_span("local"), Span::NOWHERE);
        assert_eq!([0, 1, 2, 3].map(|index| at(places.member_span("Light", index))), ["direction", "weights", "last", ""]);
        assert_eq!([0, 1, 2].map(|index| at(places.parameter_span("main", index))), ["id", "b", ""]);
        assert_eq!(at(places.result_span("main")), "-> f32");
        assert_eq!(at(places.function_span("last")), "last");
        assert!(places.value_order("count") < places.value_order("hidden"));
    }
}
