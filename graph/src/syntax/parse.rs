//! From tokens to a tree.
//!
//! The grammar is that of the `ron` crate (0.12). Every problem is collected: after one, reading goes on behind the next comma
//! or before the closing bracket of the place, and what is skipped is not reported. Recursion is bounded by
//! [`MAX_DEPTH`]; deeper text is skipped without recursion.
//!
//! Accepted downside: the two extensions that would change what a text means (`unwrap_variant_newtypes`,
//! `explicit_struct_names`) are refused.

use std::collections::VecDeque;

use crate::diagnostic::Diagnostic;
use crate::source::{FileId, Span};

use super::duplicates::{report_duplicate_fields, report_duplicate_keys};
use super::error::{MAX_BYTES, Problems, SyntaxError};
use super::lex::{Bracket, Lexer, Token, TokenKind};
use super::number::{Number, special_float};
use super::tree::{Entry, Field, MAX_DEPTH, Name, Node, Range, Value};

/// Reads a RON text into a tree.
///
/// # Errors
/// Every problem of the text, in its order: slips of the grammar, numbers that no type holds, duplicate keys and fields,
/// nesting beyond [`MAX_DEPTH`], more than [`MAX_BYTES`] bytes.
pub fn parse(text: &str, file: FileId) -> Result<Node, Vec<Diagnostic>> {
    if text.len() > MAX_BYTES {
        return Err(vec![SyntaxError::TooLarge { bytes: text.len() }.diagnostic(Span::new(file, 0, 0))]);
    }
    let mut parser = Parser::new(text, file);
    let root = parser.document();
    let problems = parser.lexer.problems;
    match root {
        Some(root) if problems.is_empty() => Ok(root),
        _ => Err(problems.into_sorted()),
    }
}

/// A bracketed sequence, as far as it could be read.
struct Brackets<T> {
    items: Vec<T>,
    end: usize,
}

/// What a bracketed sequence consists of.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Items {
    Values,
    Entries,
    Fields,
}

impl Items {
    fn name(self) -> &'static str {
        match self {
            Items::Values => "values",
            Items::Entries => "the entries of a map",
            Items::Fields => "the fields of a struct",
        }
    }
}

/// Where skipping ends, unless a closing bracket of the current sequence comes first.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Until {
    Comma,
    Closer,
    /// Behind the bracket that matches the opening one at the start.
    Group,
}

pub(super) struct Parser<'a> {
    pub(super) lexer: Lexer<'a>,
    pub(super) current: Token<'a>,
    ahead: VecDeque<Token<'a>>,
    /// The token before the current one, for places between tokens.
    pub(super) previous_end: usize,
    /// Whether the token before was a string over several lines, and where it starts.
    previous_long_string: Option<Span>,
    open: Vec<(Bracket, Span)>,
    /// How many of each kind are open, so that a closing bracket is judged without a search.
    open_of_kind: [usize; 3],
}

impl<'a> Parser<'a> {
    fn new(text: &'a str, file: FileId) -> Parser<'a> {
        let mut lexer = Lexer::new(text, Problems::new(file));
        let current = lexer.next_token();
        Parser {
            lexer,
            current,
            ahead: VecDeque::new(),
            previous_end: 0,
            previous_long_string: None,
            open: Vec::new(),
            open_of_kind: [0; 3],
        }
    }

    // Tokens.

    pub(super) fn advance(&mut self) -> Token<'a> {
        let next = self.ahead.pop_front().unwrap_or_else(|| self.lexer.next_token());
        let token = std::mem::replace(&mut self.current, next);
        self.previous_end = token.end;
        let long = matches!(token.kind, TokenKind::Str(_)) && self.lexer.spans_lines(&token);
        self.previous_long_string = long.then(|| self.lexer.span(&token));
        token
    }

