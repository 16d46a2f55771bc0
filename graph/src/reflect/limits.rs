//! Limits that keep naga from exhausting the stack.
//!
//! naga follows three things by recursion and without a limit: chains of `else if`, long expressions, and declarations that
//! refer to later ones. Each overflows a stack of 2 MiB at some thousands; the limits here are a fraction of that, and far above
//! what anyone writes. Accepted downside: generated code can meet them.

use std::ops::Range;

use super::tokens::{Token, TokenKind};

/// Blocks inside of blocks, where each `else if` is inside of the one before.
pub(super) const MAX_DEPTH: usize = 250;
/// Tokens without a `;`, `,`, `{` or `}` between them.
pub(super) const MAX_EXPRESSION: usize = 2_000;
/// Outermost declarations of a shader with its imports.
pub(super) const MAX_DECLARATIONS: usize = 4_000;

/// The first place of a file where a limit is passed, and which.
pub(super) fn excess(source: &str, tokens: &[Token]) -> Option<(Range<usize>, String)> {
    // For each open block, the `else if` that were passed in it.
    let mut chains: Vec<usize> = vec![0];
    let mut depth = 0_usize;
    let mut expression = 0_usize;
    for (index, token) in tokens.iter().enumerate() {
        expression += 1;
        let next_is = |word: &str| tokens.get(index + 1).is_some_and(|next| next.text(source) == word);
        match token.kind {
            TokenKind::Mark(';' | ',') => expression = 0,
            TokenKind::Mark('{') => {
                expression = 0;
                depth += 1;
                chains.push(0);
            }
            TokenKind::Mark('}') => {
                expression = 0;
                depth = depth.saturating_sub(1 + chains.pop().unwrap_or(0));
                if !next_is("else")
                    && let Some(chain) = chains.last_mut()
                {
                    depth = depth.saturating_sub(std::mem::take(chain));
                }
            }
            TokenKind::Word if token.text(source) == "else" && next_is("if") => {
                depth += 1;
                if let Some(chain) = chains.last_mut() {
                    *chain += 1;
                }
            }
            _ => {}
        }
        if depth > MAX_DEPTH {
            return Some((token.range.clone(), format!("blocks and `else if` are nested more than {MAX_DEPTH} deep")));
        }
        if expression > MAX_EXPRESSION {
            return Some((token.range.clone(), format!("an expression has more than {MAX_EXPRESSION} tokens")));
        }
    }
    None
}

/// How many declarations a file has on its outermost level.
pub(super) fn declarations(source: &str, tokens: &[Token]) -> usize {
    let mut depth = 0_usize;
    let mut count = 0;
    for token in tokens {
        match token.kind {
            TokenKind::Mark('{' | '(') => depth += 1,
            TokenKind::Mark('}' | ')') => depth = depth.saturating_sub(1),
            TokenKind::Word if depth == 0 => {
                count += usize::from(matches!(token.text(source), "fn" | "struct" | "var" | "const" | "override" | "alias"));
            }
            _ => {}
        }
    }
    count
}

#[cfg(test)]
mod tests {
    use super::super::tokens::scan;
    use super::*;

    fn check(source: &str) -> Option<String> {
        excess(source, &scan(source).tokens).map(|(range, what)| format!("{}: {what}", range.start))
    }

    #[test]
    fn chains_count_as_nesting_and_end() {
        let chain = |count: usize| format!("if (x) {{}} {}", "else if (x) {} ".repeat(count));
        assert_eq!(check(&format!("fn a() {{ {} }}", chain(240))), None);
        assert_eq!(check(&format!("fn a() {{ {}{}{} }}", chain(240), chain(240), chain(240))), None);
        assert!(check(&format!("fn a() {{ {} }}", chain(260))).unwrap().contains("nested"));
        let inner = chain(100);
        let nested = format!("fn a() {{ if (x) {{}} {} else if (x) {{ {inner} }} }}", "else if (x) {} ".repeat(160));
        assert!(check(&nested).unwrap().contains("nested"));
    }

    #[test]
    fn long_expressions_and_many_declarations() {
        assert_eq!(check(&format!("const a = array({});", "1, ".repeat(5_000))), None);
        assert!(check(&format!("const a = 1{};", " + 1".repeat(1_000))).unwrap().contains("tokens"));
        let source = "const a = 1; fn b(x: i32) { var c = 1; } struct D { a: f32 } var<private> e: f32;";
        assert_eq!(declarations(source, &scan(source).tokens), 4);
    }
}
