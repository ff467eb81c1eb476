//! Importance sampling of a grammar: split grammars of one facade as weighted draws, `P(grammar) ∝ exp(-cost)` (the cost of Wu et al. 2014, Eq. 1),
//! beside the exact sum over all of them.
//! `cargo run --release --example model_grammar --no-default-features`

use std::collections::HashMap;

use edifice::grammar::{Costs, Grammar, Operation, Rule, Start, Successor, evaluate, listing};
use edifice::model::program::dist::categorical;
use edifice::model::program::{Handler, Program, exact, importance};
use edifice::shape::{Axis, Facade, Rect, Region};

/// Cells of a facade, row by row from below, and their widths and heights in metres.
struct Grammars {
    labels: Vec<Vec<&'static str>>,
    widths: Vec<f64>,
    heights: Vec<f64>,
}

/// Columns and rows of a part: first and after the last.
type Part = [usize; 4];

/// Strips of as many cells each, along an axis; `true` if all are alike and one rule repeats them.
type Cut = (Axis, Vec<usize>, bool);

/// Rules so far, and the symbols of contents that have one.
#[derive(Default)]
struct Written {
    rules: Vec<Rule>,
    symbols: HashMap<String, String>,
    choices: usize,
    cost: f64,
}

impl Grammars {
    fn content(&self, [c0, c1, r0, r1]: Part) -> String {
        let rows: Vec<&[&str]> = (r0..r1).map(|r| &self.labels[r][c0..c1]).collect();
        let (w, h) = (&self.widths[c0..c1], &self.heights[r0..r1]);
        format!("{rows:?} {w:?} {h:?}")
    }

    /// The strips of a cut and their sizes.
    fn strips(&self, [c0, c1, r0, r1]: Part, axis: Axis, counts: &[usize]) -> Vec<(Part, f64)> {
        let mut at = if axis == Axis::X { c0 } else { r0 };
        let strip = |&count: &usize| {
            let from = at;
            at += count;
            match axis {
                Axis::X => ([from, at, r0, r1], self.widths[from..at].iter().sum()),
                Axis::Y => ([c0, c1, from, at], self.heights[from..at].iter().sum()),
            }
        };
        counts.iter().map(strip).collect()
    }

    /// Everything that may be done with a part: cut in two, cut into single strips, repeated.
    fn cuts(&self, part: Part) -> Vec<Cut> {
        let mut all = Vec::new();
        for (axis, n) in [(Axis::X, part[1] - part[0]), (Axis::Y, part[3] - part[2])] {
            all.extend((1..n).map(|i| (axis, vec![i, n - i], false)));
            if n > 2 {
                all.push((axis, vec![1; n], false));
            }
            for period in (1..n).filter(|p| n % p == 0) {
                let counts = vec![period; n / period];
                let strips = self.strips(part, axis, &counts);
                let first = self.content(strips[0].0);
                if strips.iter().all(|(s, _)| self.content(*s) == first) {
                    all.push((axis, counts, true));
                }
            }
        }
        all
    }

    /// The symbol of a part; its rule is chosen where it has none.
    fn symbol<H: Handler>(&self, h: &mut H, part: Part, to: &mut Written) -> String {
        let [c0, c1, r0, r1] = part;
        if (c1 - c0) * (r1 - r0) == 1 {
            return self.labels[r0][c0].to_owned();
        }
        let content = self.content(part);
        if let Some(known) = to.symbols.get(&content) {
            return known.clone();
        }
        let cuts = self.cuts(part);
        let even = vec![H::Real::from(1.0 / cuts.len() as f64); cuts.len()];
        let chosen = h.sample(("rule", to.choices), categorical(&even)) as usize;
        let (axis, counts, repeats) = &cuts[chosen];
        let symbol = format!("Part{}", to.choices);
        to.choices += 1;
        to.symbols.insert(content, symbol.clone());
        let place = to.rules.len();
        let costs = Costs::default();
        let strips = self.strips(part, *axis, counts);
        let used = if *repeats { 1 } else { strips.len() };
        let own = used as f64 + if *repeats { costs.repeat } else { costs.split };
        // Even choices are no preference: each grammar has the weight of its cost alone.
        h.factor(H::Real::from((cuts.len() as f64).ln() - own));
        to.cost += own;
        let successors = Vec::new();
        let axis = *axis;
        let operation = match repeats {
            true => Operation::Repeat { axis, successors },
            false => Operation::Split { axis, successors },
        };
        to.rules.push(Rule {
            symbol: symbol.clone(),
            weight: None,
            operation,
        });
        for (strip, size) in &strips[..used] {
            let next = Successor::new(self.symbol(h, *strip, to), *size);
            if let Operation::Split { successors, .. } | Operation::Repeat { successors, .. } =
                &mut to.rules[place].operation
            {
                successors.push(next);
            }
        }
        symbol
    }

