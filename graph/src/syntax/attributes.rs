//! `#![enable(...)]` and the other attributes that may precede a document.

use super::error::{EXTENSIONS, SyntaxError, UNSUPPORTED_EXTENSIONS};
use super::lex::{Bracket, TokenKind};
use super::parse::Parser;

impl Parser<'_> {
    /// Reads all attributes. `type` and `schema` are for other programs and ignored.
    pub(super) fn attributes(&mut self) {
        while self.current.kind == TokenKind::Hash {
            if self.attribute().is_none() {
                self.skip_attribute();
            }
        }
    }

    fn attribute(&mut self) -> Option<()> {
        self.expect(&TokenKind::Hash, "`#`")?;
        self.expect(&TokenKind::Bang, "`!`, as in `#![enable(implicit_some)]`")?;
        self.expect(&TokenKind::Open(Bracket::Square), "`[`, as in `#![enable(implicit_some)]`")?;
        match self.current.kind {
            TokenKind::Word { text: "enable", raw: false } => {
                self.advance();
                self.expect(&TokenKind::Open(Bracket::Round), "`(` with names of extensions")?;
                self.extensions()?;
                self.expect(&TokenKind::Close(Bracket::Round), "`,` or `)`")?;
            }
            TokenKind::Word { text: "type" | "schema", raw: false } => {
                self.advance();
                self.expect(&TokenKind::Equals, "`=`")?;
                if !matches!(self.current.kind, TokenKind::Str(_)) {
                    self.unexpected("a string");
                    return None;
                }
                self.advance();
            }
            _ => {
                self.unexpected("`enable(..)`, `type = ..` or `schema = ..`");
                return None;
            }
        }
        self.expect(&TokenKind::Close(Bracket::Square), "`]`")
    }

    fn extensions(&mut self) -> Option<()> {
        loop {
            let TokenKind::Word { text, .. } = self.current.kind else {
                self.unexpected("the name of an extension");
                return None;
            };
            if let Some(name) = UNSUPPORTED_EXTENSIONS.iter().find(|name| **name == text) {
                self.report(self.span(), &SyntaxError::UnsupportedExtension(name));
            } else if !EXTENSIONS.contains(&text) {
                self.report(self.span(), &SyntaxError::UnknownExtension(text.to_owned()));
            }
            self.advance();
            if self.current.kind != TokenKind::Comma {
                return Some(());
            }
            self.advance();
            if self.current.kind == TokenKind::Close(Bracket::Round) {
                return Some(());
            }
        }
    }

    fn expect(&mut self, kind: &TokenKind<'_>, name: &'static str) -> Option<()> {
        if self.current.kind != *kind {
            self.unexpected(name);
            return None;
        }
        self.advance();
        Some(())
    }

    /// To behind the bracket that ends a malformed attribute, or to what can't be in one.
    fn skip_attribute(&mut self) {
        loop {
            match self.current.kind {
                TokenKind::Close(Bracket::Square) => {
                    self.advance();
                    return;
                }
                TokenKind::End | TokenKind::Hash | TokenKind::Open(Bracket::Curly) => return,
                _ => {
                    self.advance();
                }
            }
        }
    }
}
