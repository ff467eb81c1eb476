//! Squares of new cities beside those of the cities they are made from (the judgement of Fig. 9's synthesis).

use std::collections::BTreeSet;

use super::data;
use edifice_base::{Error, Result, unwatched};
use edifice_city_proceduralization::morphology::{CityPlan, Morphology, Square};
use edifice_city_proceduralization::synthesis::{Shape, synthesize};
use edifice_city_proceduralization::{Mode, proceduralize};
use edifice_frame::Context;
use edifice_grammar::instance::InstanceGrammar;
use edifice_io_city::picture::{Drawing, Drawn, View, draw};
use edifice_report::{Align, Table};
use edifice_shape::triangles::City;

/// New cities, one a seed.
const SEEDS: u64 = 8;
/// A new city is larger than its square by so many metres on each side, so that its edge is not judged.
const RIM: f64 = 100.0;
/// Buildings that stand together have origins at most so far apart, in metres.
const TOGETHER: f64 = 40.0;

/// Judges new squares by the morphology of the old city's squares, and draws one beside the old one that is most alike.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let seed = ctx.seed();
    let side = ctx.budget().choose(150.0, 700.0, 700.0);
    let seeds = ctx.budget().choose(2, SEEDS, SEEDS);
    ctx.setting("side_m", side);
    let mut table =
        Table::new("Squares of new cities beside those of the cities they are made from")
            .column("city", Align::Left)
            .column("measure", Align::Left)
            .numbers(["old squares", "new squares", "new/old"]);
    let cities = data::three_cities(ctx)?;
    for (name, city) in &cities {
        let made = proceduralize(city, &data::settings(Mode::Best, 4, seed), &unwatched)
            .map_err(Error::method)?;
        let grammar = made.grammar;
        let plan = CityPlan::new(city);
        let squares = plan.squares(side);
        let Some(old) = plan.measure(&squares) else {
            ctx.note(format!("{name}: no square of {side} m is town."));
            continue;
        };
        let whole = side + 2.0 * RIM;
        let shape = Shape {
            rings: vec![vec![[0.0, 0.0], [whole, 0.0], [whole, whole], [0.0, whole]]],
        };
        let square = Square {
            low: [RIM; 2],
            side,
        };
        let (mut new, mut shown, mut copied) = (Vec::new(), None, Vec::new());
        for s in 0..seeds {
            let filled =
                synthesize(&grammar, &shape, seed + s, &unwatched).map_err(Error::method)?;
            copied.push(copied_pairs(&grammar, &filled));
            let city = filled.derive().map_err(Error::method)?.city(&filled);
            new.extend(CityPlan::new(&city).measure(&[square]));
            shown.get_or_insert(city);
        }
        let mean =
            |f: fn(&Morphology) -> f64| new.iter().map(f).sum::<f64>() / new.len().max(1) as f64;
        // Pooled as the old squares are.
        let buildings = mean(|m| m.buildings as f64);
        let blocks = mean(|m| m.buildings as f64 / m.buildings_per_block);
        let measures = [
            (
                "buildings a square",
                old.buildings as f64 / squares.len() as f64,
                buildings,
            ),
            (
                "buildings a block",
                old.buildings_per_block,
                buildings / blocks,
            ),
            (
                "share attached",
                old.attached,
                mean(|m| m.attached * m.buildings as f64) / buildings,
            ),
            (
                "neighbours parallel",
                old.parallel,
                mean(|m| m.parallel * m.buildings as f64) / buildings,
            ),
            (
                "gap to the next block",
                old.gap,
                mean(|m| m.gap * m.buildings as f64) / buildings,
            ),
            ("covered", old.covered, mean(|m| m.covered)),
            ("overlap", old.overlap, mean(|m| m.overlap)),
            ("smaller side, median", old.sizes[0], mean(|m| m.sizes[0])),
            ("larger side, median", old.sizes[1], mean(|m| m.sizes[1])),
            ("height, median", old.sizes[2], mean(|m| m.sizes[2])),
        ];
        for (measure, old, new) in measures {
            let key = measure.replace([' ', ','], "_").replace("__", "_");
            ctx.observe(data::row(name, "best", "old", &key, old, ""));
            ctx.observe(data::row(name, "best", "new", &key, new, ""));
            let ratio = if old > 0.0 {
                format!("{:.3}", new / old)
            } else {
                String::new()
            };
            table.row(vec![
                name.clone(),
                measure.to_owned(),
                format!("{old:.3}"),
                format!("{new:.3}"),
                ratio,
            ]);
        }
        let copied = copied.iter().sum::<f64>() / copied.len().max(1) as f64;
        ctx.observe(data::row(name, "best", "new", "pairs_copied", copied, ""));
        table.row(vec![
            name.clone(),
            "pairs copied".into(),
            String::new(),
            format!("{copied:.3}"),
            String::new(),
        ]);
        // The old square with most nearly the share of ground that is covered on the whole.
        let unlike = |s: &Square| {
            plan.measure(&[*s])
                .map_or(f64::INFINITY, |m| (m.covered - old.covered).abs())
        };
        let typical = squares
            .iter()
            .min_by(|a, b| unlike(a).total_cmp(&unlike(b)));
        // The made city is drawn where there is no real one.
        let is_drawn = name != data::MADE || cities.len() == 1;
        if let (true, Some(typical), Some(new)) = (is_drawn, typical, shown) {
            let [from, to] = [cut(city, typical), cut(&new, &square)];
            for (what, view) in [("plan", View::FigureGround), ("view", View::Oblique)] {
                // The houses of the made city say nothing in perspective that they do not in the plan.
                if name == data::MADE && view == View::Oblique {
                    continue;
                }
                let width = ctx.budget().choose(160, 500, 900);
                let height = match view {
                    View::FigureGround => width,
                    _ => width * 5 / 8,
                };
                let drawing = Drawing {
                    width,
                    height,
                    view,
                    around: None,
                };
                let drawn = [&from, &to].map(|city| Drawn {
                    city,
                    colours: None,
                });
                let picture = draw(&drawn, &drawing, &Vec::new()).map_err(Error::method)?;
                let said =
                    format!("{name}, {what}: a square of {side} m of the old city, and a new one");
                ctx.attach(&format!("new_squares_{name}_{what}.png"), &picture, &said)?;
            }
        }
    }
    ctx.table(&table);
    ctx.note(format!("New: mean of {seeds} seeds, in the middle of a square that is {RIM} m larger on each side. Old: all squares of the city that the grammar is made from, overlapping by half, of which nine tenths are within 100 m of a building. Blocks: buildings whose walls are at most 0.5 m apart. Neighbours: the four nearest within 40 m, parallel within 5 degrees. Overlap: share of plan area under another building. Pairs copied: share of pairs of buildings within {TOGETHER} m that stand to each other as a pair of the old city of the same types does, to 0.1 m: what is not a seam between two patches."));
    Ok(())
}

