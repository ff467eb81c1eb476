//! Generic optimizers: annealing on a problem of one's own, and a projection.
//! `cargo run --example optim --no-default-features`

use edifice::optim::annealing::{Annealing, Cooling, Landscape};
use edifice::optim::projection::BoundedSimplex;
use edifice_base::unwatched;
use rand::{Rng, RngExt};

/// Floors of a house in some order; neighbours should differ little in height.
struct Floors {
    heights: Vec<f64>,
    swapped: (usize, usize),
}

impl Landscape for Floors {
    type Solution = Vec<f64>;

    fn cost(&self) -> f64 {
        self.heights.windows(2).map(|w| (w[0] - w[1]).abs()).sum()
    }
    fn propose<R: Rng>(&mut self, rng: &mut R) -> Option<f64> {
        let n = self.heights.len();
        self.swapped = (rng.random_range(0..n), rng.random_range(0..n));
        self.heights.swap(self.swapped.0, self.swapped.1);
        Some(self.cost())
    }
    fn accept(&mut self) {}
    fn reject(&mut self) {
        self.heights.swap(self.swapped.0, self.swapped.1);
    }
    fn solution(&self) -> Vec<f64> {
        self.heights.clone()
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let heights = vec![3.0, 5.0, 2.5, 4.0, 3.5, 2.0, 4.5];
    let mut floors = Floors {
        heights,
        swapped: (0, 0),
    };
    let cooling = Cooling {
        start: 2.0,
        end: 0.01,
    };
    let run = Annealing::new(cooling, 100, 50, 1)?.run(&mut floors, &unwatched)?;
    let rounds = run.trace.len();
    println!(
        "annealing: {:?}, {:?} after {rounds} rounds",
        run.best, run.outcome
    );
    assert_eq!(run.cost, 3.0); // sorted, up or down

    // Four widths that have to fill a wall of 10, none narrower than 1.
    let wall = BoundedSimplex::new(vec![1.0; 4], 10.0, vec![1.0; 4], vec![f64::INFINITY; 4])?;
    let widths = wall.project(&[4.0, 3.0, 0.5, 4.0], &[1.0; 4])?;
    println!("projection: {widths:?}");
    Ok(())
}
