pub mod document;
pub mod spanned;
