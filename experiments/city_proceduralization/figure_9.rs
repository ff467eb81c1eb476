//! Fig. 9: a new city in the shape of letters, from a grammar's buildings.

use super::{data, judge};
use edifice_base::unwatched;
use edifice_base::{Error, Result};
use edifice_city_proceduralization::synthesis::{Shape, synthesize};
use edifice_city_proceduralization::{Mode, proceduralize};
use edifice_frame::Context;
use edifice_io_city::grammar_file;
use edifice_io_city::picture::side_by_side;
use edifice_report::{Align, Table};

/// Fills the shape "3DV" with each city's buildings, draws it beside the city, and judges it.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let seed = ctx.seed();
    let width = ctx.budget().choose(160, 900, 1200);
    let height = ctx.budget().choose(150.0, 900.0, 900.0);
    ctx.setting("height_m", height);
    let shape = letters(height);
    let mut table = Table::new("New cities against those that they are made from")
        .column("city", Align::Left)
        .numbers([
            "buildings",
            "W1/std width",
            "depth",
            "height",
            "nearest",
            "divergence",
            "floor",
            "shuffled",
            "overlap",
            "inside",
            "fill",
        ]);
    let cities = data::cities(ctx)?;
    let real = cities.iter().any(|(name, _)| name != data::MADE);
    for (name, city) in cities {
        let made = proceduralize(&city, &data::settings(Mode::Best, 4, seed), &unwatched)
            .map_err(Error::method)?;
        let new = synthesize(&made.grammar, &shape, seed, &unwatched).map_err(Error::method)?;
        let derivation = new.derive().map_err(Error::method)?;
        if derivation.buildings.is_empty() {
            ctx.note(format!("{name}: no building fits into the letters."));
            continue;
        }
        let j = judge::judge(&made.grammar, &new, &shape, seed);
        let [w, d, h, near] = j.wasserstein;
        for (metric, value) in [
            ("wasserstein_width", w),
            ("wasserstein_depth", d),
            ("wasserstein_height", h),
            ("wasserstein_nearest", near),
            ("divergence", j.divergence),
            ("divergence_floor", j.floor),
            ("divergence_shuffled", j.shuffled),
            ("overlap", j.overlap),
            ("inside", j.inside),
            ("fill", j.fill),
            ("buildings", j.buildings),
        ] {
            ctx.observe(data::row(&name, "best", "3dv", metric, value, ""));
        }
        let three = |v: f64| format!("{v:.3}");
        let mut row = vec![name.clone(), format!("{:.0}", j.buildings)];
        row.extend([w, d, h, near, j.divergence, j.floor, j.shuffled].map(three));
        row.extend([j.overlap, j.inside, j.fill].map(three));
        table.row(row);
        // The made city is shown only where there is no real one, whose grammar would hold its data.
        if name == data::MADE && real {
            continue;
        }
        let picture =
            side_by_side(&[&derivation.city(&new)], width, width * 3 / 4).map_err(Error::method)?;
        let what = format!("{name}: {} buildings in the shape 3DV", j.buildings);
        ctx.attach(&format!("figure_9_{name}.png"), &picture, &what)?;
        if name == data::MADE {
            let file = format!("figure_9_{name}.city-grammar.bin");
            let bytes = grammar_file::to_bytes(&new, file.as_ref())?;
            ctx.attach(&file, &bytes, "the same as a grammar of instances")?;
        }
    }
    ctx.table(&table);
    ctx.note("W1/std: Wasserstein distance of the sizes of buildings, and of the distances to the nearest one, over the standard deviation in the original. Divergence: Jensen-Shannon, of how often types stand within 30 m; floor between random halves of the original (squares of 100 m), shuffled with the types of the new city in random order. Overlap and inside: shares of plan area. Fill: built share of the shape over that of the original.");
    Ok(())
}

/// The letters of the paper's example, `height` metres high, as rings.
fn letters(height: f64) -> Shape {
    let three = [
        [0.0, 0.0],
        [0.62, 0.0],
        [0.62, 1.0],
        [0.0, 1.0],
        [0.0, 0.78],
        [0.36, 0.78],
        [0.36, 0.61],
        [0.12, 0.61],
        [0.12, 0.39],
        [0.36, 0.39],
        [0.36, 0.22],
        [0.0, 0.22],
    ];
    let outer = [
        [0.82, 0.0],
        [1.24, 0.0],
        [1.5, 0.24],
        [1.5, 0.76],
        [1.24, 1.0],
        [0.82, 1.0],
    ];
    let inner = [
        [1.08, 0.24],
        [1.18, 0.24],
        [1.26, 0.34],
        [1.26, 0.66],
        [1.18, 0.76],
        [1.08, 0.76],
    ];
    let vee = [
        [1.98, 0.0],
        [2.22, 0.0],
        [2.56, 1.0],
        [2.28, 1.0],
        [2.1, 0.42],
        [1.92, 1.0],
        [1.64, 1.0],
    ];
    let scaled = |ring: &[[f64; 2]]| ring.iter().map(|p| p.map(|v| v * height)).collect();
    Shape {
        rings: vec![scaled(&three), scaled(&outer), scaled(&inner), scaled(&vee)],
    }
}
