pub mod interface;
use crate::{diagnostic::*, published::*, source::*};
pub fn reflect(_: &str, _: Span, _: &dyn Files, _: &PublishedSchema, _: &mut SourceMap) -> Result<interface::Shader, Vec<Diagnostic>> {
    Err(vec![])
}
