//! From text to tokens, each with its place.
//!
//! White space, comments, words and punctuation are here; `literal.rs` and `number.rs` read the rest. A token that is not RON
//! is reported here and becomes [`TokenKind::Bad`], so that the parser does not report it again. Time is linear in the text.

use std::borrow::Cow;

use unicode_ident::{is_xid_continue, is_xid_start};

use crate::source::Span;

use super::error::{Problems, SyntaxError};
use super::number::{Number, parse_number};

/// The three kinds of brackets.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Bracket {
    Round,
    Square,
    Curly,
}

impl Bracket {
    pub(super) fn opener(self) -> char {
        match self {
            Bracket::Round => '(',
            Bracket::Square => '[',
            Bracket::Curly => '{',
        }
    }

    pub(super) fn closer(self) -> char {
        match self {
            Bracket::Round => ')',
            Bracket::Square => ']',
            Bracket::Curly => '}',
        }
    }
}

/// What a token is.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum TokenKind<'a> {
    Open(Bracket),
    Close(Bracket),
    Comma,
    Colon,
    Equals,
    Hash,
    Bang,
    /// `..`, `..=`.
    Dots {
        inclusive: bool,
    },
    /// An identifier or a keyword; `raw` if it was written `r#word`.
    Word {
        text: &'a str,
        raw: bool,
    },
    Str(Cow<'a, str>),
    Bytes(Cow<'a, [u8]>),
    Char(char),
    Number(Number),
    /// Reported already.
    Bad,
    /// The end of the text.
    End,
}

/// A token and its place, in bytes.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Token<'a> {
    pub(super) kind: TokenKind<'a>,
    pub(super) start: usize,
    pub(super) end: usize,
}

/// Reads tokens one by one.
#[derive(Debug)]
pub(super) struct Lexer<'a> {
    text: &'a str,
    /// The next byte; always at the border of a character.
    pub(super) position: usize,
    pub(super) problems: Problems,
}

/// What RON takes for white space.
fn is_space(char: char) -> bool {
    matches!(char, ' ' | '\t' | '\n' | '\r' | '\u{b}' | '\u{c}' | '\u{85}' | '\u{200e}' | '\u{200f}' | '\u{2028}' | '\u{2029}')
}

fn is_raw_identifier_char(char: char) -> bool {
    matches!(char, '.' | '+' | '-') || is_xid_continue(char)
}

impl<'a> Lexer<'a> {
    /// At the start of a text.
    pub(super) fn new(text: &'a str, problems: Problems) -> Lexer<'a> {
        let mut lexer = Lexer { text, position: 0, problems };
        if lexer.take("\u{feff}") {
            lexer.report(0, lexer.position, &SyntaxError::ByteOrderMark);
        }
        lexer
    }

    /// What has not been read.
    pub(super) fn rest(&self) -> &'a str {
        self.text.get(self.position..).unwrap_or("")
    }

