//! A light scanner of WGSL text: comments out, words, numbers and punctuation in, each with its place.
//!
//! naga keeps no place of struct members, entry points, parameters and attributes, and knows no imports. This scanner finds
//! them. It never fails: what it does not understand becomes punctuation, and naga has the last word on what is valid.

use std::ops::Range;

/// What a token is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum TokenKind {
    /// A keyword or an identifier.
    Word,
    /// A number.
    Number,
    /// Any other character, one at a time.
    Mark(char),
    /// A line whose first character is `#`, whole, without its line break.
    HashLine,
}

/// A token and its byte range.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Token {
    /// What it is.
    pub(super) kind: TokenKind,
    /// Where it stands in the scanned text.
    pub(super) range: Range<usize>,
}

impl Token {
    /// Its text.
    pub(super) fn text<'a>(&self, source: &'a str) -> &'a str {
        source.get(self.range.clone()).unwrap_or("")
    }

    /// Whether it is this punctuation character.
    pub(super) fn is(&self, mark: char) -> bool {
        self.kind == TokenKind::Mark(mark)
    }
}

/// The tokens of a text, and where a block comment starts that never ends.
#[derive(Debug, Clone, Default)]
pub(super) struct Scanned {
    /// In the order of the text.
    pub(super) tokens: Vec<Token>,
    /// The first two characters of a `/*` without its `*/`.
    pub(super) open_comment: Option<Range<usize>>,
}

/// WGSL's line breaks.
fn is_line_break(c: char) -> bool {
    matches!(c, '\u{a}'..='\u{d}' | '\u{85}' | '\u{2028}' | '\u{2029}')
}

/// The first line break at or after `from`, or the end.
fn line_end(source: &str, from: usize) -> usize {
    let rest = source.get(from..).unwrap_or("");
    from + rest.find(is_line_break).unwrap_or(rest.len())
}

/// The end of a block comment that starts at `from`; comments nest.
fn comment_end(source: &str, from: usize) -> Option<usize> {
    let bytes = source.as_bytes();
    let mut depth = 0_usize;
    let mut at = from;
    while let Some(pair) = bytes.get(at..at + 2) {
        match pair {
            b"/*" => (depth, at) = (depth + 1, at + 2),
            b"*/" => (depth, at) = (depth - 1, at + 2),
            _ => at += 1,
        }
        if depth == 0 {
            return Some(at);
        }
    }
    None
}

/// Scans a text.
pub(super) fn scan(source: &str) -> Scanned {
    let mut scanned = Scanned::default();
    let mut at = 0;
    // Nothing but blanks since the last line break.
    let mut line_is_blank = true;
    while let Some((rest, c)) = source.get(at..).and_then(|rest| Some((rest, rest.chars().next()?))) {
        let start = at;
        let kind = if is_line_break(c) {
            line_is_blank = true;
            at += c.len_utf8();
            continue;
        } else if c.is_whitespace() || c == '\u{feff}' {
            at += c.len_utf8();
            continue;
        } else if rest.starts_with("//") {
            at = line_end(source, at);
            continue;
        } else if rest.starts_with("/*") {
            match comment_end(source, at) {
                Some(end) => at = end,
                None => {
                    scanned.open_comment = Some(at..at + 2);
                    break;
                }
            }
            line_is_blank = false;
            continue;
        } else if c == '#' && line_is_blank {
            at = line_end(source, at);
            TokenKind::HashLine
        } else if c == '_' || c.is_alphabetic() {
            at += rest.find(|c: char| c != '_' && !c.is_alphanumeric()).unwrap_or(rest.len());
            TokenKind::Word
        } else if c.is_ascii_digit() {
            at += rest.find(|c: char| c != '.' && !c.is_alphanumeric()).unwrap_or(rest.len());
            TokenKind::Number
        } else {
            at += c.len_utf8();
            TokenKind::Mark(c)
        };
        line_is_blank = false;
        scanned.tokens.push(Token { kind, range: start..at });
    }
    scanned
}

/// The bracket that closes another.
fn closing(open: char) -> Option<char> {
    match open {
        '(' => Some(')'),
        '[' => Some(']'),
        '{' => Some('}'),
        _ => None,
    }
}

/// The first bracket that has no partner in its own file: in a joined text it would be blamed on another file.
pub(super) fn unbalanced(tokens: &[Token]) -> Option<&Token> {
    let mut open: Vec<(&Token, char)> = Vec::new();
    for token in tokens {
        let TokenKind::Mark(mark) = token.kind else { continue };
        if let Some(close) = closing(mark) {
            open.push((token, close));
        } else if matches!(mark, ')' | ']' | '}') {
            match open.pop() {
                Some((_, close)) if close == mark => {}
                // Something further out waits for this one, so what is further in lacks its partner.
                Some((inner, _)) if open.iter().any(|(_, close)| *close == mark) => return Some(inner),
                _ => return Some(token),
            }
        }
    }
    open.pop().map(|(token, _)| token)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(source: &str) -> Vec<&str> {
        scan(source).tokens.iter().map(|token| token.text(source)).collect()
    }

    #[test]
    fn skips_comments_and_keeps_hash_lines() {
        assert_eq!(words("a // b\nc /* d /* e */ f */ g"), ["a", "c", "g"]);
        assert_eq!(words("#import \"x\" // y\nz"), ["#import \"x\" // y", "z"]);
        assert_eq!(words("/* #import \"x\"\n#import \"x\" */ z // #import"), ["z"]);
        assert_eq!(words("größe 1.5e-3f @a"), ["größe", "1.5e", "-", "3f", "@", "a"]);
        assert_eq!(words("x #y"), ["x", "#", "y"]);
        assert_eq!(scan("a /* b").open_comment, Some(2..4));
        assert_eq!(scan("a /*/").open_comment, Some(2..4));
        assert!(scan("").tokens.is_empty());
    }

    #[test]
    fn finds_the_lonely_bracket() {
        let at = |source: &str| unbalanced(&scan(source).tokens).map(|token| token.range.start);
        assert_eq!(at("fn a() { b[0]; }"), None);
        assert_eq!(at("fn a() { b[0; }"), Some(10));
        assert_eq!(at("fn a() { b 0]; }"), Some(12));
        assert_eq!(at("fn a() {"), Some(7));
        assert_eq!(at("fn a() {} }"), Some(10));
    }
}
