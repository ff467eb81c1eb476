//! The sweep file: what is varied, over which instances and seeds.

mod arms;
mod file;
mod task;

pub use arms::{Arm, arms};
pub use edifice_frame::place::{nearest, suggestion};
pub use file::{Definition, ReportOptions, read};
pub use task::TaskOptions;
