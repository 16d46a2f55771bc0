//! Strings, byte strings, characters and their escapes.
//!
//! A bad escape is reported with its own place and reading goes on behind it, so that one slip costs one message.

use std::borrow::Cow;

use super::error::SyntaxError;
use super::lex::{Lexer, TokenKind};
use super::tree::{Integer, IntegerType};

/// Which escapes a literal may hold.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Escapes {
    /// `\x` bytes must make up UTF-8.
    Text,
    /// One character: `\x` up to 7F.
    Char,
    /// `\x` is any byte.
    Bytes,
}

/// What an escape stands for.
enum Escaped {
    Byte(u8),
    Char(char),
}

impl<'a> Lexer<'a> {
    /// `"..."`; the cursor is on the quote, `start` on the first character of the token.
    pub(super) fn string(&mut self, start: usize) -> TokenKind<'a> {
        match self.quoted(start, Escapes::Text) {
            None => TokenKind::Bad,
            Some(Cow::Borrowed(bytes)) => TokenKind::Str(String::from_utf8_lossy(bytes)),
            // Every escape was checked, so nothing is lost here.
            Some(Cow::Owned(bytes)) => TokenKind::Str(Cow::Owned(String::from_utf8_lossy(&bytes).into_owned())),
        }
    }

    /// `b"..."`; the cursor is on the quote.
    pub(super) fn byte_string(&mut self, start: usize) -> TokenKind<'a> {
        self.quoted(start, Escapes::Bytes).map_or(TokenKind::Bad, TokenKind::Bytes)
    }

    /// `r"..."`, `r#"..."#`; the cursor is behind the `r`.
    pub(super) fn raw_string(&mut self, start: usize) -> TokenKind<'a> {
        self.raw(start).map_or(TokenKind::Bad, |text| TokenKind::Str(Cow::Borrowed(text)))
    }

    /// `br"..."`, `br#"..."#`; the cursor is behind the `r`.
    pub(super) fn raw_byte_string(&mut self, start: usize) -> TokenKind<'a> {
        self.raw(start).map_or(TokenKind::Bad, |text| TokenKind::Bytes(Cow::Borrowed(text.as_bytes())))
    }

    fn raw(&mut self, start: usize) -> Option<&'a str> {
        let hashes = self.rest().bytes().take_while(|byte| *byte == b'#').count();
        self.position += hashes;
        if !self.take("\"") {
            self.report(start, self.position, &SyntaxError::Unexpected { expected: "a raw string or identifier", found: "`#`".to_owned() });
            return None;
        }
        let text = self.rest();
        let mut from = 0;
        while let Some(quote) = text.get(from..).and_then(|rest| rest.find('"')) {
            let end = from + quote;
            let behind = text.get(end + 1..).unwrap_or("").bytes().take(hashes).take_while(|byte| *byte == b'#').count();
            if behind == hashes {
                self.position += end + 1 + hashes;
                return text.get(..end);
            }
            from = end + 1 + behind;
        }
        self.never_closed(start, &SyntaxError::UnclosedString);
        None
    }

    fn quoted(&mut self, start: usize, escapes: Escapes) -> Option<Cow<'a, [u8]>> {
        self.position += 1;
        let mut owned: Option<Vec<u8>> = None;
        loop {
            let rest = self.rest().as_bytes();
            let Some(length) = rest.iter().position(|byte| matches!(byte, b'"' | b'\\')) else {
                self.never_closed(start, &SyntaxError::UnclosedString);
                return None;
            };
            let plain = rest.get(..length).unwrap_or(&[]);
            self.position += length + 1;
            if rest.get(length) == Some(&b'"') {
                return Some(match owned {
                    None => Cow::Borrowed(plain),
                    Some(mut bytes) => {
                        bytes.extend_from_slice(plain);
                        Cow::Owned(bytes)
                    }
                });
            }
            let bytes = owned.get_or_insert_default();
            bytes.extend_from_slice(plain);
            if self.line_continuation() {
                continue;
            }
            match self.escape(escapes) {
                Some(Escaped::Byte(byte)) => bytes.push(byte),
                Some(Escaped::Char(char)) => bytes.extend_from_slice(char.encode_utf8(&mut [0; 4]).as_bytes()),
                None => {}
            }
        }
    }

    /// A backslash at the end of a line joins it with the next; white space between is left out.
    fn line_continuation(&mut self) -> bool {
        if !self.take("\r\n") && !self.take("\n") {
            return false;
        }
        self.position += self.rest().bytes().take_while(|byte| matches!(byte, b' ' | b'\t' | b'\n' | b'\r')).count();
        true
    }

    /// `'a'`; the cursor is on the quote.
    pub(super) fn char(&mut self, start: usize) -> TokenKind<'a> {
        self.position += 1;
        let char = match self.peek() {
            Some('\\') => {
                self.position += 1;
                match self.escape(Escapes::Char) {
                    Some(Escaped::Char(char)) => char,
                    Some(Escaped::Byte(byte)) => char::from(byte),
                    None => return self.end_of_bad_char(),
                }
            }
            Some(char) => {
                self.position += char.len_utf8();
                char
            }
            None => '\0',
        };
        if self.take("'") {
            return TokenKind::Char(char);
        }
        let why = if char == '\'' {
            "a character literal is empty"
        } else {
            "a character literal holds one character; strings have double quotes"
        };
        let kind = self.end_of_bad_char();
        self.report(start, self.position, &SyntaxError::BadChar(why));
        kind
    }

    /// `b'a'`; the cursor is on the quote.
    pub(super) fn byte(&mut self, start: usize) -> TokenKind<'a> {
        self.position += 1;
        let byte = match self.peek() {
            Some('\\') => {
                self.position += 1;
                match self.escape(Escapes::Bytes) {
                    Some(Escaped::Byte(byte)) => Some(byte),
                    Some(Escaped::Char(_)) => None,
                    None => return self.end_of_bad_char(),
                }
            }
            Some(char) => {
                self.position += char.len_utf8();
                u8::try_from(char).ok().filter(u8::is_ascii)
            }
            None => None,
        };
        if let (Some(byte), true) = (byte, self.take("'")) {
            let integer = Integer { negative: false, magnitude: byte.into(), decimal: false, suffix: Some(IntegerType::U8) };
            return TokenKind::Number(super::number::Number::Integer(integer));
        }
        let kind = self.end_of_bad_char();
        self.report(start, self.position, &SyntaxError::BadChar("a byte literal holds one ASCII character"));
        kind
    }

    /// Skips to behind the quote that probably ends a malformed character, if there is one on the line.
    fn end_of_bad_char(&mut self) -> TokenKind<'a> {
        // A short look only: any number of such slips must stay linear.
        let near = self.rest().char_indices().take(16).take_while(|(_, char)| !matches!(char, '\n' | ',' | ')' | ']' | '}'));
        if let Some((quote, _)) = near.into_iter().find(|(_, char)| *char == '\'') {
            self.position += quote + 1;
        }
        TokenKind::Bad
    }

    /// The cursor is behind the backslash.
    fn escape(&mut self, escapes: Escapes) -> Option<Escaped> {
        let start = self.position.saturating_sub(1);
        let result = self.escape_value(escapes);
        match result {
            Ok(escaped) => Some(escaped),
            Err(why) => {
                self.report(start, self.position, &SyntaxError::BadEscape(why));
                None
            }
        }
    }

    fn escape_value(&mut self, escapes: Escapes) -> Result<Escaped, &'static str> {
        const UNKNOWN: &str = "unknown escape in a literal";
        let Some(letter) = self.peek() else { return Err(UNKNOWN) };
        self.position += letter.len_utf8();
        Ok(match letter {
            '\'' => Escaped::Byte(b'\''),
            '"' => Escaped::Byte(b'"'),
            '\\' => Escaped::Byte(b'\\'),
            'n' => Escaped::Byte(b'\n'),
            'r' => Escaped::Byte(b'\r'),
            't' => Escaped::Byte(b'\t'),
            '0' => Escaped::Byte(0),
            'x' => self.byte_escape(escapes)?,
            'u' => Escaped::Char(self.unicode_escape()?),
            _ => return Err(UNKNOWN),
        })
    }

    fn hex_digits(&mut self) -> Result<u8, &'static str> {
        let byte = self.rest().get(..2).filter(|digits| digits.bytes().all(|digit| digit.is_ascii_hexdigit()));
        let byte = byte.and_then(|digits| u8::from_str_radix(digits, 16).ok()).ok_or(r"the escape `\x` needs two hexadecimal digits")?;
        self.position += 2;
        Ok(byte)
    }

    fn byte_escape(&mut self, escapes: Escapes) -> Result<Escaped, &'static str> {
        let first = self.hex_digits()?;
        if first.is_ascii() || escapes == Escapes::Bytes {
            return Ok(Escaped::Byte(first));
        }
        if escapes == Escapes::Char {
            return Err(r"the escape `\x` of a character goes up to 7F");
        }
        // Several byte escapes may spell one character.
        let mut bytes = vec![first];
        while bytes.len() < 4 && self.take(r"\x") {
            bytes.push(self.hex_digits()?);
            if let Some(char) = std::str::from_utf8(&bytes).ok().and_then(|text| text.chars().next()) {
                return Ok(Escaped::Char(char));
            }
        }
        Err("these byte escapes are not UTF-8")
    }

    fn unicode_escape(&mut self) -> Result<char, &'static str> {
        const SHAPE: &str = r"a Unicode escape is `\u{` with 1 to 6 hexadecimal digits and `}`";
        if !self.take("{") {
            return Err(SHAPE);
        }
        let digits = self.rest().bytes().take(6).take_while(u8::is_ascii_hexdigit).count();
        let value = self.rest().get(..digits).and_then(|digits| u32::from_str_radix(digits, 16).ok()).ok_or(SHAPE)?;
        self.position += digits;
        if !self.take("}") {
            return Err(SHAPE);
        }
        char::from_u32(value).ok_or("this code is not a Unicode character")
    }
}
