//! Approximate dynamic programming on a process of one's own: stairs, climbed one or three steps at a time.
//! `cargo run --example optim_adp --no-default-features`

use edifice::optim::adp::{Adp, Approximation, Epsilon, Heuristic, Process};
use edifice_base::unwatched;
use rand::{Rng, RngExt};

/// Ten steps; to land on an odd one costs twice.
struct Stairs;

impl Process for Stairs {
    type State = usize;
    type Action = usize;

    fn initial(&self) -> usize {
        0
    }
    fn is_final(&self, step: &usize) -> bool {
        *step >= 10
    }
    fn cost(&self, step: &usize, stride: &usize) -> f64 {
        if (step + stride) % 2 == 1 { 2.0 } else { 1.0 }
    }
    fn apply(&self, step: &mut usize, stride: &usize) {
        *step += stride;
    }
}

struct Coin;
impl Heuristic<Stairs> for Coin {
    fn sample<R: Rng>(&mut self, _: &mut Stairs, _: &usize, rng: &mut R) -> usize {
        if rng.random::<bool>() { 1 } else { 3 }
    }
}

/// The least cost from each step on that a walk has shown.
struct Table([f64; 13]);

impl Approximation<Stairs> for Table {
    fn best(&mut self, stairs: &mut Stairs, step: &usize) -> Option<usize> {
        let value = |stride: &usize| stairs.cost(step, stride) + self.0[step + stride];
        Some(if value(&1) <= value(&3) { 1 } else { 3 })
    }
    fn learn(&mut self, _: &mut Stairs, walk: &[usize], costs: &[f64]) {
        let mut step = 0;
        for (i, stride) in walk.iter().enumerate() {
            self.0[step] = self.0[step].min(costs[i..].iter().sum());
            step += stride;
        }
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let dear = |step| if step >= 10 { 0.0 } else { 100.0 };
    let table = Table(std::array::from_fn(dear));
    let run = Adp::new(Coin, table, Epsilon::default(), 500, 7).run(&mut Stairs, &unwatched)?;
    println!("strides {:?}, cost {}", run.best, run.cost);
    assert_eq!(run.cost, 6.0);
    Ok(())
}
