//! The sweep file: what is varied, over which instances and seeds.

mod arms;
mod file;
mod place;

pub use arms::{Arm, arms};
pub use file::{Definition, ReportOptions, TaskOptions, read};
pub use place::nearest;