    fn whole(&self) -> Part {
        [0, self.widths.len(), 0, self.heights.len()]
    }
}

impl Program for Grammars {
    type Out = (Vec<Rule>, f64);

    fn run<H: Handler>(&self, h: &mut H) -> Self::Out {
        let mut to = Written::default();
        self.symbol(h, self.whole(), &mut to);
        (to.rules, to.cost)
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let floor = vec!["wall", "window", "wall", "window", "wall"];
    let ground = vec!["wall", "door", "wall", "window", "wall"];
    let model = Grammars {
        labels: vec![ground, floor.clone(), floor],
        widths: vec![2.0, 1.0, 2.0, 1.0, 2.0],
        heights: vec![3.5, 3.0, 3.0],
    };
    let posterior = importance(&model, 20_000, 1)?;
    let truth = exact(&model)?;
    let cost = posterior.estimate(|d| d.out.1);
    let known = truth.estimate(|d| d.out.1).mean;
    println!(
        "20000 weighted grammars: effective {:.0}, Pareto k {:.2}",
        posterior.ess(),
        posterior.pareto_k.unwrap_or(f64::NAN)
    );
    println!(
        "mean cost {:.3} +- {:.3}, exactly {known:.3} of {} ways",
        cost.mean,
        cost.error,
        truth.draws.len()
    );
    if let (Some(found), Some(sum)) = (posterior.evidence, truth.evidence) {
        println!(
            "log sum of exp(-cost) {:.3} +- {:.3}, exactly {:.3}",
            found.log, found.error, sum.log
        );
    }
    // The cheapest draw, judged by the evaluator.
    let best = (posterior.draws.iter()).min_by(|a, b| a.out.1.total_cmp(&b.out.1));
    let (rules, own) = best.map(|d| d.out.clone()).ok_or("no draws")?;
    let (width, height) = (model.widths.iter().sum(), model.heights.iter().sum());
    let grammar = Grammar {
        unit: "m".into(),
        starts: vec![Start {
            name: "house".into(),
            symbol: "Part0".into(),
            width,
            height,
        }],
        rules,
    };
    listing(&grammar, true).iter().for_each(|l| println!("{l}"));
    let mut regions = Vec::new();
    for (row, (strip, h)) in model
        .strips(model.whole(), Axis::Y, &[1; 3])
        .iter()
        .enumerate()
    {
        let y = model.heights[..row].iter().sum();
        for (column, (_, w)) in model.strips(*strip, Axis::X, &[1; 5]).iter().enumerate() {
            let rect = Rect::new(model.widths[..column].iter().sum(), y, *w, *h);
            let label = model.labels[row][column].into();
            regions.push(Region { label, rect });
        }
    }
    let facade = Facade::new("house", "m", width, height, regions)?;
    let judged = evaluate(&grammar, &[facade], &Costs::default())?;
    println!(
        "cost {:.1} of {} rules, judged {:.1}",
        own, judged.rules, judged.cost
    );
    assert!((judged.cost - own).abs() < 1e-9 && (cost.mean - known).abs() < 5.0 * cost.error);
    Ok(())
}
