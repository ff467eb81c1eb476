//! Fig. 13 and 14 as houses: means and samples of a Gaussian mixture beside samples of our model.

use super::views::{BACK, FRONT, Panel, plan, sheet};
use super::{data, settings};
use edifice_base::rng::stream;
use edifice_base::{Error, Result};
use edifice_building_exteriors::attributes::COLUMNS;
use edifice_building_exteriors::design::wanted_rows;
use edifice_building_exteriors::house::{Database, Generated, Options, generate};
use edifice_frame::Context;
use edifice_model::tables::mixture::Baseline;
use edifice_report::{Align, Table};

/// Columns that are given in Fig. 14: the bounding box and the garage.
const GIVEN: [usize; 9] = [0, 1, 2, 9, 10, 11, 12, 13, 14];
/// Samples of the mixture among which one with overlapping parts is sought.
const SAMPLES: usize = 200;

/// A row, and the house made of it where one can be.
struct Shown {
    name: String,
    row: [f64; 49],
    house: Option<Generated>,
}

fn shown(
    name: String,
    row: [f64; 49],
    given: &[bool; 49],
    database: &Database,
    seed: u64,
) -> Shown {
    let mut rng = stream(seed, &format!("building_exteriors/mixture/{name}"), 0);
    let house = generate(&name, &row, given, database, &Options::default(), &mut rng).ok();
    Shown { name, row, house }
}

fn write(ctx: &mut Context, name: &str, what: &str, all: &[Shown]) -> Result<()> {
    let panels: Vec<Vec<Panel>> = all
        .iter()
        .map(|s| {
            let mut row = vec![Panel::Parts(&s.row)];
            match &s.house {
                Some(house) => row.extend([
                    plan(&house.building),
                    Panel::House(&house.model, 6, FRONT),
                    Panel::House(&house.model, 6, BACK),
                ]),
                None => row.extend([Panel::Empty, Panel::Empty, Panel::Empty]),
            }
            row
        })
        .collect();
    let cell = ctx.budget().choose([60, 44], [320, 240], [320, 240]);
    ctx.attach(&format!("{name}.png"), &sheet(&panels, cell)?, what)?;
    let mut table = Table::new("What had to be moved before a house could be built")
        .column("house", Align::Left)
        .numbers([
            "garage and front porch overlap (m²)",
            "part outside",
            "columns moved",
            "max z from the attributes",
        ]);
    for s in all {
        let [garage, porch, back] = [9, 15, 21].map(|c| part(&s.row, c));
        let overlap = match (&garage, &porch) {
            (Some(a), Some(b)) => a.overlap(b),
            _ => 0.0,
        };
        let outside = [&garage, &porch, &back].into_iter().flatten().any(|p| {
            p.x < -0.1 || p.y < -0.1 || p.right() > s.row[0] + 0.1 || p.top() > s.row[1] + 0.1
        });
        let report = s.house.as_ref().map(|h| &h.report);
        table.row([
            s.name.clone(),
            format!("{overlap:.2}"),
            if outside { "yes" } else { "no" }.to_owned(),
            report.map_or("no house".into(), |r| r.repaired.len().to_string()),
            report.map_or("–".into(), |r| format!("{:.2}", r.max_z)),
        ]);
    }
    ctx.table(&table);
    ctx.note(
        "Columns of the picture: garage (green), front porch (blue) and back porch (red) in the bounding box as the attributes say, those \
         that overlap or reach outside in red outline; the boxes of the house built after repair; the house from the front and the back.",
    );
    Ok(())
}

fn part(row: &[f64; 49], c: usize) -> Option<edifice_shape::Rect> {
    let [w, d] = [row[c + 2], row[c + 3]];
    let (x, y) = (row[c] * row[0], row[c + 1] * row[1]);
    (w.min(d) >= 0.5).then(|| edifice_shape::Rect::new(x - w / 2.0, y - d / 2.0, w, d))
}

/// Fig. 13: houses of the means of the mixture's components.
pub(crate) fn figure_13(ctx: &mut Context) -> Result<()> {
    let shipped = data::shipped(ctx)?;
    let settings = settings(ctx);
    let seed = ctx.seed();
    let most = *settings.styles.end();
    let gmm = Baseline::learn(&shipped.data.table, &settings.priors.linear, most, seed);
    let gmm = gmm.map_err(Error::method)?;
    let database = Database::new(shipped.buildings).map_err(Error::method)?;
    let means = (0..gmm.components()).map(|k| {
        let mean = gmm.mean(k);
        let row = std::array::from_fn(|c| mean[c]);
        shown(
            format!("mean_{}", k + 1),
            row,
            &[false; 49],
            &database,
            seed,
        )
    });
    let all: Vec<Shown> = means.collect();
    ctx.compare(
        "components of the mixture (MDL)",
        "2",
        gmm.components().to_string(),
    );
    write(
        ctx,
        "figure_13",
        "the means of the components of a Gaussian mixture",
        &all,
    )
}

/// Fig. 14: a sample of the mixture and one of ours, bounding box and garage given.
pub(crate) fn figure_14(ctx: &mut Context) -> Result<()> {
    let shipped = data::shipped(ctx)?;
    let settings = settings(ctx);
    let seed = ctx.seed();
    let table = &shipped.data.table;
    let most = *settings.styles.end();
    let gmm = Baseline::learn(table, &settings.priors.linear, most, seed).map_err(Error::method)?;
    let learned = data::learned(&shipped.data, &settings, seed)?;
    let has = |row: usize, c| data::number(table, c, row).is_some_and(|w| w > 0.5);
    let house = (0..table.rows())
        .find(|&row| has(row, "garage.w") && has(row, "porch.front.w"))
        .ok_or_else(|| Error::method("no house with a garage and a front porch"))?;
    let names = GIVEN.map(|c| COLUMNS[c]);
    let given = table.select(&[house]).only(&names).map_err(Error::method)?;
    let values: Vec<(&str, f64)> = names
        .into_iter()
        .filter_map(|c| data::number(table, c, house).map(|v| (c, v)))
        .collect();
    let mut rng = stream(seed, "building_exteriors/figure_14/houses", 0);
    let samples = gmm.sample_given(&values, SAMPLES, &mut rng);
    let overlap = |row: &Vec<f64>| {
        let row: [f64; 49] = std::array::from_fn(|c| row[c]);
        match (part(&row, 9), part(&row, 15)) {
            (Some(a), Some(b)) => a.overlap(&b),
            _ => 0.0,
        }
    };
    let share = samples.iter().filter(|s| overlap(s) > 0.05).count();
    let worst = samples.iter().position(|s| overlap(s) > 0.05).unwrap_or(0);
    let ours = learned
        .model
        .most_probable(&given, 1, 500, 0.0, None, &mut rng)
        .map_err(Error::method)?;
    let ours = wanted_rows(&ours.table);
    let database = Database::new(shipped.buildings).map_err(Error::method)?;
    let known: [bool; 49] = std::array::from_fn(|c| GIVEN.contains(&c));
    let mixed = std::array::from_fn(|c| samples[worst][c]);
    let all = [
        shown("gmm".into(), mixed, &known, &database, seed),
        shown("ours".into(), ours[0], &known, &database, seed),
    ];
    ctx.note(format!(
        "Above, the first sample of the mixture whose front porch and garage overlap ({share} of {SAMPLES} do); below, \
         the most probable of 500 samples of our model, for the same bounding box and garage (house {}).",
        house + 1
    ));
    write(
        ctx,
        "figure_14_houses",
        "a sample of a Gaussian mixture (above) and of our model (below)",
        &all,
    )
}
