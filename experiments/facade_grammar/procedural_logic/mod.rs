//! Table 2's column PL over the ranges of its parameters, and where it coincides with BGL.

mod settings;

use self::settings::{JOININGS, Measured, Pick, measure, place, settings, text};
use super::data::{self, FIGURE_9, Instance};
use super::iterations;
use super::published::Published;
use super::runs::mean;
use edifice_base::{Error, Result};
use edifice_frame::{Artefact, Budget, Context};
use edifice_procedural_logic::Parameters;
use edifice_report::{Align, Chart, Corner, Figure, Row, Scale, Series, Table};

/// The artefact.
pub(crate) const RANGES: Artefact = Artefact {
    name: "baseline_ranges",
    title: "procedural logic of Table 2 over the ranges of its parameters",
    run,
};

/// Two costs that differ by less are one.
const SAME: f64 = 1e-6;

/// Everything measured.
struct Found {
    instances: Vec<Instance>,
    measured: Vec<Measured>,
    /// Index of facade (i).
    example: usize,
    /// For each joining, the setting nearest to what the paper prints.
    nearest: [usize; 3],
}

/// Procedural logic with every setting on every facade.
fn run(ctx: &mut Context) -> Result<()> {
    let (few, _) = iterations(ctx.budget());
    let settings = settings();
    ctx.setting("iterations", few);
    ctx.setting("settings", settings.len());
    let shipped = data::shipped(ctx)?.into_iter();
    let mut instances: Vec<Instance> = shipped
        .map(|facade| Instance {
            dataset: "shipped",
            facade,
        })
        .collect();
    let limit = if ctx.budget() == Budget::Smoke {
        1
    } else {
        usize::MAX
    };
    instances.extend(data::real(ctx, limit)?);
    let seed = ctx.seed();
    let measured = ctx.units(
        &instances,
        |i| format!("{}/{}", i.dataset, i.facade.name),
        |i| measure(&i.facade, few, seed),
    )?;
    let is_example = |i: &Instance| i.facade.name == FIGURE_9;
    let example = instances.iter().position(is_example);
    let example = example.ok_or_else(|| Error::method("facade (i) is not among the shipped"))?;
    let printed = Published::read(ctx)?;
    let mut found = Found {
        instances,
        measured,
        example,
        nearest: [0; 3],
    };
    let number = |key: [&str; 5]| printed.number(key);
    let aim = (
        number(["table_2", "procedural_logic", "i", "cost", "value"])?,
        number([
            "ratios",
            "procedural_logic",
            "avg",
            "cost_over_adp",
            "value",
        ])?,
    );
    found.nearest = [0, 1, 2].map(|joining| found.nearest_to(joining, aim));
    observe(ctx, &found)?;
    facade_i(ctx, &found, &printed)?;
    averages(ctx, &found, &printed)?;
    coincidence(ctx, &found);
    ctx.figure("baseline_ranges", &picture(&found, aim))?;
    ctx.note(WHICH);
    ctx.note(reached(&found));
    Ok(())
}

const WHICH: &str = "**Which setting Table 2 prints.** The column `procedural_logic` of Table 2 has alpha 0.6, b_p 0.25, b_h 0.5, the setting of \
    Weissenberg et al. 2013, Sec. 5.3: it is theirs for compression, which is what Table 2 measures. Wu et al. only say that \
    the parameters \"are known\". *nearest* is the setting nearest to the printed cost of facade (i) and, among equals, to the printed ratio to ADP. \
    On most facades the setting changes nothing: a part of a facade that full lines split in one direction only has \
    one n-ary split, since Eq. 9 joins nested splits of one direction and forgets the order of their lines. The parameters decide \
    only where a part has full lines in both directions. Where the parse then takes all lines of one direction before the other, horizontal ones first, it is \
    BGL's initial step, and the two columns coincide.";

