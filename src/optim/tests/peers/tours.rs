//! Tempering and annealing on tours, beside LKH.

use edifice_base::rng::stream;
use edifice_optim::annealing::{Annealing, Cooling, Landscape};
use edifice_optim::tempering::{Settings, temper, temperatures};
use rand::{Rng, RngExt};

/// A tour through cities of the unit square: a move reverses a stretch between neighbours, or moves a stretch of up to three cities.
#[derive(Clone)]
struct Tour {
    distance: Vec<Vec<f64>>,
    near: Vec<Vec<usize>>,
    tour: Vec<usize>,
    place: Vec<usize>,
    length: f64,
    tried: Option<(usize, usize, f64)>,
}

impl Tour {
    fn new(seed: u64, n: usize) -> Self {
        let mut state = seed * 7919;
        let mut next = || {
            state = (state * 1_103_515_245 + 12345) % 2_147_483_648;
            state as f64 / 2_147_483_648.0
        };
        let cities: Vec<[f64; 2]> = (0..n).map(|_| [next(), next()]).collect();
        let far = |a: &[f64; 2], b: &[f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
        let distance: Vec<Vec<f64>> = cities
            .iter()
            .map(|a| cities.iter().map(|b| far(a, b)).collect())
            .collect();
        let near = distance.iter().enumerate().map(|(i, row)| {
            let mut order: Vec<usize> = (0..n).filter(|j| *j != i).collect();
            order.sort_by(|a, b| row[*a].total_cmp(&row[*b]));
            order.truncate(8);
            order
        });
        let near = near.collect();
        let tour: Vec<usize> = (0..n).collect();
        let length = (0..n).map(|i| distance[i][(i + 1) % n]).sum();
        Self {
            distance,
            near,
            place: tour.clone(),
            tour,
            length,
            tried: None,
        }
    }

    /// Reverses the stretch from place a to place b, around the end where a is after b; the shorter side.
    fn reverse(&mut self, a: usize, b: usize) {
        let n = self.tour.len();
        let inner = (b + n - a) % n + 1;
        let (mut i, mut j, count) = match 2 * inner <= n {
            true => (a, b, inner / 2),
            false => ((b + 1) % n, (a + n - 1) % n, (n - inner) / 2),
        };
        for _ in 0..count {
            self.tour.swap(i, j);
            self.place[self.tour[i]] = i;
            self.place[self.tour[j]] = j;
            i = (i + 1) % n;
            j = (j + n - 1) % n;
        }
    }
}

impl Landscape for Tour {
    type Solution = Vec<usize>;

    fn cost(&self) -> f64 {
        self.tried.map_or(self.length, |t| t.2)
    }

    fn propose<R: Rng>(&mut self, rng: &mut R) -> Option<f64> {
        let n = self.tour.len();
        let a = rng.random_range(0..n);
        let near = &self.near[a];
        let c = near[rng.random_range(0..near.len())];
        // a b .. c d becomes a c .. b d.
        let (pa, pc) = (self.place[a], self.place[c]);
        let (b, d) = (self.tour[(pa + 1) % n], self.tour[(pc + 1) % n]);
        if b == c || d == a {
            return None;
        }
        let far = &self.distance;
        let after = self.length - far[a][b] - far[c][d] + far[a][c] + far[b][d];
        self.tried = Some(((pa + 1) % n, pc, after));
        Some(after)
    }

    fn accept(&mut self) {
        if let Some((a, b, after)) = self.tried.take() {
            self.reverse(a, b);
            self.length = after;
        }
    }

    fn reject(&mut self) {
        self.tried = None;
    }

    fn solution(&self) -> Vec<usize> {
        self.tour.clone()
    }
}

/// Lengths of the tours of LKH through the cities of seeds 1 to 10.
const LKH: [f64; 10] = [
    10.326098255329414,
    10.764584137011488,
    10.843160965227508,
    10.77043138856253,
    10.760736319315887,
    10.613322220197636,
    10.39630936326275,
    10.489237273229241,
    10.925188215067251,
    10.611215082075123,
];

/// A walk over the integers, all of the same cost but for steps of a millionth of a millionth.
#[derive(Clone)]
struct Plain {
    at: i64,
    before: i64,
}

impl Landscape for Plain {
    type Solution = i64;

    fn cost(&self) -> f64 {
        1.0 - 1e-12 * self.at.rem_euclid(7) as f64
    }

    fn propose<R: Rng>(&mut self, rng: &mut R) -> Option<f64> {
        self.before = self.at;
        self.at += rng.random_range(1..=3);
        Some(self.cost())
    }

    fn accept(&mut self) {}

    fn reject(&mut self) {
        self.at = self.before;
    }

    fn solution(&self) -> i64 {
        self.at
    }
}

#[test]
fn rounding_noise_is_no_progress_of_tempering() {
    let settings = Settings {
        rounds: 20,
        temperatures: Some((1.0, 2.0)),
        ..Settings::default()
    };
    let run = temper(&Plain { at: 0, before: 0 }, &settings, 1, |_| {}).unwrap();
    assert_eq!((run.best, run.cost), (0, 1.0));
}

#[test]
fn tempering_finds_tours_near_those_of_lkh() {
    let (mut tempered, mut annealed) = (0.0, 0.0);
    // A few of them, or all where `EDIFICE_ALL_CASES` is set, as in `.ci/full`.
    let count = std::env::var_os("EDIFICE_ALL_CASES").map_or(3, |_| LKH.len());
    for (i, best) in LKH.iter().take(count).enumerate() {
        let tour = Tour::new(i as u64 + 1, 200);
        let settings = Settings {
            rounds: 2000,
            moves: 500,
            ..Settings::default()
        };
        let run = temper(&tour, &settings, 1, |_| {}).unwrap();
        // The tour itself is measured, not the sum of its changes.
        let length: f64 = (0..200)
            .map(|k| tour.distance[run.best[k]][run.best[(k + 1) % 200]])
            .sum();
        assert!((length - run.cost).abs() < 1e-6);
        tempered += (length / best - 1.0) / count as f64;
        let (low, high) = temperatures(tour.clone(), &mut stream(1, "trial", 0));
        let cooling = Cooling {
            start: high,
            end: low,
        };
        let mut own = tour.clone();
        let run = Annealing::new(cooling, 2000, 6000, 1)
            .unwrap()
            .run(&mut own, |_| {})
            .unwrap();
        annealed += (run.cost / best - 1.0) / count as f64;
    }
    println!(
        "mean gap to LKH: tempering {:.2} %, annealing with as many moves {:.2} %",
        100.0 * tempered,
        100.0 * annealed
    );
    assert!(tempered <= 0.01, "{tempered}");
}
