//! The genetic algorithm on problems whose optimum is known.

use std::time::Duration;

use edifice::optim::genetic::{Breed, Genetic, GeneticError, Population, Settings};
use edifice::optim::{Outcome, Run};
use edifice::rng::stream;
use edifice_base::unwatched;
use rand::{Rng, RngExt};

/// Items of a knapsack as (weight, value); a genome says which are packed.
struct Knapsack {
    items: Vec<(u32, u32)>,
    capacity: u32,
}

impl Knapsack {
    fn draw(seed: u64) -> Self {
        let mut rng = stream(seed, "knapsack", 0);
        let items: Vec<(u32, u32)> = (0..16)
            .map(|_| (rng.random_range(5..60), rng.random_range(5..60)))
            .collect();
        let capacity = items.iter().map(|i| i.0).sum::<u32>() / 2;
        Self { items, capacity }
    }

    fn value(&self, packed: impl Fn(usize) -> bool) -> Option<u32> {
        let chosen = (0..self.items.len()).filter(|i| packed(*i));
        let (weight, value) = chosen.fold((0, 0), |(w, v), i| {
            (w + self.items[i].0, v + self.items[i].1)
        });
        (weight <= self.capacity).then_some(value)
    }

    fn optimum(&self) -> u32 {
        let sets = 0u32..1 << self.items.len();
        sets.filter_map(|set| self.value(|i| set >> i & 1 == 1))
            .max()
            .unwrap()
    }
}

impl Breed for Knapsack {
    type Genome = Vec<bool>;

    fn cost(&mut self, genome: &Vec<bool>) -> f64 {
        self.value(|i| genome[i]).map_or(0.0, |v| -f64::from(v))
    }
    fn random<R: Rng>(&mut self, rng: &mut R) -> Vec<bool> {
        self.items.iter().map(|_| rng.random()).collect()
    }
    fn cross<R: Rng>(&mut self, a: &Vec<bool>, b: &Vec<bool>, rng: &mut R) -> Vec<bool> {
        let pairs = a.iter().zip(b);
        pairs
            .map(|(a, b)| if rng.random() { *a } else { *b })
            .collect()
    }
    fn mutate<R: Rng>(&mut self, genome: &mut Vec<bool>, rng: &mut R) {
        let i = rng.random_range(0..genome.len());
        genome[i] = !genome[i];
    }
}

/// Rastrigin's function in four dimensions: least, 0, at the origin, with a local optimum near every
/// integer point. `map` is applied to the cost.
struct Rastrigin(fn(f64) -> f64);

impl Breed for Rastrigin {
    type Genome = [f64; 4];

    fn cost(&mut self, x: &[f64; 4]) -> f64 {
        let term = |x: &f64| x * x + 10.0 - 10.0 * (std::f64::consts::TAU * x).cos();
        (self.0)(x.iter().map(term).sum())
    }
    fn random<R: Rng>(&mut self, rng: &mut R) -> [f64; 4] {
        std::array::from_fn(|_| rng.random_range(-5.0..5.0))
    }
    fn cross<R: Rng>(&mut self, a: &[f64; 4], b: &[f64; 4], rng: &mut R) -> [f64; 4] {
        std::array::from_fn(|i| if rng.random() { a[i] } else { b[i] })
    }
    fn mutate<R: Rng>(&mut self, x: &mut [f64; 4], rng: &mut R) {
        let scale = 10f64.powf(rng.random_range(-4.0..0.5));
        x[rng.random_range(0..4)] += scale * rng.random_range(-1.0..1.0);
    }
}

type Found<G> = (Run<G>, Population<G>);

fn run<B: Breed>(
    mut breed: B,
    settings: Settings,
    seed: u64,
) -> Result<Found<B::Genome>, GeneticError> {
    Genetic::new(settings, Vec::new(), seed)?.run(&mut breed, &unwatched)
}

