//! The parser's walk through the tokens: what comes next, bracketed sequences, and how reading goes on after a slip.
//!
//! After a problem the rest of the item is skipped, up to the comma or closing bracket that ends it, and nothing in it is
//! reported. Each opening bracket that is never closed is reported where it stands; one message names all that are open at the
//! end. Which kinds of brackets are open is counted, so that no closing bracket costs a search.

use crate::source::Span;

use super::error::SyntaxError;
use super::lex::{Bracket, Token, TokenKind, describe};
use super::parse::Parser;
use super::tree::MAX_DEPTH;

/// A bracketed sequence, as far as it could be read.
pub(super) struct Brackets<T> {
    pub(super) items: Vec<T>,
    pub(super) end: usize,
}

/// What a bracketed sequence consists of.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Items {
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

impl<'a> Parser<'a> {
    pub(super) fn advance(&mut self) -> Token<'a> {
        let next = self.ahead.pop_front().unwrap_or_else(|| self.lexer.next_token());
        let token = std::mem::replace(&mut self.current, next);
        self.previous_end = token.end;
        let long = matches!(token.kind, TokenKind::Str(_)) && self.lexer.spans_lines(&token);
        self.previous_long_string = long.then(|| self.lexer.span(&token));
        token
    }

    /// A token behind the current one.
    pub(super) fn peek(&mut self, index: usize) -> &TokenKind<'a> {
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
    pub(super) fn check_runaway_string(&mut self) {
        if let Some(string) = self.previous_long_string
            && self.current.start == self.previous_end
            && matches!(self.current.kind, TokenKind::Word { .. } | TokenKind::Number(_) | TokenKind::Bad | TokenKind::Str(_))
        {
            let quote = self.lexer.problems.span(self.previous_end.saturating_sub(1), self.previous_end);
            let line = Span { end: self.lexer.line_end(string.start as usize) as u32, ..string };
            self.lexer.problems.replace_from(string, line, &SyntaxError::RunawayString { end: quote });
        }
    }

    pub(super) fn unexpected(&mut self, expected: &'static str) {
        if self.current.kind != TokenKind::Bad {
            let found = describe(&self.current.kind);
            self.report(self.span(), &SyntaxError::Unexpected { expected, found });
        }
    }

    /// Reads a bracketed, comma-separated sequence. The current token is the opening bracket. `item` may set its flag to false
    /// to have the rest skipped.
    pub(super) fn brackets<T>(
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
        // Most sequences are short, and a growing vector makes room for four.
        items.shrink_to_fit();
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
