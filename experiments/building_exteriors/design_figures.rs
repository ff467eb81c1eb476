//! Completion and design: Fig. 16, 18 and 19 of Fan and Wonka 2016, on made houses that the model has not seen.

use super::held_out::{HELD_OUT, has_no_garage};
use super::views::{BACK, FRONT, Panel, RIGHT, plan, sheet};
use super::{data, settings};
use edifice_base::rng::stream;
use edifice_base::{Error, Result};
use edifice_building_exteriors::coding::Coding;
use edifice_building_exteriors::design::{Edit, completions, edited, observed, suggested};
use edifice_building_exteriors::house::walls::walls_of_pieces;
use edifice_building_exteriors::house::{Database, Generated, Joining, Options, model};
use edifice_building_exteriors::mass::iou;
use edifice_building_exteriors::model_file::ModelFile;
use edifice_frame::Context;
use edifice_report::{Align, Row, Table};
use edifice_shape::{BoxStyle, Building, Side};

/// Completions of a house (Sec. 7).
const COMPLETIONS: usize = 5;

/// A model and a database of donors that have not seen the last houses.
struct Learned {
    model: ModelFile,
    database: Database,
    held_out: Vec<Building>,
}

fn learned(ctx: &mut Context) -> Result<Learned> {
    let shipped = data::shipped(ctx)?;
    let settings = settings(ctx);
    let mut buildings = shipped.buildings;
    let held_out = buildings.split_off(buildings.len() - HELD_OUT);
    let seen = shipped
        .data
        .select(&(0..buildings.len()).collect::<Vec<_>>());
    let found = data::learned(&seen, &settings, ctx.seed())?;
    Ok(Learned {
        model: ModelFile {
            groups: seen.groups,
            coding: Coding::Published,
            model: found.model.clone(),
        },
        database: Database::new(buildings).map_err(Error::method)?,
        held_out,
    })
}

/// The part of a house that a photograph from the front shows: the boxes whose walls face the street, and the facade
/// pieces on them.
fn seen_from_the_street(house: &Building) -> Building {
    let walls = walls_of_pieces(house);
    let front = house.facades.iter().zip(&walls);
    let front: Vec<_> = front.filter(|(p, _)| p.side == Side::Front).collect();
    let shows = |at: f64| {
        front
            .iter()
            .any(|(_, w)| w.is_some_and(|w| (w.at - at).abs() < 1e-6))
    };
    let boxes = house.boxes.iter();
    let seen = boxes.filter(|b| shows(b.plan().y) || (b.style == BoxStyle::Porch && b.y < 4.0));
    Building {
        boxes: seen.copied().collect(),
        facades: front.iter().map(|(p, _)| (*p).clone()).collect(),
        special: Vec::new(),
        ..house.clone()
    }
}

/// Completions of a held-out house, best fit first, with the partial house.
fn completed(ctx: &Context, learned: &Learned, index: usize) -> Result<(Building, Vec<Generated>)> {
    let partial = seen_from_the_street(&learned.held_out[index]);
    let given = observed(&partial, &[]).map_err(Error::method)?;
    let houses = completions(
        &partial,
        &learned.model,
        &given,
        COMPLETIONS,
        &learned.database,
        &Options::default(),
        ctx.seed(),
    );
    Ok((partial, houses.map_err(Error::method)?))
}

fn cell(ctx: &Context) -> [usize; 2] {
    ctx.budget().choose([60, 44], [320, 232], [320, 232])
}

fn watched(building: &Building) -> Result<edifice_building_exteriors::house::Model> {
    model(building, Joining::Boxes).map_err(Error::method)
}