    /// The text between two places.
    fn slice(&self, start: usize, end: usize) -> &'a str {
        self.text.get(start..end).unwrap_or("")
    }

    /// The next character.
    pub(super) fn peek(&self) -> Option<char> {
        self.rest().chars().next()
    }

    /// Reads past `expected` if it comes next.
    pub(super) fn take(&mut self, expected: &str) -> bool {
        let found = self.rest().starts_with(expected);
        if found {
            self.position += expected.len();
        }
        found
    }

    /// Reports a problem between two places.
    pub(super) fn report(&mut self, start: usize, end: usize, error: &SyntaxError) {
        let span = self.problems.span(start, end);
        self.problems.report(span, error);
    }

    /// Reports something that runs to the end of the text, which leaves nothing more to read.
    pub(super) fn never_closed(&mut self, start: usize, error: &SyntaxError) {
        let span = self.problems.span(start, self.line_end(start));
        self.problems.report_last(span, error);
        self.position = self.text.len();
    }

    /// The next token; [`TokenKind::End`] for ever after the last one, or once nothing more is reported.
    pub(super) fn next_token(&mut self) -> Token<'a> {
        self.skip_space();
        if self.problems.is_stopped() {
            self.position = self.text.len();
        }
        let start = self.position;
        let kind = self.peek().map_or(TokenKind::End, |first| self.token(first, start));
        Token { kind, start, end: self.position }
    }

    fn token(&mut self, first: char, start: usize) -> TokenKind<'a> {
        let single = match first {
            '(' => TokenKind::Open(Bracket::Round),
            '[' => TokenKind::Open(Bracket::Square),
            '{' => TokenKind::Open(Bracket::Curly),
            ')' => TokenKind::Close(Bracket::Round),
            ']' => TokenKind::Close(Bracket::Square),
            '}' => TokenKind::Close(Bracket::Curly),
            ',' => TokenKind::Comma,
            ':' => TokenKind::Colon,
            '=' => TokenKind::Equals,
            '#' => TokenKind::Hash,
            '!' => TokenKind::Bang,
            '"' => return self.string(start),
            '\'' => return self.char(start),
            '.' if self.take("..=") => return TokenKind::Dots { inclusive: true },
            '.' if self.take("..") => return TokenKind::Dots { inclusive: false },
            '0'..='9' | '+' | '-' | '.' => return self.number(start),
            _ if first == '_' || is_xid_start(first) => return self.word(start),
            _ => {
                self.position += first.len_utf8();
                self.report(start, self.position, &SyntaxError::UnexpectedCharacter(first));
                return TokenKind::Bad;
            }
        };
        self.position += 1;
        single
    }

    /// A word, or a literal with a prefix of letters.
    fn word(&mut self, start: usize) -> TokenKind<'a> {
        let rest = self.rest();
        let begins = |prefix: &str| rest.starts_with(prefix);
        if begins("b\"") {
            self.position += 1;
            return self.byte_string(start);
        }
        if begins("b'") {
            self.position += 1;
            return self.byte(start);
        }
        if begins("br\"") || begins("br#") {
            self.position += 2;
            return self.raw_byte_string(start);
        }
        if let Some(behind) = rest.strip_prefix("r#")
            && let length = behind.find(|char| !is_raw_identifier_char(char)).unwrap_or(behind.len())
            && length > 0
        {
            self.position += 2 + length;
            return TokenKind::Word { text: self.slice(start + 2, self.position), raw: true };
        }
        if begins("r\"") || begins("r#") {
            self.position += 1;
            return self.raw_string(start);
        }
        let text = rest.find(|char| !is_xid_continue(char)).and_then(|length| rest.get(..length)).unwrap_or(rest);
        self.position += text.len();
        let next = self.peek();
        if next.is_some_and(is_raw_identifier_char) && !self.rest().starts_with("..") {
            let rest = self.rest();
            self.position += rest.find(|char| !is_raw_identifier_char(char)).unwrap_or(rest.len());
            let whole = self.slice(start, self.position);
            self.report(start, self.position, &SyntaxError::BadIdentifier(whole.to_owned()));
            return TokenKind::Word { text: whole, raw: false };
        }
        TokenKind::Word { text, raw: false }
    }

    /// The longest run of characters that could be meant as a number, so that a slip in it is one problem.
    fn number(&mut self, start: usize) -> TokenKind<'a> {
        let rest = self.rest();
        let mut end = 0;
        let mut previous = '\0';
        let mut chars = rest.char_indices().peekable();
        while let Some((index, char)) = chars.next() {
            let next = chars.peek().map(|(_, char)| *char);
            let belongs = match char {
                '.' => next != Some('.'),
                '+' | '-' => index == 0 || (matches!(previous, 'e' | 'E') && !is_based(rest)),
                _ => is_xid_continue(char),
            };
            if !belongs {
                break;
            }
            end = index + char.len_utf8();
            // An underscore may stand between an exponent's letter and its sign.
            previous = if char == '_' { previous } else { char };
        }
        // A sign or a dot alone is taken, too, so that reading goes on.
        self.position += end.max(1);
        let word = self.slice(start, self.position);
        match parse_number(word) {
            Ok(number) => TokenKind::Number(number),
            Err(error) => {
                self.report(start, self.position, &error);
                TokenKind::Bad
            }
        }
    }

    fn skip_space(&mut self) {
        loop {
            let rest = self.rest();
            self.position += rest.find(|char| !is_space(char)).unwrap_or(rest.len());
            if self.take("//") {
                let rest = self.rest();
                self.position += rest.find('\n').unwrap_or(rest.len());
            } else if self.rest().starts_with("/*") {
                self.block_comment();
            } else {
                return;
            }
        }
    }

    fn block_comment(&mut self) {
        let start = self.position;
        self.position += 2;
        let mut depth = 1usize;
        while depth > 0 {
            let rest = self.rest();
            let Some(next) = rest.find(['/', '*']) else {
                self.never_closed(start, &SyntaxError::UnclosedComment);
                return;
            };
            self.position += next;
            if self.take("/*") {
                depth += 1;
            } else if self.take("*/") {
                depth -= 1;
            } else {
                self.position += 1;
            }
        }
    }

    /// The place of a token.
    pub(super) fn span(&self, token: &Token<'_>) -> Span {
        self.problems.span(token.start, token.end)
    }

    /// Where the line of a place ends.
    pub(super) fn line_end(&self, start: usize) -> usize {
        start + self.slice(start, self.text.len()).lines().next().unwrap_or("").len()
    }

    /// Whether a token spans lines.
    pub(super) fn spans_lines(&self, token: &Token<'_>) -> bool {
        self.slice(token.start, token.end).contains('\n')
    }
}

/// Whether a number has a prefix such as `0x`, in which `e` is a digit.
fn is_based(text: &str) -> bool {
    let text = text.strip_prefix(['+', '-']).unwrap_or(text);
    ["0x", "0b", "0o"].iter().any(|prefix| text.starts_with(prefix))
}

/// A token for messages.
pub(super) fn describe(kind: &TokenKind<'_>) -> String {
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