    /// A token behind the current one.
    fn peek(&mut self, index: usize) -> &TokenKind<'a> {
        while self.ahead.len() <= index {
            let token = self.lexer.next_token();
            self.ahead.push_back(token);
        }
        self.ahead.get(index).map_or(&TokenKind::End, |token| &token.kind)
    }

    pub(super) fn span(&self) -> Span {
        self.lexer.span(&self.current)
    }

    pub(super) fn span_from(&self, start: usize) -> Span {
        self.lexer.problems.span(start, self.previous_end)
    }

    pub(super) fn report(&mut self, span: Span, error: &SyntaxError) {
        self.check_runaway_string();
        self.lexer.problems.report(span, error);
    }

    /// An odd quote turns the text inside out from there on: strings become words and words strings. It shows as a string over
    /// several lines with text right behind its closing quote, and nothing from its start on can be judged.
    fn check_runaway_string(&mut self) {
        if let Some(string) = self.previous_long_string
            && self.current.start == self.previous_end
            && matches!(self.current.kind, TokenKind::Word { .. } | TokenKind::Number(_) | TokenKind::Bad | TokenKind::Str(_))
        {
            let quote = self.lexer.problems.span(self.previous_end.saturating_sub(1), self.previous_end);
            let line = Span { end: self.lexer.line_end(string.start as usize) as u32, ..string };
            self.lexer.problems.forget_from(string);
            self.lexer.problems.report_last(line, &SyntaxError::RunawayString { end: quote });
        }
    }

    pub(super) fn unexpected(&mut self, expected: &'static str) {
        if self.current.kind != TokenKind::Bad {
            let found = describe(&self.current.kind);
            self.report(self.span(), &SyntaxError::Unexpected { expected, found });
        }
    }

    // The document.

    fn document(&mut self) -> Option<Node> {
        self.attributes();
        let root = self.value();
        match self.current.kind {
            TokenKind::End => {}
            // The message about the value says enough.
            _ if root.is_none() && !self.lexer.problems.is_empty() => {}
            TokenKind::Close(bracket) => self.report(self.span(), &SyntaxError::StrayCloser(bracket.closer())),
            TokenKind::Bad => {}
            _ => self.report(self.span(), &SyntaxError::TrailingText),
        }
        root
    }

    // Values.

    /// A value, or `None` after a report. A comma or closing bracket in its place is left to the caller.
    fn value(&mut self) -> Option<Node> {
        let start = self.current.start;
        let value = match self.current.kind {
            TokenKind::Open(Bracket::Square) => {
                let list = self.brackets(Bracket::Square, Items::Values, |parser, _| parser.value())?;
                return Some(self.node(start, list.end, Value::List(list.items)));
            }
            TokenKind::Open(Bracket::Curly) => {
                let map = self.brackets(Bracket::Curly, Items::Entries, |parser, _| parser.entry())?;
                report_duplicate_keys(&map.items, &mut self.lexer.problems);
                return Some(self.node(start, map.end, Value::Map(map.items)));
            }
            TokenKind::Open(Bracket::Round) => return self.round(None, start),
            TokenKind::Word { text, raw } => return self.word_value(text, raw),
            TokenKind::Number(number) => {
                self.advance();
                return self.maybe_range(start, number);
            }
            TokenKind::Dots { .. } => return self.range(start, None),
            TokenKind::Str(_) | TokenKind::Bytes(_) | TokenKind::Char(_) => match self.advance().kind {
                TokenKind::Str(text) => Value::Str(text.into()),
                TokenKind::Bytes(bytes) => Value::Bytes(bytes.into()),
                TokenKind::Char(char) => Value::Char(char),
                _ => return None,
            },
            TokenKind::Bad => {
                self.advance();
                return None;
            }
            _ => {
                self.unexpected("a value");
                return None;
            }
        };
        Some(self.node(start, self.previous_end, value))
    }

    fn node(&self, start: usize, end: usize, value: Value) -> Node {
        Node { span: self.lexer.problems.span(start, end), value }
    }

    /// A word with or without content behind it.
    fn word_value(&mut self, text: &str, raw: bool) -> Option<Node> {
        let token = self.advance();
        let start = token.start;
        let value = match text {
            "true" if !raw => Value::Bool(true),
            "false" if !raw => Value::Bool(false),
            _ => {
                if !raw && let Some(float) = special_float(text, false) {
                    return self.maybe_range(start, Number::Float(float));
                }
                let name = Name { text: text.into(), span: self.lexer.span(&token), raw };
                if self.current.kind == TokenKind::Open(Bracket::Round) {
                    return self.round(Some(name), start);
                }
                Value::Word(name)
            }
        };
        Some(self.node(start, token.end, value))
    }

    /// A number, and the range that it may start. Nothing may stand between a number and the dots.
    fn maybe_range(&mut self, start: usize, number: Number) -> Option<Node> {
        let end = self.previous_end;
        let node = self.node(start, end, number_value(number));
        match self.current.kind {
            TokenKind::Dots { .. } if self.current.start == end => self.range(start, Some(node)),
            _ => Some(node),
        }
    }

    /// The current token is the dots.
    fn range(&mut self, start: usize, lower: Option<Node>) -> Option<Node> {
        let inclusive = self.advance().kind == TokenKind::Dots { inclusive: true };
        let adjacent = self.current.start == self.previous_end;
        let bound = match self.current.kind {
            TokenKind::Number(number) if adjacent => Some(number),
            TokenKind::Word { text, raw: false } if adjacent => special_float(text, false).map(Number::Float),
            _ => None,
        };
        let upper = bound.map(|number| {
            let token = self.advance();
            self.node(token.start, token.end, number_value(number))
        });
        if inclusive && upper.is_none() {
            self.unexpected("a number right behind `..=`");
            return None;
        }
        Some(self.node(start, self.previous_end, Value::Range(Box::new(Range { start: lower, end: upper, inclusive }))))
    }

    /// `(...)` behind an optional name: `()`, a tuple or a struct.
    fn round(&mut self, name: Option<Name>, start: usize) -> Option<Node> {
        let open_end = self.current.end;
        if self.is_struct() {
            let fields = self.brackets(Bracket::Round, Items::Fields, |parser, _| parser.field())?;
            report_duplicate_fields(&fields.items, &mut self.lexer.problems);
            return Some(self.node(start, fields.end, Value::Struct { name, fields: fields.items }));
        }
        let tuple = self.brackets(Bracket::Round, Items::Values, |parser, rest| {
            let value = parser.value();
            if parser.current.kind == TokenKind::Colon && value.is_some() {
                parser.report(parser.span(), &SyntaxError::NamedField);
                // Which of the two was meant is unknown, so the rest can't be judged.
                *rest = false;
                return None;
            }
            value
        })?;
        let value = match (name, tuple.end == open_end + 1) {
            (None, true) if tuple.items.is_empty() => Value::Unit,
            (name, _) => Value::Tuple { name, items: tuple.items },
        };
        Some(self.node(start, tuple.end, value))
    }

    /// Whether what follows the opening bracket are fields, or was meant to be.
    fn is_struct(&mut self) -> bool {
        let second = self.peek(1).clone();
        match self.peek(0) {
            TokenKind::Word { .. } => matches!(
                second,
                TokenKind::Colon
                    | TokenKind::Equals
                    | TokenKind::Word { .. }
                    | TokenKind::Str(_)
                    | TokenKind::Number(_)
                    | TokenKind::Char(_)
                    | TokenKind::Open(Bracket::Square | Bracket::Curly)
            ),
            TokenKind::Str(_) => second == TokenKind::Colon,
            _ => false,
        }
    }

    fn field(&mut self) -> Option<Field> {
        let start = self.current.start;
        let name = match &self.current.kind {
            TokenKind::Word { text, raw } => Some(Name { text: (*text).into(), span: self.span(), raw: *raw }),
            TokenKind::Str(text) => {
                let error = SyntaxError::QuotedField(text.as_ref().to_owned());
                let is_field = *self.peek(0) == TokenKind::Colon;
                self.report(self.span(), if is_field { &error } else { &SyntaxError::UnnamedField });
                if !is_field {
                    return None;
                }
                None
            }
            TokenKind::Bad => {
                self.advance();
                return None;
            }
            _ => {
                self.report(self.span(), &SyntaxError::UnnamedField);
                return None;
            }
        };
        self.advance();
        self.colon("field name", start)?;
        let value = self.value()?;
        Some(Field { name: name?, value })
    }

    fn entry(&mut self) -> Option<Entry> {
        let start = self.current.start;
        let key = self.value();
        if key.is_none() && self.current.kind != TokenKind::Colon {
            return None;
        }
        self.colon("key", start)?;
        let value = self.value()?;
        Some(Entry { key: key?, value })
    }

    /// The colon between a key and a value. Where another sign or nothing stands in its place and a value follows, reading
    /// goes on.
    fn colon(&mut self, key: &'static str, start: usize) -> Option<()> {
        match self.current.kind {
            TokenKind::Colon => {
                self.advance();
                return Some(());
            }
            TokenKind::Bad => {
                self.check_runaway_string();
                return None;
            }
            _ => {}
        }
        let starts_value = matches!(
            self.current.kind,
            TokenKind::Open(_)
                | TokenKind::Word { .. }
                | TokenKind::Str(_)
                | TokenKind::Number(_)
                | TokenKind::Char(_)
                | TokenKind::Bytes(_)
        );
        let span = match self.current.kind {
            TokenKind::Equals => self.span(),
            _ if starts_value => self.lexer.problems.span(self.previous_end, self.previous_end),
            _ => self.span_from(start),
        };
        self.report(span, &SyntaxError::MissingColon { key });
        if self.current.kind == TokenKind::Equals {
            self.advance();
            return Some(());
        }
        starts_value.then_some(())
    }

    // Brackets.

    /// Reads a bracketed, comma-separated sequence. The current token is the opening bracket. `item` may set its flag to false
    /// to have the rest skipped.
    fn brackets<T>(
        &mut self,
        bracket: Bracket,
        kind: Items,
        mut item: impl FnMut(&mut Self, &mut bool) -> Option<T>,
    ) -> Option<Brackets<T>> {
        if self.open.len() >= MAX_DEPTH {
            self.report(self.span(), &SyntaxError::TooDeep);
            self.skip(Until::Group);
            return None;
        }
        self.push_open(bracket);
        let mut items = Vec::new();
        let mut go_on = true;
        let mut comma_reported = false;
        let end = loop {
            match self.current.kind {
                TokenKind::Close(closer) if closer == bracket => break self.advance().end,
                TokenKind::Close(closer) => {
                    if self.count(closer) > 0 {
                        self.report_unclosed(bracket, closer);
                        break self.previous_end;
                    }
                    self.report(self.span(), &SyntaxError::StrayCloser(closer.closer()));
                    self.advance();
                }
                TokenKind::End => {
                    self.report_unclosed_at_end();
                    break self.previous_end;
                }
                TokenKind::Comma => {
                    self.unexpected("a value");
                    self.advance();
                }
                _ => match item(self, &mut go_on) {
                    Some(value) => {
                        items.push(value);
                        self.separator(kind, &mut comma_reported);
                    }
                    None if go_on => self.skip_item(),
                    None => self.skip(Until::Closer),
                },
            }
        };
        self.pop_open();
        Some(Brackets { items, end })
    }

    /// What follows an item. A sequence that is written without commas gets one message.
    fn separator(&mut self, kind: Items, comma_reported: &mut bool) {
        match self.current.kind {
            TokenKind::Comma => {
                self.advance();
            }
            TokenKind::Close(_) | TokenKind::End => {}
            TokenKind::Bad => {
                self.check_runaway_string();
                self.skip_item();
            }
            TokenKind::Colon | TokenKind::Equals | TokenKind::Hash | TokenKind::Bang => {
                self.unexpected("`,` or a closing bracket");
                self.skip_item();
            }
            _ => {
                if !std::mem::replace(comma_reported, true) {
                    let span = self.lexer.problems.span(self.previous_end, self.previous_end);
                    self.report(span, &SyntaxError::MissingComma(kind.name()));
                }
                if kind != Items::Values && *self.peek(0) != TokenKind::Colon {
                    self.skip_item();
                }
            }
        }
    }

    /// Skips what is left of a failed item, and the comma behind it.
    fn skip_item(&mut self) {
        self.skip(Until::Comma);
        if self.current.kind == TokenKind::Comma {
            self.advance();
        }
    }

    /// Skips without reporting anything. Ends before the closing bracket of the current sequence at the latest.
    fn skip(&mut self, until: Until) {
        let base = self.open.len();
        let base_of_kind = self.open_of_kind;
        let was_muted = std::mem::replace(&mut self.lexer.problems.muted, true);
        loop {
            match self.current.kind {
                TokenKind::End => break,
                TokenKind::Comma if until == Until::Comma && self.open.len() == base => break,
                TokenKind::Open(bracket) => {
                    self.push_open(bracket);
                    continue;
                }
                TokenKind::Close(bracket) => {
                    if self.count(bracket) > base_of_kind.get(bracket as usize).copied().unwrap_or(0) {
                        while self.open.last().is_some_and(|(last, _)| *last != bracket) {
                            self.pop_open();
                        }
                        self.pop_open();
                        if until == Until::Group && self.open.len() == base {
                            self.advance();
                            break;
                        }
                    } else if self.count(bracket) > 0 {
                        while self.open.len() > base {
                            self.pop_open();
                        }
                        break;
                    }
                }
                _ => {}
            }
            self.advance();
        }
        self.lexer.problems.muted = was_muted;
    }

    /// Reads the opening bracket.
    fn push_open(&mut self, bracket: Bracket) {
        self.open.push((bracket, self.span()));
        if let Some(count) = self.open_of_kind.get_mut(bracket as usize) {
            *count += 1;
        }
        self.advance();
    }

    fn pop_open(&mut self) {
        if let Some((bracket, _)) = self.open.pop()
            && let Some(count) = self.open_of_kind.get_mut(bracket as usize)
        {
            *count = count.saturating_sub(1);
        }
    }

    /// How many brackets of a kind are open.
    fn count(&self, bracket: Bracket) -> usize {
        self.open_of_kind.get(bracket as usize).copied().unwrap_or(0)
    }

    fn report_unclosed(&mut self, bracket: Bracket, closer: Bracket) {
        if let Some((_, span)) = self.open.last().copied() {
            let error = SyntaxError::Unclosed(bracket.opener(), Some((closer.closer(), self.span())), Vec::new());
            self.report(span, &error);
        }
    }

    /// One message for all that is still open at the end.
    fn report_unclosed_at_end(&mut self) {
        const SHOWN: usize = 4;
        if let Some(((bracket, span), others)) = self.open.split_last() {
            let others = others.iter().rev().take(SHOWN).map(|(_, span)| *span).collect();
            let error = SyntaxError::Unclosed(bracket.opener(), None, others);
            self.lexer.problems.report_last(*span, &error);
        }
    }
}

