//! Optimizers beside peers: numbers that LKH (`elkai` 2), pymoo 0.6 and pycma 4 printed for the same problems.

mod evolution;
mod families;
mod fronts;
mod programs;
mod tours;
mod warm;
