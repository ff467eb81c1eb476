//! A country in tiles: a plan, and workers that go through its tasks.
//!
//! | file of the folder | what |
//! | --- | --- |
//! | `plan.json` | tiles with their digests, settings ([`Plan`]) |
//! | `tiles/` | the tiles, where a city was split |
//! | `work-KEY/` | proposals, claims of tasks, times |
//! | `city-KEY/` | the dictionary, a grammar for each tile, 3D Tiles |
//!
//! KEY is a hash of tiles and settings, so that a changed plan finds nothing of another one. A task is finished when its file is there, which
//! appears whole or not at all; it is claimed by a lock that its process holds and that ends with the process, however it ends. So
//! workers may be started, killed and started again at will, on one machine or on several that share the folder, and the files are the same
//! bytes whatever their number ([`work`]).

mod plan;
mod scene;
mod split;
mod submit;
mod task;
mod tile;
mod work;

pub use plan::{Memory, Options, PLAN, Plan};
pub use submit::{Jobs, slurm, snakefile};
pub use tile::Tile;
pub use work::{Ran, TASKS, work};
