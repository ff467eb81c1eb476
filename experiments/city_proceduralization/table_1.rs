//! Table 1: polygons, components, terminals and non-terminals of four levels.

use super::data::{self, Measures};
use edifice_base::Result;
use edifice_base::unwatched;
use edifice_city_proceduralization::{Detection, Mode};
use edifice_frame::Context;
use edifice_report::{Align, Table};

/// Levels: numbers of halvings of the components' number.
const LEVELS: [u32; 5] = [0, 1, 2, 3, 4];

/// Cities of more buildings are large: of their levels only some are run.
const LARGE: usize = 10_000;
const SHOWN_OF_LARGE: [u32; 2] = [2, 4];
/// `paper` is not run on cities of more buildings: at its last levels it compares all pairs of components.
const MOST_OF_PAPER: usize = 20_000;

/// Runs both modes on every city and level.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let seed = ctx.seed();
    let cities = data::all_cities(ctx)?;
    let buildings = |c: usize| cities[c].1.buildings.len();
    let large = |c: usize| buildings(c) > LARGE;
    let mut units = Vec::new();
    for c in 0..cities.len() {
        for mode in [Mode::Paper, Mode::Best] {
            // A template for each component is the same in both modes but for the closing of slabs.
            units.extend(
                LEVELS
                    .iter()
                    .filter(|&&l| l > 0 || mode == Mode::Best)
                    .filter(|_| mode == Mode::Best || buildings(c) <= MOST_OF_PAPER)
                    .filter(|l| !large(c) || SHOWN_OF_LARGE.contains(l))
                    .map(|&l| (c, mode, l)),
            );
        }
    }
    let key = |u: &(usize, Mode, u32)| format!("{}/{}/{}", cities[u.0].0, data::name(u.1), u.2);
    let run = |u: &(usize, Mode, u32)| {
        let mut settings = data::settings(u.1, u.2, seed);
        // Girvan-Newman takes hours on graphs of ten thousand edges.
        if cities[u.0].0 != "synthetic" {
            settings.detection = Detection::Louvain;
        }
        data::measure(&cities[u.0].1, &settings, &unwatched)
    };
    let results: Vec<Measures> = ctx.units(&units, key, run)?;
    let mut table = Table::new("Sizes of four levels")
        .column("city", Align::Left)
        .column("mode", Align::Left)
        .numbers([
            "level",
            "polygons",
            "texture bytes",
            "templates",
            "ratio to the parts",
            "ratio to the original",
            "non-terminals",
            "IoU",
            "bytes",
        ]);
    for ((c, mode, level), m) in units.iter().zip(&results) {
        let (name, city) = &cities[*c];
        let original = city.triangles() as f64;
        let instance = format!("level_{level}");
        for (metric, value, unit) in [
            ("polygons", m.polygons, ""),
            ("texture_bytes", m.texture_bytes, "B"),
            ("texture_bytes_soup", m.texture_soup, "B"),
            ("components", m.components, ""),
            ("ratio", m.soup / m.polygons, ""),
            ("ratio_original", original / m.polygons, ""),
            ("terminals", m.terminals, ""),
            ("non_terminals", m.non_terminals, ""),
            ("iou", m.iou, ""),
            ("bytes", m.bytes, "B"),
            ("seconds", m.seconds, "s"),
        ] {
            ctx.observe(data::row(
                name,
                data::name(*mode),
                &instance,
                metric,
                value,
                unit,
            ));
        }
        table.row([
            name.clone(),
            data::name(*mode).to_owned(),
            level.to_string(),
            format!("{:.0}", m.polygons),
            format!("{:.0}", m.texture_bytes),
            format!("{:.0}", m.terminals),
            format!("{:.2}", m.soup / m.polygons),
            format!("{:.2}", original / m.polygons),
            format!("{:.0}", m.non_terminals),
            format!("{:.4}", m.iou),
            format!("{:.0}", m.bytes),
        ]);
        if (*mode, *level, name.as_str()) == (Mode::Paper, 4, "midtown") {
            let ours = format!("{:.2}", m.soup / m.polygons);
            ctx.compare("polygons saved at level 4 (New York)", "9.71", ours);
        }
    }
    ctx.table(&table);
    ctx.note(
        "The paper prints 2,380 terminals beside 9,500 component types at level 1 of New York, where its Eq. 5 makes each type a terminal: \
         here terminals are the types. Communities of the real cities' types are found by Louvain's method; Delft and Manhattan are too large for the paper's, which compares all pairs of components. Of these cities only Chiba carries textures: \
         their bytes are shared out by the texels that a component shows, and a template brings those of its component.",
    );
    Ok(())
}
