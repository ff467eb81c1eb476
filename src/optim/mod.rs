//! optim

pub mod qp;
pub mod qp_problem;