/// The sentences on the costs that the settings reach, and those that they do not.
fn reached(found: &Found) -> String {
    let costs = &found.measured[found.example].costs;
    let range = |joining: usize| {
        let [least, most] = [Pick::Least, Pick::Most].map(|p| p.of(&costs[joining]));
        format!("{least:.1} to {most:.1}")
    };
    let ratios = found
        .datasets()
        .into_iter()
        .map(|d| found.ratio(d, |m| Pick::Most.of(&m.costs[0])));
    let ratio = ratios.fold(0.0, f64::max);
    format!(
        "**Beside the printed numbers.** With Sec. 4.1 in its order (all splits are made n-ary, then equal parts become rules), facade (i) costs {} \
         over all settings (printed 51), and no data set's average is above {ratio:.2} times ADP (printed 1.99), even with the dearest setting of each facade. Two \
         other readings of Sec. 4.1 stand beside it: *used_once* finds equal parts in the binary tree first and joins only what is used once ({} on \
         facade (i)), *binary* joins nothing ({}). The authors' implementation is not public, and facade (i) is rebuilt from its printed \
         grammar with sizes of our choice. No reading or setting was chosen to make the columns differ.",
        range(0),
        range(1),
        range(2),
    )
}

impl Found {
    /// Averages over a data set.
    fn average(&self, dataset: &str, of: impl Fn(&Measured) -> f64) -> f64 {
        let all = self.instances.iter().zip(&self.measured);
        let mine = all.filter(|(i, _)| i.dataset == dataset);
        mean(&mine.map(|(_, m)| of(m)).collect::<Vec<_>>())
    }

    /// Average cost over that of ADP.
    fn ratio(&self, dataset: &str, of: impl Fn(&Measured) -> f64) -> f64 {
        self.average(dataset, of) / self.average(dataset, |m| m.adp)
    }

    /// The setting nearest to the printed cost of facade (i); among equals, to the printed ratio to ADP on the shipped facades.
    fn nearest_to(&self, joining: usize, (cost, ratio): (f64, f64)) -> usize {
        let costs = &self.measured[self.example].costs[joining];
        let off = |setting: usize| {
            let mine = self.ratio("shipped", |m| m.costs[joining][setting]);
            ((costs[setting] - cost).abs(), (mine - ratio).abs())
        };
        let places = 0..costs.len();
        let best = places.min_by(|&a, &b| {
            let (a, b) = (off(a), off(b));
            a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1))
        });
        best.unwrap_or_default()
    }

    /// The picks among all settings that the tables show, in the order of their rows.
    fn picks(&self, joining: usize) -> Result<[(&'static str, Pick); 6]> {
        Ok([
            ("compression", Pick::At(place(&Parameters::COMPRESSION)?)),
            ("retrieval", Pick::At(place(&Parameters::RETRIEVAL)?)),
            ("least", Pick::Least),
            ("mean", Pick::Mean),
            ("most", Pick::Most),
            ("nearest", Pick::At(self.nearest[joining])),
        ])
    }

    fn datasets(&self) -> Vec<&'static str> {
        let mut names: Vec<_> = self.instances.iter().map(|i| i.dataset).collect();
        names.dedup();
        names
    }
}

/// Each facade's numbers, and all settings of facade (i).
fn observe(ctx: &mut Context, found: &Found) -> Result<()> {
    for (i, (instance, measured)) in found.instances.iter().zip(&found.measured).enumerate() {
        let mut row = |method: String, metric: String, value: f64| {
            ctx.observe(Row {
                dataset: instance.dataset.into(),
                method,
                instance: instance.facade.name.clone(),
                metric,
                value,
                ..Row::default()
            });
        };
        row("bayesian".into(), "cost".into(), measured.bayesian);
        row("adp_best".into(), "cost".into(), measured.adp);
        let same = f64::from(u8::from(measured.same_regions));
        row(
            JOININGS[0].0.into(),
            "same_regions_as_bayesian".into(),
            same,
        );
        for (j, (name, _)) in JOININGS.into_iter().enumerate() {
            for (pick, which) in found.picks(j)? {
                let value = which.of(&measured.costs[j]);
                row(name.into(), format!("cost_{pick}"), value);
            }
            if i == found.example {
                for (setting, cost) in settings().iter().zip(&measured.costs[j]) {
                    row(format!("{name}/{}", text(setting)), "cost".into(), *cost);
                }
            }
        }
    }
    Ok(())
}

