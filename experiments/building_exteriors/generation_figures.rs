//! Figures of generated houses: Fig. 6 and 15 of Fan and Wonka 2016.

use super::{data, settings};
use edifice_base::rng::stream;
use edifice_base::{Error, Result};
use edifice_building_exteriors::design::possible_rows;
use edifice_building_exteriors::house::scene::{Placed, scene};
use edifice_building_exteriors::house::{Database, Options, generate};
use edifice_building_exteriors::mass::anneal::{AnnealSettings, anneal};
use edifice_building_exteriors::mass::{MASS, MassTarget, SearchLimits, search};
use edifice_frame::Context;
use edifice_io::building_json;
use edifice_io::scene_png::picture_png;
use edifice_report::{Align, Chart, Figure, Scale, Series, Table};
use edifice_scene::trace::{framing, trace};

/// Fig. 6: energy of mass models against iterations.
pub(crate) fn figure_6(ctx: &mut Context) -> Result<()> {
    let shipped = data::shipped(ctx)?;
    let seed = ctx.seed();
    let iterations = ctx.budget().choose(500, 10_000, 10_000);
    ctx.setting("iterations", iterations);
    let database = Database::new(shipped.buildings).map_err(Error::method)?;
    let mut chart = Chart::new(
        "",
        Scale::new("iteration"),
        Scale::new("energy (Eq. 3)").log(),
    );
    for (k, house) in [2_usize, 40].into_iter().enumerate() {
        let target = MassTarget::new(std::array::from_fn(|c| {
            database.rows[house][c].unwrap_or(0.0)
        }));
        let settings = AnnealSettings {
            iterations,
            ..AnnealSettings::default()
        };
        let (model, steps) = anneal(&target, &database.deviations[..MASS], &settings, seed)
            .map_err(Error::method)?;
        let run = steps.iter().min_by(|a, b| {
            let last = |s: &[edifice_optim::Step]| s.last().map_or(f64::INFINITY, |s| s.best);
            last(a).total_cmp(&last(b))
        });
        let points = run
            .into_iter()
            .flatten()
            .filter(|s| s.best < 1e5 && s.iteration % 20 == 0);
        let points: Vec<(f64, f64)> = points
            .map(|s| (s.iteration as f64, s.best.max(1e-6)))
            .collect();
        chart = chart.series(Series::line(format!("paper, mass model {}", k + 1), points));
        let options = SearchLimits {
            leave_out: Some(house),
            ..SearchLimits::default()
        };
        let mut rng = stream(seed, "building_exteriors/figure_6", house as u64);
        let best = search(&target, &[], &database, &options, &mut rng).map_err(Error::method)?;
        ctx.compare(
            format!(
                "mass model {}: largest distance (standard deviations) and evaluations",
                k + 1
            ),
            "not printed",
            format!(
                "paper {:.3} after {}, best {:.4} after {}",
                model.max_z, model.evaluations, best.max_z, best.evaluations
            ),
        );
    }
    ctx.figure(
        "figure_6",
        &Figure::single("energy of two mass models", chart),
    )
}

/// Fig. 15: six synthesized houses.
pub(crate) fn figure_15(ctx: &mut Context) -> Result<()> {
    let shipped = data::shipped(ctx)?;
    let seed = ctx.seed();
    let settings = settings(ctx);
    let learned = data::learned(&shipped.data, &settings, seed)?;
    let database = Database::new(shipped.buildings).map_err(Error::method)?;
    let mut rng = stream(seed, "building_exteriors/figure_15", 0);
    let mut houses = Vec::new();
    // One house of each of the first six styles shows what the styles are.
    for k in 0..6 {
        let style = k % learned.model.styles();
        let possible = possible_rows(
            1,
            &[false; 49],
            &database.deviations,
            |_| 0.0,
            || {
                let draws = learned.model.sample_style(style, 1, &mut rng);
                draws.map(|d| d.table).map_err(Error::method)
            },
        )?;
        let wanted = possible.rows[0];
        let name = format!("house_{}", k + 1);
        let made = generate(
            &name,
            &wanted,
            &[false; 49],
            &database,
            &Options::default(),
            &mut rng,
        );
        houses.push(made.map_err(Error::method)?);
    }
    let size = ctx.budget().choose([120, 80], [960, 600], [960, 600]);
    let mut placed = Vec::new();
    let mut corner = [0.0, 0.0];
    let mut deep = 0.0_f64;
    for (k, house) in houses.iter().enumerate() {
        if k == 3 {
            corner = [0.0, deep + 8.0];
        }
        placed.push(Placed {
            name: &house.building.name,
            surface: &house.model.surface,
            at: corner,
            colours: k,
        });
        corner[0] += house.report.reached[0] + 6.0;
        deep = deep.max(house.report.reached[1]);
    }
    let scene = scene(&placed);
    let camera = framing(&scene, [0.4, -0.45, -0.9], size[0] as f32 / size[1] as f32);
    let picture = trace(&scene, &camera, size[0], size[1]);
    let bytes = picture_png(&picture).map_err(Error::method)?;
    ctx.attach("figure_15.png", &bytes, "six synthesized houses")?;
    let glb = edifice_io::gltf::to_bytes(&scene).map_err(Error::method)?;
    ctx.attach("figure_15.glb", &glb, "the same as a scene")?;
    for house in &houses {
        let name = &house.building.name;
        let text = building_json::to_string(&house.building).map_err(Error::method)?;
        let file = format!("figure_15_{name}.building.json");
        ctx.attach(&file, text.as_bytes(), name)?;
    }
    let mut out = Table::new("Six houses drawn from the model, one of each of the first styles")
        .column("house", Align::Left)
        .numbers([
            "floors",
            "boxes",
            "triangles",
            "max z",
            "max z from the repaired row",
        ]);
    for house in &houses {
        out.row([
            house.building.name.clone(),
            house.building.floors().to_string(),
            house.building.boxes.len().to_string(),
            house.report.triangles.to_string(),
            format!("{:.3}", house.report.max_z),
            format!("{:.4}", house.report.repaired_z),
        ]);
    }
    ctx.table(&out);
    Ok(())
}
