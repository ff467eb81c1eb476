//! The cities, and how a result is judged.

use serde::{Deserialize, Serialize};

use super::ingolstadt;
use edifice_base::{Ended, Error, Result, Watch};
use edifice_city_proceduralization::{Budget, Mode, Settings, judge, proceduralize};
use edifice_frame::Context;
use edifice_generators_city_proceduralization as synthetic;
use edifice_grammar::instance::Kept;
use edifice_io_city as city;
use edifice_report::Row;
use edifice_shape::triangles::{City, repair};

/// Real cities below the data folder, the first of which most artefacts take.
const REAL: [(&str, &str); 5] = [
    ("midtown", "city/nyc_midtown4500.npz"),
    ("chiba", "city/chiba_textured.tar.xz"),
    ("ingolstadt", "city/ingolstadt_lod3_semantic.json.gz"),
    ("delft", "city/delft_bag3d.npz"),
    ("manhattan", "city/nyc_manhattan_lod2.npz"),
];

/// Name of the made city.
pub(crate) const MADE: &str = "synthetic";

/// The made city, and with `--data` the smallest real one.
pub(crate) fn cities(ctx: &mut Context) -> Result<Vec<(String, City)>> {
    some_cities(ctx, 1)
}

/// The made city, and with `--data` all real ones.
pub(crate) fn all_cities(ctx: &mut Context) -> Result<Vec<(String, City)>> {
    some_cities(ctx, REAL.len())
}

fn some_cities(ctx: &mut Context, real: usize) -> Result<Vec<(String, City)>> {
    let motifs = ctx.budget().choose(16, 500, 500);
    ctx.setting("motifs", motifs);
    let mut found = vec![(MADE.to_owned(), synthetic::city(motifs, 0.0, ctx.seed()).0)];
    if ctx.budget() > edifice_frame::Budget::Smoke {
        for (name, file) in &REAL[..real] {
            if let Some(path) = ctx.real(file)? {
                let city = match *name {
                    "ingolstadt" => ingolstadt::read(&path)?,
                    _ => city::read(&path)?,
                };
                found.push(((*name).to_owned(), city));
            }
        }
    }
    Ok(found)
}

/// The made city, and with `--data` midtown and Delft.
pub(crate) fn three_cities(ctx: &mut Context) -> Result<Vec<(String, City)>> {
    let mut found = cities(ctx)?;
    if ctx.budget() > edifice_frame::Budget::Smoke {
        let (name, file) = REAL[3];
        if let Some(path) = ctx.real(file)? {
            found.push((name.to_owned(), city::read(&path)?));
        }
    }
    Ok(found)
}

/// The city with textures, with `--data`.
pub(crate) fn chiba(ctx: &mut Context) -> Result<Option<City>> {
    if ctx.budget() == edifice_frame::Budget::Smoke {
        return Ok(None);
    }
    let path = ctx.real(REAL[1].1)?;
    path.map(|path| city::read(&path)).transpose()
}

/// A result's measures.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct Measures {
    /// Triangles of the templates.
    pub polygons: f64,
    /// Components.
    pub components: f64,
    /// Triangles of all components, as cut.
    pub soup: f64,
    /// Bytes of the textures that the templates show.
    pub texture_bytes: f64,
    /// Bytes of the textures that all components show.
    pub texture_soup: f64,
    /// Terminals.
    pub terminals: f64,
    /// Non-terminals.
    pub non_terminals: f64,
    /// Volumetric intersection over union.
    pub iou: f64,
    /// Gzipped grammar without attributes.
    pub bytes: f64,
    /// Seconds.
    pub seconds: f64,
}

/// Names of modes.
pub(crate) fn name(mode: Mode) -> &'static str {
    match mode {
        Mode::Best => "best",
        Mode::Paper => "paper",
    }
}

/// Proceduralizes a city and measures the result by its derived triangles.
pub(crate) fn measure(city: &City, settings: &Settings, watch: &Watch) -> Result<Measures> {
    let start = std::time::Instant::now();
    let made = proceduralize(city, settings, watch).map_err(Error::method)?;
    if made.ended == Ended::Interrupted {
        return Err(Error::Interrupted);
    }
    let seconds = start.elapsed().as_secs_f64();
    let grammar = &made.grammar;
    Ok(Measures {
        polygons: grammar
            .templates
            .iter()
            .map(|t| t.mesh.triangles.len() as f64)
            .sum(),
        components: made.decomposition.components.len() as f64,
        soup: made
            .decomposition
            .components
            .iter()
            .map(|c| c.mesh.triangles.len() as f64)
            .sum(),
        texture_bytes: (made.types.representatives.iter())
            .map(|&c| made.decomposition.components[c].texture_bytes)
            .sum::<f64>(),
        texture_soup: (made.decomposition.components.iter())
            .map(|c| c.texture_bytes)
            .sum::<f64>(),
        terminals: grammar.templates.len() as f64,
        non_terminals: grammar.non_terminals() as f64,
        iou: judge::iou(city, grammar).map_err(Error::method)?,
        bytes: city::grammar_json::packed_bytes(&grammar.keeping(Kept::Identifiers))
            .map_err(Error::method)? as f64,
        seconds,
    })
}

/// A city whose meshes are repaired as the method repairs them.
pub(crate) fn repaired(city: &City) -> City {
    let mut out = city.clone();
    for building in &mut out.buildings {
        building.mesh = repair(&building.mesh).0;
    }
    out
}

/// Settings of a mode at a level; level 0 is a template for each component.
pub(crate) fn settings(mode: Mode, level: u32, seed: u64) -> Settings {
    Settings {
        mode,
        budget: if level == 0 {
            Budget::All
        } else {
            Budget::Level(level)
        },
        seed,
        ..Settings::default()
    }
}

/// A row of the CSV.
pub(crate) fn row(
    dataset: &str,
    method: &str,
    instance: &str,
    metric: &str,
    value: f64,
    unit: &str,
) -> Row {
    Row {
        dataset: dataset.to_owned(),
        method: method.to_owned(),
        instance: instance.to_owned(),
        metric: metric.to_owned(),
        value,
        unit: unit.to_owned(),
        ..Row::default()
    }
}
