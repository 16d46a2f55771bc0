//! Tests of scene files.