#[test]
fn knapsacks_are_packed_as_well_as_by_enumeration() {
    let (mut solved, mut by_chance) = (0, 0);
    for seed in 0..20 {
        let sack = Knapsack::draw(seed);
        let optimum = -f64::from(sack.optimum());
        let (evolved, _) = run(sack, Settings::default(), seed).unwrap();
        assert!(evolved.cost >= optimum, "better than the optimum");
        let mut sack = Knapsack::draw(seed);
        assert_eq!(
            sack.cost(&evolved.best),
            evolved.cost,
            "the cost is the genome's"
        );
        solved += i32::from(evolved.cost == optimum);
        // Random search with as many costs.
        let mut rng = stream(seed, "chance", 0);
        by_chance += i32::from((0..10_000).any(|_| {
            let genome = sack.random(&mut rng);
            sack.cost(&genome) == optimum
        }));
    }
    assert!(solved >= 18 && solved > by_chance, "{solved} {by_chance}");
}

#[test]
fn the_global_optimum_of_many_local_ones_is_found() {
    let settings = Settings {
        generations: 300,
        ..Settings::default()
    };
    for seed in 0..5 {
        let (evolved, population) = run(Rastrigin(|c| c), settings, seed).unwrap();
        assert!(evolved.cost < 1e-4, "seed {seed}: {}", evolved.cost);
        let trace = &evolved.trace;
        assert!(trace.windows(2).all(|w| w[1].best <= w[0].best), "elitism");
        assert_eq!(trace.len(), 300);
        assert_eq!(evolved.outcome, Outcome::MaxIterations);
        assert_eq!(population.len(), 100);
        assert!(population.is_sorted_by(|a, b| a.1 <= b.1));
    }
}

#[test]
fn only_ranks_matter_and_a_seed_repeats() {
    let settings = Settings::default();
    let (plain, _) = run(Rastrigin(|c| c), settings, 3).unwrap();
    let (again, _) = run(Rastrigin(|c| c), settings, 3).unwrap();
    let (scaled, _) = run(Rastrigin(|c| 1e-3 * c + 7.0), settings, 3).unwrap();
    let (other, _) = run(Rastrigin(|c| c), settings, 4).unwrap();
    assert_eq!(plain, again);
    assert_eq!(plain.best, scaled.best);
    assert_ne!(plain.best, other.best);
}

#[test]
fn a_start_is_kept_and_limits_end_a_run() {
    let none = Settings {
        generations: 0,
        population: 3,
        ..Settings::default()
    };
    let start = vec![[0.0; 4], [1.0; 4]];
    let genetic = Genetic::new(none, start.clone(), 1).unwrap();
    let (evolved, population) = genetic.run(&mut Rastrigin(|c| c), &unwatched).unwrap();
    assert_eq!((evolved.best, evolved.cost), ([0.0; 4], 0.0));
    assert!(population.iter().any(|p| p.0 == start[1]));

    let goal = Settings {
        goal: 5.0,
        ..Settings::default()
    };
    let (evolved, _) = run(Rastrigin(|c| c), goal, 1).unwrap();
    assert_eq!(evolved.outcome, Outcome::TargetReached);
    assert!(evolved.cost <= 5.0 && evolved.trace.len() < 100);

    let short = Settings {
        generations: u64::MAX,
        time_limit: Some(Duration::from_millis(20)),
        ..Settings::default()
    };
    let (evolved, _) = run(Rastrigin(|c| c), short, 1).unwrap();
    assert_eq!(evolved.outcome, Outcome::TimeLimit);
}

#[test]
fn costs_that_are_no_numbers_rank_last() {
    let (evolved, _) = run(
        Rastrigin(|c| if c > 40.0 { f64::NAN } else { c }),
        Settings::default(),
        2,
    )
    .unwrap();
    assert!(evolved.cost < 5.0);
    let (evolved, _) = run(Rastrigin(|_| f64::NAN), Settings::default(), 2).unwrap();
    assert_eq!(evolved.cost, f64::INFINITY);
}

#[test]
fn settings_out_of_range_are_named() {
    let fine = Settings::default();
    let bad = [
        (
            "population",
            Settings {
                population: 1,
                ..fine
            },
        ),
        ("elite", Settings { elite: 100, ..fine }),
        (
            "tournament",
            Settings {
                tournament: 0,
                ..fine
            },
        ),
        (
            "crossover",
            Settings {
                crossover: 1.1,
                ..fine
            },
        ),
        (
            "mutation",
            Settings {
                mutation: f64::NAN,
                ..fine
            },
        ),
    ];
    for (name, settings) in bad {
        let refused = Genetic::<()>::new(settings, Vec::new(), 0);
        assert!(
            matches!(refused, Err(GeneticError::Setting { setting, .. }) if setting == name),
            "{name}"
        );
    }
}