/// Facade (i), setting by setting.
fn facade_i(ctx: &mut Context, found: &Found, printed: &Published) -> Result<()> {
    let measured = &found.measured[found.example];
    let settings = settings();
    let mut table = Table::new("Facade (i): cost of PL over its parameters, splits only")
        .column("", Align::Left)
        .column("alpha, b_p, b_h", Align::Left)
        .numbers(JOININGS.map(|(name, _)| name));
    for row in 0..6 {
        let (name, first) = found.picks(0)?[row];
        let parameters = match first {
            Pick::At(_) if name == "nearest" => {
                let each = found.nearest.map(|setting| text(&settings[setting]));
                each.join(" / ")
            }
            Pick::At(setting) => text(&settings[setting]),
            _ => format!("{} settings", settings.len()),
        };
        let mut cells = vec![name.to_string(), parameters];
        for (j, costs) in measured.costs.iter().enumerate() {
            cells.push(format!("{:.1}", found.picks(j)?[row].1.of(costs)));
        }
        table.row(cells);
    }
    ctx.table(&table);
    for (name, theirs, ours) in [
        (
            "PL",
            "procedural_logic",
            measured.costs[0][found.nearest[0]],
        ),
        ("BGL", "bayesian", measured.bayesian),
    ] {
        ctx.compare(
            match name {
                "PL" => "facade (i), cost of PL, nearest setting".to_string(),
                _ => format!("facade (i), cost of {name}"),
            },
            printed.text(["table_2", theirs, "i", "cost", "value"]),
            format!("{ours:.1}"),
        );
    }
    Ok(())
}

/// Averages over each data set, with the ratio to ADP that the paper's averages have.
fn averages(ctx: &mut Context, found: &Found, printed: &Published) -> Result<()> {
    let datasets = found.datasets();
    let mut table = Table::new("Average cost (times that of adp_best), splits only")
        .column("method", Align::Left)
        .column("setting", Align::Left)
        .numbers(datasets.iter().copied());
    let cell = |dataset: &str, of: &dyn Fn(&Measured) -> f64| {
        let (cost, ratio) = (found.average(dataset, of), found.ratio(dataset, of));
        format!("{cost:.1} ({ratio:.2})")
    };
    for (j, (name, _)) in JOININGS.into_iter().enumerate() {
        for (pick, which) in found.picks(j)? {
            let cells = datasets.iter().map(|d| cell(d, &|m| which.of(&m.costs[j])));
            let head = [name.to_string(), pick.to_string()].into_iter();
            table.row(head.chain(cells));
        }
    }
    for (name, of) in [
        (
            "bayesian",
            (|m: &Measured| m.bayesian) as fn(&Measured) -> f64,
        ),
        ("adp_best", |m: &Measured| m.adp),
    ] {
        let cells = datasets.iter().map(|d| cell(d, &of));
        let head = [name.to_string(), "–".to_string()].into_iter();
        table.row(head.chain(cells));
    }
    ctx.table(&table);
    let ratio = |name: &str| printed.text(["ratios", name, "avg", "cost_over_adp", "value"]);
    for dataset in datasets {
        let [least, _, most] = [Pick::Least, Pick::Mean, Pick::Most]
            .map(|p| found.ratio(dataset, |m| p.of(&m.costs[0])));
        let what = format!("average cost over ADP, {dataset}: PL, least to most over the settings");
        let ours = format!("{least:.2} to {most:.2}");
        ctx.compare(what, ratio("procedural_logic"), ours);
        let what = format!("average cost over ADP, {dataset}: BGL");
        let ours = format!("{:.2}", found.ratio(dataset, |m| m.bayesian));
        ctx.compare(what, ratio("bayesian"), ours);
    }
    Ok(())
}

