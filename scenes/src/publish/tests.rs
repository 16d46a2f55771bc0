//! Tests of publishing as a whole.
