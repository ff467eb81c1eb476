//! One parametric library for many real facades, beside separate grammars and procedural logic's rules.

use edifice_base::rng::stream;
use edifice_base::{Error, Result};
use edifice_grammar::Costs;
use edifice_grammar::parametric::{Library, Separate, parse_cost};
use edifice_io::read_label_grid;
use edifice_layout::retile::retile;
use edifice_report::{Align, Row, Table};
use edifice_shape::{Facade, decompose};

use super::data::{files, stem};
use super::held_out::HeldOut;
use super::runs::mean;
use super::told_apart::{Fold, area};
use edifice_frame::averages::mean_and_error;
use edifice_frame::{Budget, Context};

/// Folds of the held-out bits.
const FOLDS: usize = 5;

/// Draws that are judged.
const DRAWS: u64 = 500;

/// Draws of other seeds that are told from the same real facades: one alone differs from the next by several hundredths.
const ROUNDS: usize = 5;

/// The share of the area that may become wrong in cleaned Graz.
const CLEANED: f64 = 0.005;

/// The numbers of one set.
struct Measured {
    facades: usize,
    separate: f64,
    cost: f64,
    bound: f64,
    rules: usize,
    seconds: f64,
    alone: f64,
    separate_bits: f64,
    logic_normal: f64,
    logic: f64,
    held_out: f64,
    known_roots: f64,
    new_draws: f64,
    aligned: (f64, f64),
    /// Mean over rounds, and its standard error.
    told_apart: (f64, f64),
}

/// Cost and bits of the library of each real set, and of what it draws.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let mut table = Table::new("One library for all facades of a set")
        .column("set", Align::Left)
        .numbers([
            "facades",
            "separate, sizes fixed",
            "library",
            "no choice of parts costs less",
            "rules",
            "bits alone",
            "bits held out, separate",
            "bits held out, procedural logic",
            "bits held out, its rules in this code",
            "bits held out, library",
            "known structure (%)",
            "draws of new structure (%)",
            "windows aligned, real (%)",
            "windows aligned, drawn (%)",
            "draws told from real (area)",
        ])
        .times(["seconds"]);
    for (name, place, share) in [
        ("ecp2011", "facades/ecp2011/labels", 0.0),
        ("graz50", "facades/graz50/labels", 0.0),
        ("graz50_cleaned", "facades/graz50/labels", CLEANED),
    ] {
        let Some(folder) = ctx.real(place)? else {
            continue;
        };
        let mut paths = files(&folder, ".png")?;
        if ctx.budget() == Budget::Smoke {
            paths.truncate(8);
        }
        let mut facades = Vec::new();
        for path in &paths {
            let mut grid = read_label_grid(path, &Default::default())?;
            grid.name = stem(path, ".png");
            let price = |facade: &Facade| parse_cost(facade, 1.0, &Costs::default());
            facades.push(match share {
                0.0 => {
                    decompose(&grid)
                        .map_err(|e| Error::content(path, e))?
                        .facade
                }
                share => {
                    retile(&grid, None, share, price)
                        .map_err(|e| Error::content(path, e))?
                        .facade
                }
            });
        }
        let measured = measure(&facades, ctx.seed())?;
        tell(ctx, name, &measured);
        table.row([
            name.to_owned(),
            measured.facades.to_string(),
            format!("{:.1}", measured.separate),
            format!("{:.1}", measured.cost),
            format!("{:.1}", measured.bound),
            measured.rules.to_string(),
            format!("{:.1}", measured.alone),
            format!("{:.1}", measured.separate_bits),
            format!("{:.1}", measured.logic_normal),
            format!("{:.1}", measured.logic),
            format!("{:.1}", measured.held_out),
            format!("{:.0}", 100.0 * measured.known_roots),
            format!("{:.0}", 100.0 * measured.new_draws),
            format!("{:.0}", 100.0 * measured.aligned.0),
            format!("{:.0}", 100.0 * measured.aligned.1),
            format!(
                "{:.2} ± {:.2}",
                measured.told_apart.0, measured.told_apart.1
            ),
            format!("{:.1}", measured.seconds),
        ]);
    }
    ctx.table(&table);
    ctx.note(
        "*Library*: Wu's cost of the rules of all facades of a set with sizes and counts as parameters, phrases shared (`grammar infer --sizes free`), \
         and the bound of branch and bound over phrases of at most 14 symbols: it holds for the parse that made the strings. *Separate*: the sum over the facades of \
         the cost of their own parse trees, sizes included and equal regions written once (not the cheapest grammars, which cost less). *Bits*: what a facade costs in an arithmetic code; alone, \
         nothing is known, not even labels; held out, five folds, each code read back and compared. *Library*: the library of the others. *Separate*: a grammar of \
         its own, its rules spelled out, in the same code; labels, the extents of facades and the trust in predictors within one facade are learnt from the others. \
         *Procedural logic* (Weissenberg et al. 2013; the paper gives no code): affinities and rules of the others (parameters for compression), new rules spelled \
         out; each size by a normal distribution of its place in the rule (Sec. 4.4) mixed with all sizes alike, trust learnt from the others. *Its rules in \
         this code*: the same rules, sizes by the library's predictors, the strongest rival: it lacks repeats and counts alone. *Known structure*: held-out facades whose root the library has. Draws: 500; *new* means root and counts that no facade \
         has; *aligned*: all windows lie in columns of common left and right sides. *Told from real*: boosted trees on counts, shares, sizes and gaps of all labels learn \
         four fifths of the real facades and draws from their library, and judge the last fifth and fresh draws: the area under their curve, 0.5 where \
         nothing tells them apart; mean and standard error over five rounds of draws.",
    );
    Ok(())
}

