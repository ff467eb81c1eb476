//! Houses from photographs: Fig. 17 of Fan and Wonka 2016, on facades that ship.

use super::data;
use super::views::{BACK, FRONT, Panel, RIGHT, is_opening, sheet};
use edifice_base::{Error, Result};
use edifice_building_exteriors::design::{
    FacadeHouse, Facades, MarkedFacade, eaves, from_facades, in_metres,
};
use edifice_building_exteriors::house::{Database, Options};
use edifice_building_exteriors::model_file::ModelFile;
use edifice_frame::Context;
use edifice_io::{facade_json, footprint, pixels};
use edifice_report::{Align, Row, Table};
use edifice_scene::render::Picture;
use edifice_shape::{AnnotatedFacade, Facade, Rect, Side, elements_of_facade};

/// The model that ships.
const MODEL: &str = "building_exteriors/real.houses.json";
/// Straight on the front, with a little of the roof.
const STRAIGHT: [f32; 3] = [0.0, -0.12, -1.0];

/// A house of the figure: its facades with their scale, and its plan.
struct Case {
    name: &'static str,
    facades: &'static [(Side, &'static str)],
    /// Height of the eaves (m) for layouts in pixels.
    height: Option<f64>,
    plan: Plan,
}

/// A ground plan: a shipped file, or rectangles in metres.
enum Plan {
    Shipped(&'static str),
    Rectangles(&'static [Rect]),
}

const fn rect(x: f64, y: f64, width: f64, height: f64) -> Rect {
    Rect {
        x,
        y,
        width,
        height,
    }
}

const CASES: [Case; 3] = [
    Case {
        name: "photograph",
        facades: &[
            (Side::Front, "examples/front.facade.json"),
            (Side::Right, "examples/right.facade.json"),
        ],
        height: Some(6.0),
        plan: Plan::Shipped("examples/lot.geojson"),
    },
    Case {
        name: "cottage_1",
        facades: &[(Side::Front, "facade_grammar/layouts/cottage_1.facade.json")],
        height: None,
        plan: Plan::Rectangles(&[rect(0.0, 0.0, 10.5, 7.5), rect(0.0, 7.5, 5.5, 3.0)]),
    },
    Case {
        name: "cottage_2",
        facades: &[(Side::Front, "facade_grammar/layouts/cottage_2.facade.json")],
        height: None,
        plan: Plan::Rectangles(&[rect(0.0, 0.0, 8.45, 9.0)]),
    },
];

/// A case that was read.
struct Input {
    /// The first facade as it ships.
    first: AnnotatedFacade,
    facades: Vec<MarkedFacade>,
    plan: Vec<Rect>,
}

fn input(ctx: &mut Context, case: &Case) -> Result<Input> {
    let mut first = None;
    let mut facades: Vec<MarkedFacade> = Vec::new();
    for (side, file) in case.facades {
        let path = ctx.shipped(file)?;
        let read = facade_json::parse_annotated(&edifice_io::read_bytes(&path)?, &path)?;
        let height = case.height.filter(|_| read.facade.unit == "px");
        let elements = Facade {
            height: eaves(&read.facade),
            ..elements_of_facade(&read.facade)
        };
        facades.push(MarkedFacade {
            side: *side,
            layout: in_metres(*side, &elements, None, height).map_err(Error::method)?,
        });
        first.get_or_insert(read);
    }
    let plan = match &case.plan {
        Plan::Shipped(file) => footprint::read(&ctx.shipped(file)?)?,
        Plan::Rectangles(rects) => rects.to_vec(),
    };
    let first = first.ok_or_else(|| Error::method("a case without a facade"))?;
    Ok(Input {
        first,
        facades,
        plan,
    })
}

/// The photograph of a layout as a picture.
fn photograph(layout: &AnnotatedFacade) -> Result<Option<Picture>> {
    let Some(own) = &layout.photograph else {
        return Ok(None);
    };
    let (width, rgb) = pixels::colours(own.bytes()).map_err(Error::method)?;
    Ok(Some(Picture {
        width,
        height: rgb.len() / width.max(1),
        rgb: rgb.into_iter().flatten().collect(),
    }))
}

/// Fig. 17: three houses of facades with marked windows and doors, and of footprints.
pub(crate) fn figure_17(ctx: &mut Context) -> Result<()> {
    let path = ctx.shipped(MODEL)?;
    let text = String::from_utf8(edifice_io::read_bytes(&path)?).map_err(Error::method)?;
    let model = ModelFile::from_json(&text).map_err(Error::method)?;
    let database = Database::new(data::shipped(ctx)?.buildings).map_err(Error::method)?;
    let mut table = Table::new("Houses of facades with marked windows and doors")
        .column("house", Align::Left)
        .numbers([
            "facades",
            "windows and doors",
            "placed",
            "farthest from its mark (cm)",
            "storeys",
            "implausible",
        ]);
    let mut all = Vec::new();
    for case in &CASES {
        let input = input(ctx, case)?;
        let wanted = Facades {
            name: case.name,
            facades: &input.facades,
            plan: &input.plan,
            count: 1,
            seed: ctx.seed(),
        };
        let mut houses =
            from_facades(&wanted, &model, &database, &Options::default()).map_err(Error::method)?;
        let house = houses.swap_remove(0);
        tell(ctx, &mut table, case, &house);
        let picture = photograph(&input.first)?;
        all.push((input.first.facade, picture, house));
    }
    let panels: Vec<Vec<Panel>> = all
        .iter()
        .enumerate()
        .map(|(k, (layout, picture, made))| {
            let seen = Panel::Marked {
                layout,
                picture: picture.as_ref(),
            };
            let model = &made.house.model;
            let views = [STRAIGHT, FRONT, RIGHT, BACK];
            let views = views.map(|from| Panel::House(model, k + 2, from));
            [seen].into_iter().chain(views).collect()
        })
        .collect();
    let cell = ctx.budget().choose([60, 44], [320, 232], [320, 232]);
    let png = sheet(&panels, cell)?;
    ctx.attach("figure_17.png", &png, "three houses, each of a front with marked windows and doors (in yellow; the first is a photograph, of which a marked right side is given too) and a footprint: what was marked, the front straight on, from the left, from the right, from behind")?;
    ctx.table(&table);
    ctx.note(
        "As `edifice building from-facades` makes them, with the model that ships: what is marked stays where it is, roofs and other \
         sides are the model's. The cottages are made layouts, whose roofs and trim are no windows or doors.",
    );
    Ok(())
}

fn tell(ctx: &mut Context, table: &mut Table, case: &Case, made: &FacadeHouse) {
    let openings = || made.marked.iter().filter(|m| is_opening(&m.label));
    let placed = || openings().filter_map(|m| m.placed.as_ref().ok());
    let off = 100.0 * placed().fold(0.0, |most: f64, off| most.max(*off));
    table.row([
        case.name.to_owned(),
        case.facades.len().to_string(),
        openings().count().to_string(),
        placed().count().to_string(),
        format!("{off:.2}"),
        made.storeys.to_string(),
        made.findings.len().to_string(),
    ]);
    let share = placed().count() as f64 / openings().count().max(1) as f64;
    for (metric, value, unit) in [("placed", share, ""), ("farthest", off, "cm")] {
        ctx.observe(Row {
            dataset: "shipped".into(),
            method: "from_facades".into(),
            instance: case.name.into(),
            seed: Some(ctx.seed()),
            metric: metric.into(),
            value,
            unit: unit.into(),
            ..Row::default()
        });
    }
}
