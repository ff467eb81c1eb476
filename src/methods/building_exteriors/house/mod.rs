//! Houses from attributes.

mod database;

pub use database::{Database, DatabaseError};