/// Fig. 16: a completion beside the truth.
pub(crate) fn figure_16(ctx: &mut Context) -> Result<()> {
    let learned = learned(ctx)?;
    let mut rows = Vec::new();
    let mut table = overlap_table("Completions of held-out houses from their front");
    let many = ctx.budget().choose(2, HELD_OUT, HELD_OUT);
    for index in 0..many {
        let (partial, houses) = completed(ctx, &learned, index)?;
        let truth = &learned.held_out[index];
        tell(ctx, &mut table, truth, &partial, &houses);
        if index == 0 {
            let best = closest(truth, &houses);
            rows = vec![partial, truth.clone(), houses[best].building.clone()];
        }
    }
    let models = rows.iter().map(watched).collect::<Result<Vec<_>>>()?;
    let panels: Vec<Vec<Panel>> = models
        .iter()
        .zip(&rows)
        .map(|(made, building)| {
            let views = [FRONT, RIGHT, BACK].map(|from| Panel::House(made, 1, from));
            let observed = Panel::Plan {
                boxes: &building.boxes,
                observed: &rows[0].boxes,
                edited: &[],
            };
            views.into_iter().chain([observed]).collect()
        })
        .collect();
    let png = sheet(&panels, cell(ctx))?;
    ctx.attach("figure_16.png", &png, "from above: what is seen from the street, the truth, the closest of five completions; front, right, back, boxes (observed in yellow)")?;
    ctx.table(&table);
    ctx.note(
        "The last 20 made houses are held out of the model and of the donors. Observed are the boxes and the facade \
         pieces that face the street; the model is told the sizes of a garage or porch among them, the front's window-to-wall ratio, \
         symmetry and alignment, and the styles seen. The size of the whole house is not observed.",
    );
    Ok(())
}

/// Fig. 18: several completions of one house.
pub(crate) fn figure_18(ctx: &mut Context) -> Result<()> {
    let learned = learned(ctx)?;
    let (partial, houses) = completed(ctx, &learned, 5)?;
    let first = watched(&partial)?;
    let row = |made, building, from: &[[f32; 3]]| -> Vec<Panel> {
        let views = from.iter().map(|f| Panel::House(made, 4, *f));
        views.chain([building]).collect()
    };
    let views = [FRONT, BACK];
    let mut panels = vec![row(&first, plan(&partial), &views)];
    for house in houses.iter().take(3) {
        let boxes = Panel::Plan {
            boxes: &house.building.boxes,
            observed: &partial.boxes,
            edited: &[],
        };
        panels.push(row(&house.model, boxes, &views));
    }
    let png = sheet(&panels, cell(ctx))?;
    ctx.attach(
        "figure_18.png",
        &png,
        "what was observed, and three completions: front, back, boxes (observed in yellow)",
    )?;
    let mut table = overlap_table("Completions of one house");
    tell(ctx, &mut table, &learned.held_out[5], &partial, &houses);
    ctx.table(&table);
    Ok(())
}

fn overlap_table(title: &str) -> Table {
    Table::new(title).column("house", Align::Left).numbers([
        "boxes observed",
        "of",
        "completions",
        "same bits",
        "best 1 - IoU of the plan",
        "apart from each other (mean 1 - IoU)",
        "max z of the first",
    ])
}

fn closest(truth: &Building, houses: &[Generated]) -> usize {
    let far = |h: &Generated| 1.0 - iou(truth, &h.building);
    let order = (0..houses.len()).min_by(|&a, &b| far(&houses[a]).total_cmp(&far(&houses[b])));
    order.unwrap_or(0)
}

fn tell(
    ctx: &mut Context,
    table: &mut Table,
    truth: &Building,
    partial: &Building,
    houses: &[Generated],
) {
    let keeps = |h: &&Generated| {
        partial.boxes.iter().all(|b| h.building.boxes.contains(b))
            && partial
                .facades
                .iter()
                .all(|p| h.building.facades.contains(p))
    };
    let same = houses.iter().filter(keeps).count();
    let best = 1.0 - iou(truth, &houses[closest(truth, houses)].building);
    let mut apart = Vec::new();
    for (i, a) in houses.iter().enumerate() {
        apart.extend(
            houses[..i]
                .iter()
                .map(|b| 1.0 - iou(&a.building, &b.building)),
        );
    }
    let mean = apart.iter().sum::<f64>() / apart.len().max(1) as f64;
    table.row([
        truth.name.clone(),
        partial.boxes.len().to_string(),
        truth.boxes.len().to_string(),
        houses.len().to_string(),
        same.to_string(),
        format!("{best:.3}"),
        format!("{mean:.3}"),
        format!("{:.4}", houses[0].report.repaired_z),
    ]);
    for (metric, value) in [
        ("distance_of_plan", best),
        ("same_bits", same as f64 / houses.len() as f64),
    ] {
        ctx.observe(Row {
            dataset: "shipped".into(),
            method: "best".into(),
            instance: truth.name.clone(),
            seed: Some(ctx.seed()),
            metric: metric.into(),
            value,
            ..Row::default()
        });
    }
}

