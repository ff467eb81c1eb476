//! Houses: a building with its attributes as one closed surface (Sec. 6.1), and the database it takes from.

mod clearance;
mod database;
mod generate;
pub mod inspect;
pub mod model;
pub mod parts;
mod roof_styles;
pub mod roofs;
pub mod scene;
pub mod solids;
pub mod street;
pub mod walls;
pub mod windows;

pub use database::{Database, DatabaseError};
pub use generate::{
    Draft, Frozen, GenerateError, Generated, HouseReport, Method, Options, Wish, draft, generate,
};
pub use model::{Model, model};
pub use roofs::Joining;
