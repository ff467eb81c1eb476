//! The genetic algorithm on a problem of one's own: facade widths that sum to a wall, drawn from a catalogue.
//! `cargo run --example optim_genetic --no-default-features`

use edifice::optim::genetic::{Breed, Genetic, Settings};
use edifice_base::unwatched;
use rand::{Rng, RngExt};

/// Twelve pieces, each one of a catalogue's widths, that should fill a wall.
struct Wall {
    catalogue: Vec<f64>,
    width: f64,
}

impl Breed for Wall {
    type Genome = Vec<usize>;

    fn cost(&mut self, genome: &Vec<usize>) -> f64 {
        let sum: f64 = genome.iter().map(|&piece| self.catalogue[piece]).sum();
        (sum - self.width).abs()
    }
    fn random<R: Rng>(&mut self, rng: &mut R) -> Vec<usize> {
        (0..12)
            .map(|_| rng.random_range(0..self.catalogue.len()))
            .collect()
    }
    fn cross<R: Rng>(&mut self, a: &Vec<usize>, b: &Vec<usize>, rng: &mut R) -> Vec<usize> {
        let cut = rng.random_range(0..a.len());
        a[..cut].iter().chain(&b[cut..]).copied().collect()
    }
    fn mutate<R: Rng>(&mut self, genome: &mut Vec<usize>, rng: &mut R) {
        let at = rng.random_range(0..genome.len());
        genome[at] = rng.random_range(0..self.catalogue.len());
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut wall = Wall {
        catalogue: vec![0.87, 1.13, 1.41, 1.97, 2.39],
        width: 19.33,
    };
    let settings = Settings {
        goal: 0.005,
        ..Settings::default()
    };
    let (run, population) = Genetic::new(settings, Vec::new(), 1)?.run(&mut wall, &unwatched)?;
    println!("{:?}: {:?}, off by {:.4}", run.outcome, run.best, run.cost);
    println!(
        "second best of the last generation: off by {:.4}",
        population[1].1
    );
    assert!(run.cost < 0.05);
    Ok(())
}