fn tell(ctx: &mut Context, name: &str, measured: &Measured) {
    for (metric, value, unit) in [
        ("separate_cost", measured.separate, ""),
        ("cost", measured.cost, ""),
        ("lower_bound", measured.bound, ""),
        ("rules", measured.rules as f64, ""),
        ("bits_alone", measured.alone, "bits"),
        ("bits_separate", measured.separate_bits, "bits"),
        ("bits_procedural_logic", measured.logic_normal, "bits"),
        ("bits_procedural_logic_rules", measured.logic, "bits"),
        ("bits_held_out", measured.held_out, "bits"),
        ("known_structure", measured.known_roots, ""),
        ("draws_new", measured.new_draws, ""),
        ("aligned_real", measured.aligned.0, ""),
        ("aligned_drawn", measured.aligned.1, ""),
        ("told_apart", measured.told_apart.0, ""),
        ("told_apart_error", measured.told_apart.1, ""),
    ] {
        ctx.observe(Row {
            dataset: name.into(),
            method: "library".into(),
            instance: "all".into(),
            metric: metric.into(),
            value,
            unit: unit.into(),
            ..Row::default()
        });
    }
}

fn measure(facades: &[Facade], seed: u64) -> Result<Measured> {
    let costs = Costs::default();
    let started = std::time::Instant::now();
    let library = Library::learn(facades).map_err(Error::method)?;
    let sharing = library.sharing(&costs);
    let seconds = started.elapsed().as_secs_f64();
    let (mut held_out, mut alone, mut separate) = (HeldOut::default(), Vec::new(), 0.0);
    let code = Separate::new(library.unit().to_owned(), library.step());
    let mut rounds: Vec<Vec<Fold>> = (0..ROUNDS).map(|_| Vec::new()).collect();
    for fold in 0..FOLDS.min(facades.len()) {
        let others = facades
            .iter()
            .enumerate()
            .filter(|(k, _)| k % FOLDS != fold);
        let others: Vec<Facade> = others.map(|(_, facade)| facade.clone()).collect();
        if others.is_empty() {
            continue;
        }
        let told = Library::learn_with_step(&others, library.step()).map_err(Error::method)?;
        let draws = |name: &str, count: usize, round: usize| {
            let draw = |k: usize| {
                let name = format!("{name}, round {round}");
                let place = (k * FOLDS + fold) as u64;
                told.draw(&mut stream(seed, &name, place), "drawn")
            };
            (0..count)
                .map(draw)
                .collect::<std::result::Result<Vec<_>, _>>()
        };
        let unseen: Vec<Facade> = facades.iter().skip(fold).step_by(FOLDS).cloned().collect();
        held_out.add(&told, &others, &unseen)?;
        for (round, folds) in rounds.iter_mut().enumerate() {
            folds.push(Fold {
                drawn: draws("told apart", others.len(), round).map_err(Error::method)?,
                fresh: draws("fresh", unseen.len(), round).map_err(Error::method)?,
                known: others.clone(),
                held_out: unseen.clone(),
            });
        }
    }
    for facade in facades {
        separate += parse_cost(facade, library.step(), &costs).map_err(Error::method)?;
        alone.push(code.encode(facade).map_err(Error::method)?.bits);
    }
    let real = facades.iter().filter(|facade| is_aligned(facade)).count();
    let (mut new, mut aligned) = (0, 0);
    for k in 0..DRAWS {
        let drawn = library
            .draw(&mut stream(seed, "draw", k), "drawn")
            .map_err(Error::method)?;
        new += usize::from(library.is_new(&drawn).map_err(Error::method)?);
        aligned += usize::from(is_aligned(&drawn));
    }
    let labels: Vec<&str> = library
        .rules()
        .labels()
        .iter()
        .map(String::as_str)
        .collect();
    let areas = rounds.iter().map(|folds| area(folds, &labels));
    let areas = areas.collect::<Result<Vec<f64>>>()?;
    let share = |count: usize, of: usize| count as f64 / of.max(1) as f64;
    Ok(Measured {
        facades: facades.len(),
        separate,
        // No method marks its own work: the cost is that of the written grammar.
        cost: costs.grammar(&library.grammar(&sharing)),
        bound: sharing.lower_bound,
        rules: sharing.rules.len(),
        seconds,
        alone: mean(&alone),
        separate_bits: mean(&held_out.separate),
        logic_normal: mean(&held_out.logic_normal),
        logic: mean(&held_out.logic),
        held_out: mean(&held_out.library),
        known_roots: share(held_out.known, held_out.library.len()),
        new_draws: share(new, DRAWS as usize),
        aligned: (share(real, facades.len()), share(aligned, DRAWS as usize)),
        told_apart: mean_and_error(&areas),
    })
}

/// True if the windows lie in columns: of two, the sides are the same or one ends where the other has not begun.
fn is_aligned(facade: &Facade) -> bool {
    let windows = facade
        .regions
        .iter()
        .filter(|region| region.label == "window");
    let mut sides: Vec<(f64, f64)> = windows.map(|w| (w.rect.x, w.rect.right())).collect();
    sides.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    sides.dedup_by(|a, b| (a.0 - b.0).abs() < 1e-6 && (a.1 - b.1).abs() < 1e-6);
    sides.windows(2).all(|pair| pair[0].1 <= pair[1].0 + 1e-6)
}
