//! Figs. 13 and 14 in attribute space: do samples put the front porch on the garage?

use serde::{Deserialize, Serialize};

use super::{data, settings};
use edifice_base::rng::stream;
use edifice_base::{Error, Result};
use edifice_building_exteriors::attributes::COLUMNS;
use edifice_frame::Context;
use edifice_model::hierarchy::learn;
use edifice_model::tables::compare::split;
use edifice_model::tables::mixture::Baseline;
use edifice_report::{Align, Bars, Figure, Row, Scale, Table};

/// Columns that are given: the bounding box and the garage.
const GIVEN: [usize; 9] = [0, 1, 2, 9, 10, 11, 12, 13, 14];
/// A part narrower than this in metres is not built.
const LEAST: f64 = 0.5;

#[derive(Default, Serialize, Deserialize)]
struct Count {
    porches: usize,
    overlaps: usize,
    inside: usize,
}

#[derive(Serialize, Deserialize)]
struct Outcome {
    ours: Count,
    gmm: Count,
    components: usize,
    /// Overlaps of the component means with a garage and a porch.
    means: Count,
}

/// Completes the held-out houses with a garage from bounding box and garage alone.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let shipped = data::shipped(ctx)?;
    let settings = settings(ctx);
    let draws = ctx.budget().choose(5, 100, 500);
    ctx.setting("draws", draws);
    let splits: Vec<u64> = (0..ctx.budget().choose(1, 2, 5)).collect();
    let seed = ctx.seed();
    let all = &shipped.data;
    let outcomes: Vec<Outcome> = ctx.units(
        &splits,
        |index| format!("split/{index}"),
        |&index| {
            let (train, test) = split(all.table.rows(), 0.8, seed, index);
            let (train, test) = (all.select(&train), all.select(&test));
            let learned =
                learn(&train.table, &train.groups, &settings, seed).map_err(Error::method)?;
            let prior = &settings.priors.linear;
            let most = *settings.styles.end();
            let gmm = Baseline::learn(&train.table, prior, most, seed).map_err(Error::method)?;
            let names = GIVEN.map(|c| COLUMNS[c]);
            let mut outcome = Outcome {
                ours: Count::default(),
                gmm: Count::default(),
                components: gmm.components(),
                means: Count::default(),
            };
            for k in 0..gmm.components() {
                outcome.means.add(&gmm.mean(k));
            }
            for row in 0..test.table.rows() {
                let garage = data::number(&test.table, "garage.w", row);
                if garage.is_none_or(|w| w < LEAST) {
                    continue;
                }
                let mut rng = stream(seed, "building_exteriors/figure_14", row as u64);
                let given = test
                    .table
                    .select(&[row])
                    .only(&names)
                    .map_err(Error::method)?;
                let ours = learned.model.complete(&given, draws, &mut rng);
                let ours = ours.map_err(Error::method)?.table;
                for i in 0..ours.rows() {
                    let value = |c: &&str| data::number(&ours, c, i).unwrap_or(0.0);
                    outcome
                        .ours
                        .add(&COLUMNS.iter().map(value).collect::<Vec<f64>>());
                }
                let value = |c: &'static str| data::number(&test.table, c, row).map(|v| (c, v));
                let given: Vec<(&str, f64)> = names.into_iter().filter_map(value).collect();
                for sample in gmm.sample_given(&given, draws, &mut rng) {
                    outcome.gmm.add(&sample);
                }
            }
            Ok(outcome)
        },
    )?;
    let mut table = Table::new("Front porches of completed houses, bounding box and garage given")
        .column("model", Align::Left)
        .numbers([
            "porches",
            "on the garage (share)",
            "inside the bounding box (share)",
        ]);
    let mut shares = Vec::new();
    type Pick = fn(&Outcome) -> &Count;
    let rows: [(&str, Pick); 3] = [
        ("ours", |o| &o.ours),
        ("gmm", |o| &o.gmm),
        ("gmm component means (Fig. 13)", |o| &o.means),
    ];
    for (name, pick) in rows {
        let sum = |f: fn(&Count) -> usize| outcomes.iter().map(|o| f(pick(o))).sum::<usize>();
        let porches = sum(|c| c.porches);
        let share = |n: usize| n as f64 / porches.max(1) as f64;
        let (overlap, inside) = (share(sum(|c| c.overlaps)), share(sum(|c| c.inside)));
        table.row([
            name.to_owned(),
            porches.to_string(),
            format!("{overlap:.3}"),
            format!("{inside:.3}"),
        ]);
        if shares.len() < 2 {
            shares.push(Some(overlap));
            ctx.observe(Row {
                dataset: "shipped".into(),
                method: name.into(),
                instance: "all".into(),
                seed: Some(seed),
                metric: "overlap".into(),
                value: overlap,
                ..Row::default()
            });
        }
    }
    ctx.table(&table);
    let components: Vec<String> = outcomes.iter().map(|o| o.components.to_string()).collect();
    ctx.compare(
        "components of the mixture (MDL)",
        "2",
        components.join(", "),
    );
    ctx.compare(
        "front porch on the garage, of the porches sampled",
        "shown for the GMM, not for ours",
        format!(
            "GMM {:.1} %, ours {:.1} %",
            100.0 * shares[1].unwrap_or(0.0),
            100.0 * shares[0].unwrap_or(0.0)
        ),
    );
    let bars = Bars::new(
        "",
        "",
        Scale::new("share of porches on the garage"),
        vec!["ours".into(), "gmm".into()],
    )
    .group("overlap in plan", shares);
    ctx.figure(
        "figure_14",
        &Figure::single("front porch and garage on top of each other", bars),
    )?;
    ctx.note(
        "In attribute space: a porch counts when it is at least 0.5 m wide and deep; it is on the garage when the \
         rectangles of their positions and sizes share more than 0.1 m in both directions. No generated house has \
         such a pair.",
    );
    Ok(())
}

impl Count {
    /// Counts one house given by its attributes.
    fn add(&mut self, values: &[f64]) {
        let (w, d) = (values[0], values[1]);
        let part = |c: usize| {
            let (x, y) = (values[c] * w, values[c + 1] * d);
            let (width, depth) = (values[c + 2], values[c + 3]);
            [
                x - width / 2.0,
                x + width / 2.0,
                y - depth / 2.0,
                y + depth / 2.0,
            ]
        };
        if values[17].min(values[18]) < LEAST || values[11].min(values[12]) < LEAST {
            return;
        }
        let (garage, porch) = (part(9), part(15));
        self.porches += 1;
        let shared = |a: usize| porch[a + 1].min(garage[a + 1]) - porch[a].max(garage[a]);
        self.overlaps += usize::from(shared(0) > 0.1 && shared(2) > 0.1);
        let slack = 0.1;
        let inside =
            porch[0] > -slack && porch[1] < w + slack && porch[2] > -slack && porch[3] < d + slack;
        self.inside += usize::from(inside);
    }
}