/// Fig. 19: a garage is added, moved to the back, and a box is resized; after each edit the model suggests a house.
pub(crate) fn figure_19(ctx: &mut Context) -> Result<()> {
    let learned = learned(ctx)?;
    let start = learned
        .held_out
        .iter()
        .find(|house| has_no_garage(house))
        .unwrap_or(&learned.held_out[0]);
    let options = Options::default();
    let mut rng = stream(ctx.seed(), "building_exteriors/figure_19", 0);
    let mut stages: Vec<(String, Building, Vec<edifice_shape::MassBox>, f64)> =
        vec![("initial".into(), start.clone(), Vec::new(), 0.0)];
    let (w, d) = (extent(start)[0], extent(start)[1]);
    // Beside the left wall, half a metre inside it.
    let garage = [-1.4, 3.4, 3.8, 6.0, 2.5];
    let steps: [(&str, Next); 3] = [
        ("garage added in front", &|_| {
            Edit::Add(BoxStyle::Garage, garage)
        }),
        ("garage moved to the back", &|h| {
            Edit::Move(find(h, BoxStyle::Garage), [-1.4, extent(h)[1] - 3.4])
        }),
        ("main box resized", &|h| {
            let k = find(h, BoxStyle::Main);
            let b = &h.boxes[k];
            Edit::Resize(k, [0.8 * b.width, b.depth, b.height])
        }),
    ];
    for (name, edit) in steps {
        let house = &stages[stages.len() - 1].1;
        let edit = edit(house);
        let clock = std::time::Instant::now();
        let found = suggested(
            house,
            &[edit],
            &learned.model,
            &learned.database,
            &options,
            &mut rng,
        )
        .or_else(|_| edited(house, &[edit], &learned.database, &options, &mut rng))
        .map_err(Error::method)?;
        let seconds = clock.elapsed().as_secs_f64();
        let old = &house.boxes;
        let touched = found.building.boxes.iter().filter(|b| match edit {
            Edit::Add(style, _) => b.style == style,
            Edit::Move(k, _) => b.style == old[k].style,
            Edit::Resize(_, [w, d, h]) => [b.width, b.depth, b.height] == [w, d, h],
            Edit::Remove(_) => false,
        });
        let touched = touched.copied().collect();
        stages.push((name.into(), found.building, touched, seconds));
    }
    let models: Vec<_> = stages
        .iter()
        .map(|s| watched(&s.1))
        .collect::<Result<_>>()?;
    let panels: Vec<Vec<Panel>> = models
        .iter()
        .zip(&stages)
        .map(|(made, (_, building, touched, _))| {
            vec![
                Panel::House(made, 3, FRONT),
                Panel::House(made, 3, BACK),
                Panel::Plan {
                    boxes: &building.boxes,
                    observed: &[],
                    edited: touched,
                },
            ]
        })
        .collect();
    let png = sheet(&panels, cell(ctx))?;
    ctx.attach("figure_19.png", &png, "from above: the initial house, a garage added, the garage moved to the back, a box made narrower; front, back, boxes (edited in red)")?;
    let mut table = Table::new("An editing sequence")
        .column("stage", Align::Left)
        .numbers(["boxes", "width (m)", "depth (m)"])
        .times(["seconds"]);
    for (name, building, _, seconds) in &stages {
        table.row([
            name.clone(),
            building.boxes.len().to_string(),
            format!("{:.2}", extent(building)[0]),
            format!("{:.2}", extent(building)[1]),
            format!("{seconds:.3}"),
        ]);
        ctx.observe(Row {
            dataset: "shipped".into(),
            method: "best".into(),
            instance: name.clone(),
            seed: Some(ctx.seed()),
            metric: "seconds".into(),
            value: *seconds,
            unit: "s".into(),
            ..Row::default()
        });
    }
    ctx.table(&table);
    ctx.note(format!(
        "The initial house is a held-out one without a garage, {w:.1} m x {d:.1} m. After each edit the edited box, the bounding box, garage, \
         porches and styles are given, and the model answers the rest."
    ));
    Ok(())
}

/// The next edit of a house.
type Next<'a> = &'a dyn Fn(&Building) -> Edit;

fn find(house: &Building, style: BoxStyle) -> usize {
    let own = house
        .boxes
        .iter()
        .enumerate()
        .filter(|(_, b)| b.style == style);
    let largest = own.max_by(|a, b| (a.1.width * a.1.depth).total_cmp(&(b.1.width * b.1.depth)));
    largest.map_or(0, |(k, _)| k)
}

fn extent(house: &Building) -> [f64; 2] {
    let bounds = edifice_building_exteriors::mass::target::bounds(house);
    bounds.map(|[low, high]| high - low)
}
