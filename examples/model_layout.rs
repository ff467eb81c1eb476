//! A facade's layout as a program: what stands at each hidden place is a choice, the score of Fan et al. 2014 (Eq. 15), at a temperature, is a
//! factor, and three samplers are judged by the sum over all layouts.
//! `cargo run --release --example model_layout --no-default-features`

use edifice::methods::structure_completion::layout::{Class, Element, Layout};
use edifice::methods::structure_completion::policy::PaperModel;
use edifice::methods::structure_completion::score::{Change, ScoreModel, Scored};
use edifice::model::program::dist::categorical;
use edifice::model::program::{
    Chains, Handler, Posterior, Program, exact, importance, metropolis, smc,
};
use edifice::shape::Rect;

/// What scores are divided by. The scores of whole layouts differ by tens of nats, so that without it one layout has all the probability, and
/// draws without a direction hardly ever meet it.
const TEMPERATURE: f64 = 10.0;

/// Layouts of a facade of which some windows are seen. At each place is nothing, or one of two windows.
struct Layouts<'a> {
    score: &'a ScoreModel,
    facade: [f64; 2],
    seen: Vec<Element>,
    places: Vec<[Element; 2]>,
}

impl Program for Layouts<'_> {
    /// Number of windows added.
    type Out = usize;

    fn run<H: Handler>(&self, h: &mut H) -> usize {
        let mut layout = Scored::new(self.score, self.facade, self.seen.clone());
        for (i, windows) in self.places.iter().enumerate() {
            let before = layout.score();
            let chosen = h.sample(("place", i), categorical(&[1.0; 3]));
            if let Some(which) = chosen.checked_sub(1) {
                layout.apply(Change::Add(windows[which]));
            }
            // What the layout gains by this choice: the factors add up to its score.
            h.factor(H::Real::from((layout.score() - before) / TEMPERATURE));
        }
        layout.elements().len() - self.seen.len()
    }
}

fn window(floor: usize, x: f64) -> Element {
    let y = 1.0 + 3.2 * floor as f64;
    Element::new(Class::Window, Rect::new(x, y, 1.2, 1.8))
}

/// Floors of windows at equal distances.
fn facade(floors: usize, columns: usize, axis: f64) -> Layout {
    let at = |column: usize| 0.8 + axis * column as f64;
    let row = |floor| (0..columns).map(move |column| window(floor, at(column)));
    Layout {
        name: format!("{floors} x {columns}"),
        width: 2.8 + axis * (columns - 1) as f64,
        height: 3.2 * floors as f64 + 0.5,
        elements: (0..floors).flat_map(row).collect(),
    }
}

/// The mean number of windows added, from the score of every layout laid out at once: shares no code with the engines.
fn by_hand(layouts: &Layouts) -> f64 {
    let count = layouts.places.len();
    let least = Scored::new(layouts.score, layouts.facade, layouts.seen.clone()).score();
    let (mut total, mut windows) = (0.0, 0.0);
    for code in 0..3_usize.pow(count as u32) {
        let mut all = layouts.seen.clone();
        for (i, rivals) in layouts.places.iter().enumerate() {
            if let Some(which) = (code / 3_usize.pow(i as u32) % 3).checked_sub(1) {
                all.push(rivals[which]);
            }
        }
        let added = all.len() - layouts.seen.len();
        let score = Scored::new(layouts.score, layouts.facade, all).score();
        let weight = ((score - least) / TEMPERATURE).exp();
        total += weight;
        windows += weight * added as f64;
    }
    windows / total
}

/// Prints the estimates beside the truth; the largest distance to it in standard errors.
fn beside(name: &str, found: &Posterior<usize>, truth: &Posterior<usize>) -> f64 {
    let all = found.beside(truth);
    let off = all.iter().map(|b| b.error().abs());
    let worst = off.fold(0.0, f64::max);
    let (mean, known) = (
        found.estimate(|d| d.out as f64),
        truth.estimate(|d| d.out as f64).mean,
    );
    println!(
        "{name}: {:.3} +- {:.3} windows added, exactly {known:.3}; probabilities of places off by at most {worst:.4}",
        mean.mean, mean.error
    );
    (mean.mean - known).abs() / mean.error
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let database: Vec<Layout> = (0..12)
        .map(|i| facade(3 + i % 3, 3 + i % 4, 2.2 + 0.1 * (i % 5) as f64))
        .collect();
    let model = PaperModel::of_densities(&database, 1)?;
    let truth = facade(3, 4, 2.5);
    // The two right columns are hidden; a rival of each window stands 0.7 m beside it.
    let (seen, hidden): (Vec<Element>, Vec<Element>) =
        truth.elements.iter().partition(|e| e.rect.x < 5.0);
    let places = hidden.iter().map(|e| {
        let beside = Rect::new(e.rect.x + 0.7, e.rect.y, e.rect.width, e.rect.height);
        [*e, Element::new(Class::Window, beside)]
    });
    let layouts = Layouts {
        score: &model.score,
        facade: [truth.width, truth.height],
        seen,
        places: places.collect(),
    };
    let all = exact(&layouts)?;
    let mean = all.estimate(|d| d.out as f64).mean;
    let known = by_hand(&layouts);
    assert!((mean - known).abs() < 1e-9, "{mean} is not {known}");
    for i in 0..layouts.places.len() {
        let [none, right, beside] = [0, 1, 2].map(|v| all.probability(("place", i), v).mean);
        println!("place {i}: nothing {none:.3}, on the lines {right:.3}, beside {beside:.3}");
    }
    let sampled = importance(&layouts, 4000, 1)?;
    println!(
        "{} layouts; importance sampling: effective {:.0} of 4000",
        all.draws.len(),
        sampled.ess()
    );
    let chains = Chains {
        chains: 4,
        warmup: 500,
        draws: 2000,
        ..Chains::default()
    };
    let errors = [
        beside("importance sampling", &sampled, &all),
        beside("sequential Monte Carlo", &smc(&layouts, 4000, 1)?, &all),
        beside("Metropolis", &metropolis(&layouts, &chains)?, &all),
    ];
    assert!(errors.iter().all(|e| *e < 5.0), "{errors:?}");
    Ok(())
}