/// The buildings of a square, with its corner at the origin.
fn cut(city: &City, square: &Square) -> City {
    let mut out = city.clone();
    out.origin = [0.0; 3];
    out.buildings.retain(|b| {
        let Some((low, high)) = b.mesh.bounds() else {
            return false;
        };
        (0..2).all(|k| {
            let v = (low[k] + high[k]) / 2.0 - square.low[k];
            (0.0..square.side).contains(&v)
        })
    });
    for b in &mut out.buildings {
        for p in &mut b.mesh.positions {
            *p = [p[0] - square.low[0], p[1] - square.low[1], p[2]];
        }
    }
    out
}

/// The share of pairs of buildings that stand together in the new city as a pair of the old one does.
fn copied_pairs(old: &InstanceGrammar, new: &InstanceGrammar) -> f64 {
    let known: BTreeSet<_> = pairs(old).into_iter().collect();
    let pairs = pairs(new);
    let copied = pairs.iter().filter(|p| known.contains(*p)).count();
    copied as f64 / pairs.len().max(1) as f64
}

/// Pairs of buildings that stand together: their types, and the distance of their origins in steps of 0.1 m.
fn pairs(grammar: &InstanceGrammar) -> Vec<(String, String, i64)> {
    let flat = grammar.flat(None);
    let mut placed: Vec<(&str, [f64; 3])> = flat
        .top()
        .into_iter()
        .flat_map(|r| &r.successors)
        .map(|s| (s.symbol.as_str(), s.at))
        .collect();
    placed.sort_by(|a, b| a.1[0].total_cmp(&b.1[0]));
    let mut out = Vec::new();
    for (i, (a, p)) in placed.iter().enumerate() {
        for (b, q) in placed[i + 1..]
            .iter()
            .take_while(|(_, q)| q[0] - p[0] <= TOGETHER)
        {
            let far = (p[0] - q[0]).hypot(p[1] - q[1]);
            if far <= TOGETHER {
                let (a, b) = if a <= b { (a, b) } else { (b, a) };
                out.push((
                    (*a).to_owned(),
                    (*b).to_owned(),
                    (far * 10.0).round() as i64,
                ));
            }
        }
    }
    out
}
