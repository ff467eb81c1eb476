//! Bytes to values and back: every file format of facades and grammars.
//!
//! Readers check everything at the door and name the file and the place of what is wrong. Writers
//! go through [`write_atomic`], so that a failed run leaves nothing half-written.

mod atomic;
pub mod facade_json;
pub mod grammar_json;

pub use atomic::{read_bytes, write_atomic};
