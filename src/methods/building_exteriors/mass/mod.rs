//! Mass models from attributes (Sec. 6.1): boxes whose measured attributes `M_c` are the wanted ones.
//!
//! **`best`**, the default. A *scheme* is a set of boxes whose edges lie on named lines in x and y. The lines
//! of garage and porches follow from their attributes, the outermost lines from the bounding box; the other
//! lines are the variables `p` of
//!
//! ```text
//! minimise  sum_c ((M_c(p) - M*_c) / s_c)^2 + sum_b (2 max(0, 0.6 m - thickness_b(p)))^2
//! ```
//!
//! with `s_c` the standard deviation of column `c` in the database, by Levenberg and Marquardt
//! ([`edifice_optim::least_squares`]). Schemes come from the nearest houses of the database with the same
//! floors, garage and porches (plain and mirrored), then from random arrangements ([`random`]). Beside these stand *plain*
//! plans, whose coverage and boundary are exact by construction (`plain.rs`). Of the sound ones within
//! [`SearchLimits::enough`] the plainest is taken, else the nearest of all; lines are rounded to millimetres.
//!
//! **`paper`** ([`anneal`]): Eq. 3 by simulated annealing, with the paper's moves and three restarts.
//!
//! # Deviations and readings
//! - Eq. 3 divides by the wanted value, which is zero for absent parts and mixes metres with shares: `best`
//!   divides by the standard deviation. `paper` divides as printed, and by the standard deviation where the
//!   wanted value is zero.
//! - Attributes are those of [`super::attributes`], measured on the finished boxes; nothing here computes one.
//! - A model is *sound* when the plan of each floor is nowhere thinner than 0.5 m and touches itself in no single
//!   point, and the ground floor is in one piece without courtyards ([`edifice_shape::Soundness`]).
//! - The height of a floor is no attribute: it is the height over the number of floors with a share above 0.02.
//! - A garage and a porch are one box each.
//! - Without garage and porches the attributes do not tell left from right or front from back: a plan with a corner cut off
//!   and its mirror images have the same. Of 529 houses of Delft, each left out of the donors, the lower quartile of the
//!   intersection over union of built and real plan is 0.73, up to mirroring 0.81; that of the real plans with one of their
//!   four mirror images, drawn at random, garage or not, is 0.79 (`tests/real_data/houses.rs` measures 59 of them).

pub mod anneal;
mod bound;
pub mod contradiction;
mod fit;
pub mod footprint;
mod plain;
pub mod random;
pub mod repair;
mod scheme;
mod search;
pub mod target;
mod variations;

pub use bound::least_z;
pub use scheme::Block;
pub use search::{MassError, MassModel, SearchLimits, nearest, search};
pub use target::{MassTarget, PartTarget};
pub use variations::{iou, variations};

use edifice_shape::{BoxStyle, Building, MassBox, PlanUnion};

/// Number of mass model columns.
pub const MASS: usize = 27;

/// Least thickness of the plan of any floor in metres (Sec. 6.1).
pub const THINNEST: f64 = 0.5;

/// True if the boxes are connected without courtyards, nowhere too thin, on every floor, and garage and porches
/// do not overlap each other.
pub fn is_sound(building: &Building) -> bool {
    let ground = PlanUnion::new(&building.floor_plan(0)).soundness();
    if ground.parts != 1 || ground.courtyard {
        return false;
    }
    for k in 0..building.floors() {
        let floor = PlanUnion::new(&building.floor_plan(k)).soundness();
        if floor.pinches > 0 || floor.thickness < THINNEST - 1e-9 {
            return false;
        }
    }
    let parts: Vec<&MassBox> = building
        .boxes
        .iter()
        .filter(|b| b.style != BoxStyle::Main)
        .collect();
    let apart = |a: &MassBox, b: &MassBox| {
        let (p, q) = (a.plan(), b.plan());
        let x = p.right().min(q.right()) - p.x.max(q.x);
        let y = p.top().min(q.top()) - p.y.max(q.y);
        a.style == b.style || x.min(y) < 1e-6
    };
    let pairs = parts.iter().enumerate();
    pairs
        .flat_map(|(i, a)| parts[i + 1..].iter().map(move |b| (a, b)))
        .all(|(a, b)| apart(a, b))
}

/// The largest distance from the wanted columns in standard deviations.
pub fn max_z(measured: &[f64], wanted: &[f64], deviations: &[f64]) -> f64 {
    let z = measured.iter().zip(wanted).zip(deviations);
    z.map(|((m, w), s)| ((m - w) / s).abs()).fold(0.0, f64::max)
}
