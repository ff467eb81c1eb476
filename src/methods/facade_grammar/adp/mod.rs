//! Grammar inference by approximate dynamic programming (Sec. 4).

pub(super) mod candidates;
pub(super) mod exploitation;
pub(super) mod exploration;
pub(super) mod feasible_candidates;
pub(super) mod line_costs;
pub(super) mod priced_candidates;
pub(super) mod protection;
pub(super) mod readings;
pub(super) mod search;
pub(super) mod symmetry;
pub(super) mod value_estimates;
pub(super) mod walk;
