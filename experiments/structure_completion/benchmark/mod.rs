//! The benchmark: parts of whole facades are hidden and completed, by the default model first.
//!
//! One number alone can be met without meaning: F1 at an overlap of one half rewards elements that stand beside their lines.
//! So each completion is measured in several ways at once:
//!
//! - made grids, which have to come back perfectly, before anything else, and the score of the paper on layouts with a hole;
//! - agreement: F1 at an intersection over union of 0.5, of 0.75, and the mean of 0.5, 0.55, ..., 0.95; without a mask also F1 of what
//!   is added within the region that a mask would have told;
//! - coherence: completions with an overlap, new windows that lack a column or a row, numbers of columns and of rows that are
//!   right within one;
//! - doors: share of the hidden ones that are found, false ones a facade;
//! - counts: the continuous ranked probability score of the number of hidden windows, how often the interval from its 10 % to
//!   its 90 % quantile covers the true number, and the width of that interval;
//! - calibration of `mass`: the expected calibration error of the statement that the facade has the numbers of columns and rows
//!   of an answer;
//! - draws: the skill of a classifier that tells draws of the pool from the truth by statistics of the layouts, both put on
//!   shared lines first, so that it cannot tell them by the noise of an annotation.
//!
//! Columns are the default model, a model learnt from the other real sets, one from the same set without the facade's fold
//! ([`models`]), and the baselines. The parts are those of
//! [`sights`](edifice_structure_completion::sights), hidden by frozen masks: they depend on the facade alone, not on the seed, and are those that
//! `edifice facade hide --frozen` writes. Means are over facades, then over the real sets.
//!
//! # Deviations and readings
//! - The paper has no such benchmark; the measures are ours.
//! - The paper's own method and annealing search for seconds a facade. They are run at the paper budget only, on two facades of
//!   each set.
//! - A facade that has nothing to hide in a part is left out of it.

mod against;
mod columns;
mod measures;
mod models;
mod preference;
mod sanity;
mod sheet;
mod tables;

use self::columns::BASELINES;
use self::measures::{Measured, measured};
use self::models::Tested;
use self::tables::Cases;
use super::row;
use edifice_base::Result;
use edifice_base::rng::stream;
use edifice_frame::{Budget, Context};
use edifice_structure_completion::method::Method;
use edifice_structure_completion::sights::Sight;

/// One facade with one part hidden.
struct Unit<'a> {
    tested: &'a Tested,
    sight: Sight,
    /// True if the methods that search are asked too.
    searched: bool,
}

/// Runs the benchmark.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let models = models::models(ctx)?;
    sanity::run(ctx, &models)?;
    preference::run(ctx, &models)?;
    let mut units: Vec<Unit> = Vec::new();
    let searched = ctx.budget() == Budget::Paper;
    for (k, tested) in models.tested.iter().enumerate() {
        let place = models.tested[..k].iter().filter(|t| t.set == tested.set);
        let searched = searched && place.count() < 2;
        units.extend(Sight::all().into_iter().map(|sight| Unit {
            tested,
            sight,
            searched,
        }));
    }
    let seed = ctx.seed();
    let key = |u: &Unit| {
        let Tested { set, layout, .. } = u.tested;
        format!("{set}/{}/{}", layout.name, u.sight.name())
    };
    let work = |u: &Unit| -> Result<Vec<Measured>> {
        let name = key(u);
        let layout = &u.tested.layout;
        let (partial, hidden) = u.sight.hide_frozen(layout);
        if hidden.is_empty() {
            return Ok(Vec::new());
        }
        let told = || u.sight.masked().hide_frozen(layout).0.unknown;
        let untold = (!u.sight.is_masked()).then(told).flatten();
        let best = u.tested.models.iter();
        let best = best.map(|&(column, k)| (column, Method::Best, &models.all[k]));
        let baselines = BASELINES
            .into_iter()
            .filter(|b| u.searched || !b.is_slow())
            .map(|b| (b.name(), b, &models.all[0]));
        let case = [u.tested.set.to_owned(), layout.name.clone(), u.sight.name()];
        let each = best.chain(baselines).map(|column| {
            let rng = &mut stream(seed, &format!("benchmark: completion/{name}"), 0);
            measured(
                case.clone(),
                column,
                layout,
                (&partial, &hidden),
                untold.as_deref(),
                rng,
            )
        });
        Ok(each.collect())
    };
    let cases: Vec<Measured> = ctx
        .units(&units, key, work)?
        .into_iter()
        .flatten()
        .collect();
    for m in &cases {
        let [set, facade, part] = &m.case;
        for (measure, value) in &m.values {
            let instance = format!("{part}/{facade}");
            ctx.observe(row(set, &m.column, instance, Some(seed), measure, *value));
        }
        for (k, (mass, right)) in m.masses.iter().enumerate() {
            let instance = format!("{part}/{facade}/{}", k + 1);
            ctx.observe(row(
                set,
                &m.column,
                instance.clone(),
                Some(seed),
                "mass",
                *mass,
            ));
            let right = f64::from(u8::from(*right));
            ctx.observe(row(
                set,
                &m.column,
                instance,
                Some(seed),
                "lattice_right",
                right,
            ));
        }
    }
    Cases(&cases).tables(ctx)?;
    if models.real.is_none() {
        ctx.note("On generated facades, the like of which the default model has learnt; with `--data` on real ones.");
    }
    sheet::draw(ctx, &models)
}
