//! From tokens to a tree.
//!
//! The grammar is that of the `ron` crate (0.12). Every problem is collected: after one, reading goes on behind the next comma
//! or before the closing bracket of the place, and what is skipped is not reported. Recursion is bounded by
//! [`MAX_DEPTH`](super::tree::MAX_DEPTH); deeper text is skipped without recursion.
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
use super::sequence::Items;
use super::tree::{Entry, Field, Name, Node, Range, Value};

/// Reads a RON text into a tree.
///
/// # Errors
/// Every problem of the text, in its order: slips of the grammar, numbers that no type holds, duplicate keys and fields,
/// nesting beyond [`MAX_DEPTH`](super::tree::MAX_DEPTH), more than [`MAX_BYTES`] bytes.
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

pub(super) struct Parser<'a> {
    pub(super) lexer: Lexer<'a>,
    pub(super) current: Token<'a>,
    pub(super) ahead: VecDeque<Token<'a>>,
    /// The token before the current one, for places between tokens.
    pub(super) previous_end: usize,
    /// Whether the token before was a string over several lines, and where it starts.
    pub(super) previous_long_string: Option<Span>,
    pub(super) open: Vec<(Bracket, Span)>,
    /// How many of each kind are open, so that a closing bracket is judged without a search.
    pub(super) open_of_kind: [usize; 3],
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
                    return self.round(Some(Box::new(name)), start);
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
    fn round(&mut self, name: Option<Box<Name>>, start: usize) -> Option<Node> {
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
}

fn number_value(number: Number) -> Value {
    match number {
        Number::Integer(integer) => Value::Integer(integer),
        Number::Float(float) => Value::Float(float),
    }
}