/// On how many facades PL and BGL are one.
fn coincidence(ctx: &mut Context, found: &Found) {
    let mut table = Table::new("PL (procedural_logic) and BGL: where they coincide")
        .column("data set", Align::Left)
        .numbers([
            "facades",
            "same cost, setting of Table 2",
            "same regions, setting of Table 2",
            "same cost, every setting",
            "settings with BGL's cost, %",
            "PL cheaper at some setting",
            "PL dearer at some setting",
        ]);
    let column = place(&Parameters::COMPRESSION).unwrap_or_default();
    let row = |name: &str, of: &[&Measured]| {
        let count =
            |holds: &dyn Fn(&Measured) -> bool| of.iter().filter(|m| holds(m)).count().to_string();
        let same = |cost: f64, m: &Measured| (cost - m.bayesian).abs() < SAME;
        let share = |m: &&Measured| {
            let equal = m.costs[0].iter().filter(|&&c| same(c, m)).count();
            equal as f64 / m.costs[0].len() as f64
        };
        let shares: Vec<f64> = of.iter().map(share).collect();
        [
            name.to_string(),
            of.len().to_string(),
            count(&|m| same(m.costs[0][column], m)),
            count(&|m| m.same_regions),
            count(&|m| m.costs[0].iter().all(|&c| same(c, m))),
            format!("{:.1}", 100.0 * mean(&shares)),
            count(&|m| Pick::Least.of(&m.costs[0]) < m.bayesian - SAME),
            count(&|m| Pick::Most.of(&m.costs[0]) > m.bayesian + SAME),
        ]
    };
    for dataset in found.datasets() {
        let all = found.instances.iter().zip(&found.measured);
        let mine = all.filter(|(i, _)| i.dataset == dataset).map(|(_, m)| m);
        table.row(row(dataset, &mine.collect::<Vec<_>>()));
    }
    table.row(row("all", &found.measured.iter().collect::<Vec<_>>()));
    ctx.table(&table);
}

/// The settings in order of their cost: facade (i), and the average of each data set over ADP.
fn picture(found: &Found, (cost, ratio): (f64, f64)) -> Figure {
    let sorted = |mut costs: Vec<f64>| -> Vec<(f64, f64)> {
        costs.sort_by(f64::total_cmp);
        let last = costs.len().max(2) - 1;
        let share = |i: usize| 100.0 * i as f64 / last as f64;
        costs
            .into_iter()
            .enumerate()
            .map(|(i, c)| (share(i), c))
            .collect()
    };
    let scale = || Scale::new("settings, in order of cost (%)");
    let example = &found.measured[found.example];
    let chart = Chart::new("Facade (i)", scale(), Scale::new("cost").from_zero());
    let mut chart = JOININGS
        .iter()
        .zip(&example.costs)
        .fold(chart, |chart, ((name, _), costs)| {
            chart.series(Series::line(*name, sorted(costs.clone())))
        });
    let flat = |value: f64| vec![(0.0, value), (100.0, value)];
    chart = chart
        .series(Series::dashed("bayesian", flat(example.bayesian)))
        .level(cost, format!("printed: PL {cost}"))
        .legend(Corner::BottomRight);
    let datasets = found.datasets();
    let columns = if datasets.len() > 1 { 3 } else { 2 };
    let mut figure = Figure::new("cost of PL over its parameters", columns)
        .cell(430.0, 330.0)
        .panel(chart);
    for dataset in datasets {
        let title = format!("{dataset}: average over that of adp_best");
        let y = Scale::new("times the cost of adp_best").range(0.0, 3.0);
        let mut chart = Chart::new(title, scale(), y);
        for (j, (name, _)) in JOININGS.iter().enumerate() {
            let each = 0..settings().len();
            let ratios = each.map(|s| found.ratio(dataset, |m| m.costs[j][s]));
            chart = chart.series(Series::line(*name, sorted(ratios.collect())));
        }
        let bayesian = found.ratio(dataset, |m| m.bayesian);
        chart = chart
            .series(Series::dashed("bayesian", flat(bayesian)))
            .level(ratio, format!("printed: PL {ratio}"))
            .legend(Corner::BottomRight);
        figure = figure.panel(chart);
    }
    figure
}