fn number_value(number: Number) -> Value {
    match number {
        Number::Integer(integer) => Value::Integer(integer),
        Number::Float(float) => Value::Float(float),
    }
}

/// A token for messages.
fn describe(kind: &TokenKind<'_>) -> String {
    match kind {
        TokenKind::Open(bracket) => format!("`{}`", bracket.opener()),
        TokenKind::Close(bracket) => format!("`{}`", bracket.closer()),
        TokenKind::Comma => "`,`".to_owned(),
        TokenKind::Colon => "`:`".to_owned(),
        TokenKind::Equals => "`=`".to_owned(),
        TokenKind::Hash => "`#`".to_owned(),
        TokenKind::Bang => "`!`".to_owned(),
        TokenKind::Dots { inclusive: true } => "`..=`".to_owned(),
        TokenKind::Dots { inclusive: false } => "`..`".to_owned(),
        TokenKind::Word { text, .. } => format!("`{text}`"),
        TokenKind::Str(_) => "a string".to_owned(),
        TokenKind::Bytes(_) => "a byte string".to_owned(),
        TokenKind::Char(_) => "a character".to_owned(),
        TokenKind::Number(_) => "a number".to_owned(),
        TokenKind::Bad => "something that is not RON".to_owned(),
        TokenKind::End => "the end of the file".to_owned(),
    }
}
