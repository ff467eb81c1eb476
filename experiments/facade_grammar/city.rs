//! Fig. 15 and 16: a town of stochastic variations.

use std::time::Instant;

use super::runs::{Question, Solver, solve};
use super::{BEST, data, picture};
use edifice_base::rng::stream;
use edifice_base::{Error, Result};
use edifice_facade_grammar::city::{Settings, city};
use edifice_frame::Context;
use edifice_grammar::{Derivation, Grammar, Sampler, combine};
use edifice_io::gltf;
use edifice_io::scene_png::scene_png;
use edifice_report::{Figure, Row};

/// Layouts whose grammars are combined, group by group of similar structure.
type Groups = &'static [&'static [&'static str]];

pub(crate) const LOW_RISE: Groups = &[
    &["boulevard_1", "boulevard_2", "boulevard_3", "boulevard_4"],
    &["tenement_1", "tenement_2", "tenement_3", "tenement_4"],
    &["townhouse_1", "townhouse_2", "townhouse_3", "townhouse_4"],
];
pub(crate) const HIGH_RISE: Groups = &[&["office_1", "office_2", "office_3"]];

/// Draws for a variation in the picture: that whose parts are nearest to their own size is shown.
const DRAWS: usize = 4;

/// Low-rise buildings from twelve layouts.
pub(crate) fn figure_15(ctx: &mut Context) -> Result<()> {
    build(ctx, "figure_15", LOW_RISE, 3_600, ["12", "50 million"])
}

/// High-rise buildings from three layouts.
pub(crate) fn figure_16(ctx: &mut Context) -> Result<()> {
    build(ctx, "figure_16", HIGH_RISE, 120, ["3", "–"])
}

fn build(
    ctx: &mut Context,
    artefact: &str,
    groups: Groups,
    buildings: usize,
    printed: [&str; 2],
) -> Result<()> {
    let (few, _) = super::iterations(ctx.budget());
    let groups = &groups[..groups.len().min(ctx.budget().choose(1, 9, 9))];
    ctx.setting("iterations", few);
    ctx.setting("buildings", buildings);
    let folder = data::folder(ctx)?.join("layouts");
    let start = Instant::now();
    let styles: Result<Vec<Grammar>> = groups
        .iter()
        .map(|names| {
            let grammars: Result<Vec<Grammar>> = names
                .iter()
                .map(|name| {
                    let path = folder.join(format!("{name}.facade.json"));
                    let facade = edifice_io::facade_json::read(&path)?;
                    let question = Question::new(Solver::Infer(BEST, few), ctx.seed());
                    solve(std::slice::from_ref(&facade), &question).map(|(grammar, _)| grammar)
                })
                .collect();
            combine(&grammars?).map_err(Error::method)
        })
        .collect();
    let styles = styles?;
    let settings = Settings {
        buildings,
        ..Settings::default()
    };
    let town = city(&styles, &settings, ctx.seed()).map_err(Error::method)?;
    let bytes = gltf::to_bytes(&town.scene).map_err(Error::method)?;
    let seconds = start.elapsed().as_secs_f64();
    ctx.attach(&format!("{artefact}.glb"), &bytes, "the scene, binary glTF")?;
    let width = ctx.budget().choose(160, 592, 1280);
    for (what, said, camera, width) in [
        ("above", "over the roofs", town.from_above(), width),
        ("street", "in a street", town.in_the_street(), width * 3 / 4),
    ] {
        let picture =
            scene_png(&town.scene, &camera, width, width * 9 / 16).map_err(Error::method)?;
        ctx.attach(&format!("{artefact}_{what}.png"), &picture, said)?;
    }
    let inputs: usize = groups.iter().map(|g| g.len()).sum();
    let numbers = [
        ("buildings", town.buildings as f64, ""),
        ("input_facades", inputs as f64, ""),
        ("triangles", town.triangles as f64, ""),
        ("facades", town.facades as f64, ""),
        ("seconds", seconds, "s"),
    ];
    for (metric, value, unit) in numbers {
        ctx.observe(Row {
            dataset: "shipped".into(),
            method: "adp_best".into(),
            instance: "all".into(),
            metric: metric.into(),
            value,
            unit: unit.into(),
            ..Row::default()
        });
    }
    let millions = format!("{:.1} million triangles", town.triangles as f64 / 1e6);
    let theirs = if artefact == "figure_15" {
        "more than 3500"
    } else {
        "–"
    };
    ctx.compare("buildings", theirs, town.buildings.to_string());
    ctx.compare("input facades", printed[0], inputs.to_string());
    ctx.compare("polygons", printed[1], millions);
    ctx.compare_times("seconds, inference to file", "–", format!("{seconds:.1}"));
    let mut figure = Figure::new("variations at the input's size", 6).cell(230.0, 250.0);
    for index in 0..12 {
        let style = &styles[index % styles.len()];
        let sampler = Sampler::new(style).map_err(Error::method)?;
        let mut rng = stream(ctx.seed(), artefact, index as u64);
        let (width, height) = (style.starts[0].width, style.starts[0].height);
        let draws = (0..DRAWS).filter_map(|_| sampler.derive(0, width, height, &mut rng).ok());
        let draws = draws.filter(|drawn| drawn.shrunk.is_empty());
        let stretched =
            |a: &Derivation, b: &Derivation| sampler.stretch(a).total_cmp(&sampler.stretch(b));
        if let Some(drawn) = draws.min_by(stretched) {
            figure = figure.panel(picture::tiles("", &drawn.facade).without_borders());
        }
    }
    ctx.figure(artefact, &figure)?;
    ctx.note(
        "Grammars are inferred, made size-independent and combined into one stochastic grammar for each kind of house, without \
         the interactive editing that the paper used for its low-rise town. Of several draws the one whose parts are nearest to their own \
         size is taken: two floors drawn at the height of three would stretch their windows.",
    );
    Ok(())
}
