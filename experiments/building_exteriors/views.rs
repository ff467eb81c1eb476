//! Sheets of pictures: houses in perspective and boxes from above.

use edifice_base::{Error, Result};
use edifice_building_exteriors::house::Model;
use edifice_building_exteriors::house::scene::{Placed, scene};
use edifice_building_exteriors::mass::target::{PARTS, part};
use edifice_io::scene_png::picture_png;
use edifice_scene::render::Picture;
use edifice_scene::trace::{framing, trace};
use edifice_shape::{BoxStyle, Building, Facade, MassBox, Rect};

/// Directions of the views of a house.
pub(crate) const FRONT: [f32; 3] = [0.45, -0.42, -0.9];
pub(crate) const RIGHT: [f32; 3] = [-0.95, -0.42, -0.35];
pub(crate) const BACK: [f32; 3] = [-0.45, -0.42, 0.9];

/// Pixels between panels.
const GAP: usize = 6;
type Colour = [u8; 3];
const PAPER: Colour = [255, 255, 255];
const INK: Colour = [60, 60, 64];
const RED: Colour = [208, 36, 36];
const YELLOW: Colour = [246, 214, 84];
const MAIN: Colour = [206, 208, 212];
const GARAGE: Colour = [110, 176, 116];
const FRONT_PORCH: Colour = [96, 140, 214];
const BACK_PORCH: Colour = [222, 120, 110];

/// One picture of a sheet.
pub(crate) enum Panel<'a> {
    /// A house in perspective, with its colours and the direction of the view.
    House(&'a Model, usize, [f32; 3]),
    /// Boxes from above; those marked yellow were observed, those outlined in red were edited.
    Plan {
        boxes: &'a [MassBox],
        observed: &'a [MassBox],
        edited: &'a [MassBox],
    },
    /// Garage and porches in their bounding box as attributes say, before any repair; in red those that overlap or
    /// reach outside.
    Parts(&'a [f64; 49]),
    /// A facade with its windows and doors outlined in yellow, on its photograph if there is one.
    Marked {
        layout: &'a Facade,
        picture: Option<&'a Picture>,
    },
    /// Nothing: no house could be built.
    Empty,
}

/// The panel of a building's boxes.
pub(crate) fn plan(building: &Building) -> Panel<'_> {
    Panel::Plan {
        boxes: &building.boxes,
        observed: &[],
        edited: &[],
    }
}

/// Rows of panels as one PNG; `cell` is the size of a panel in pixels.
pub(crate) fn sheet(rows: &[Vec<Panel>], cell: [usize; 2]) -> Result<Vec<u8>> {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let size = |n: usize, extent: usize| n * extent + n.saturating_sub(1) * GAP;
    let mut canvas = Canvas::new(size(columns, cell[0]), size(rows.len(), cell[1]));
    for (r, row) in rows.iter().enumerate() {
        for (c, panel) in row.iter().enumerate() {
            let at = [c * (cell[0] + GAP), r * (cell[1] + GAP)];
            canvas.paste(&drawn(panel, cell), at);
        }
    }
    picture_png(&canvas.picture).map_err(Error::method)
}

fn drawn(panel: &Panel, [w, h]: [usize; 2]) -> Picture {
    match panel {
        Panel::House(model, colours, from) => {
            let scene = scene(&[Placed {
                name: "house",
                surface: &model.surface,
                at: [0.0; 2],
                colours: *colours,
            }]);
            trace(&scene, &framing(&scene, *from, w as f32 / h as f32), w, h)
        }
        Panel::Plan {
            boxes,
            observed,
            edited,
        } => boxes_from_above(boxes, observed, edited, [w, h]),
        Panel::Marked { layout, picture } => marked(layout, *picture, [w, h]),
        Panel::Parts(row) => parts_from_above(row, [w, h]),
        Panel::Empty => Canvas::new(w, h).picture,
    }
}

/// True for the label of a window or a door.
pub(crate) fn is_opening(label: &str) -> bool {
    matches!(label, "window" | "door")
}

/// The colour of a region of a facade that is drawn without a photograph.
fn material(label: &str) -> Colour {
    match label {
        "wall" => [222, 212, 192],
        "window" => [62, 72, 90],
        "door" => [96, 62, 38],
        "roof" => [122, 82, 70],
        "shutter" => [92, 116, 96],
        _ => [196, 186, 168],
    }
}

fn marked(layout: &Facade, picture: Option<&Picture>, size: [usize; 2]) -> Picture {
    let mut canvas = Canvas::new(size[0], size[1]);
    let place = Placement::new([0.0; 2], [layout.width, layout.height], size);
    let whole = place.of(&layout.domain());
    match picture {
        Some(picture) => canvas.stretch(picture, whole),
        None => {
            for region in &layout.regions {
                canvas.fill(place.of(&region.rect), material(&region.label));
            }
        }
    }
    canvas.outline(whole, INK, 1);
    for region in layout.regions.iter().filter(|r| is_opening(&r.label)) {
        canvas.outline(place.of(&region.rect), YELLOW, 2);
    }
    canvas.picture
}

fn boxes_from_above(
    boxes: &[MassBox],
    observed: &[MassBox],
    edited: &[MassBox],
    size: [usize; 2],
) -> Picture {
    let plans = || boxes.iter().chain(edited).map(MassBox::plan);
    let low = plans().fold([f64::INFINITY; 2], |m, r| [m[0].min(r.x), m[1].min(r.y)]);
    let high = plans().fold([f64::NEG_INFINITY; 2], |m, r| {
        [m[0].max(r.right()), m[1].max(r.top())]
    });
    let mut canvas = Canvas::new(size[0], size[1]);
    let place = Placement::new(low, high, size);
    let middle = (low[1] + high[1]) / 2.0;
    let mut order: Vec<&MassBox> = boxes.iter().collect();
    // Higher boxes lie on lower ones, parts on top.
    order.sort_by(|a, b| {
        let part = |b: &MassBox| b.style != BoxStyle::Main;
        part(a).cmp(&part(b)).then(a.height.total_cmp(&b.height))
    });
    for b in &order {
        let fill = match b.style {
            _ if observed.contains(b) => YELLOW,
            BoxStyle::Main => {
                let shade = (b.height * 9.0).min(80.0) as u8;
                MAIN.map(|c| c - shade)
            }
            BoxStyle::Garage => GARAGE,
            BoxStyle::Porch if b.y < middle => FRONT_PORCH,
            BoxStyle::Porch => BACK_PORCH,
        };
        canvas.fill(place.of(&b.plan()), fill);
        canvas.outline(place.of(&b.plan()), INK, 1);
    }
    for b in edited {
        canvas.outline(place.of(&b.plan()), RED, 3);
    }
    canvas.picture
}

fn parts_from_above(row: &[f64; 49], size: [usize; 2]) -> Picture {
    let (w, d) = (row[0], row[1]);
    let colours = [GARAGE, FRONT_PORCH, BACK_PORCH];
    let parts = PARTS.iter().zip(colours).filter_map(|((_, c, _), colour)| {
        let own = part(row, *c).filter(|_| row[c + 2].min(row[c + 3]) >= 0.5)?;
        let rect = Rect::new(own.x[0], own.y[0], own.x[1] - own.x[0], own.y[1] - own.y[0]);
        Some((rect, colour))
    });
    let parts: Vec<(Rect, Colour)> = parts.collect();
    let all = || parts.iter().map(|p| p.0);
    let low = all().fold([0.0, 0.0], |m: [f64; 2], r| [m[0].min(r.x), m[1].min(r.y)]);
    let high = all().fold([w, d], |m, r| [m[0].max(r.right()), m[1].max(r.top())]);
    let place = Placement::new(low, high, size);
    let mut canvas = Canvas::new(size[0], size[1]);
    let bounds = Rect::new(0.0, 0.0, w, d);
    canvas.fill(place.of(&bounds), [236, 236, 238]);
    canvas.outline(place.of(&bounds), INK, 1);
    for (rect, colour) in &parts {
        canvas.fill(place.of(rect), *colour);
        canvas.outline(place.of(rect), INK, 1);
    }
    for (k, (rect, _)) in parts.iter().enumerate() {
        let outside =
            rect.x < -0.1 || rect.y < -0.1 || rect.right() > w + 0.1 || rect.top() > d + 0.1;
        let others = parts.iter().enumerate().filter(|(j, _)| *j != k);
        if outside || others.map(|(_, p)| p.0.overlap(rect)).any(|a| a > 0.05) {
            canvas.outline(place.of(rect), RED, 3);
        }
    }
    canvas.picture
}

/// Metres to pixels, the front of the house below.
struct Placement {
    low: [f64; 2],
    scale: f64,
    shift: [f64; 2],
    height: f64,
}

impl Placement {
    fn new(low: [f64; 2], high: [f64; 2], size: [usize; 2]) -> Self {
        let size = size.map(|s| s as f64);
        let extent = [0, 1].map(|k| (high[k] - low[k]).max(1.0));
        let scale = (0.86 * size[0] / extent[0]).min(0.86 * size[1] / extent[1]);
        Self {
            low,
            scale,
            shift: [0, 1].map(|k| (size[k] - scale * extent[k]) / 2.0),
            height: size[1],
        }
    }

    /// Left, right, upper and lower pixel.
    fn of(&self, r: &Rect) -> [i64; 4] {
        let x = |v: f64| (self.shift[0] + self.scale * (v - self.low[0])).round() as i64;
        let y =
            |v: f64| (self.height - self.shift[1] - self.scale * (v - self.low[1])).round() as i64;
        [x(r.x), x(r.right()), y(r.top()), y(r.y)]
    }
}

/// A picture to draw rectangles into.
struct Canvas {
    picture: Picture,
}

impl Canvas {
    fn new(width: usize, height: usize) -> Self {
        Self {
            picture: Picture {
                width,
                height,
                rgb: PAPER.repeat(width * height),
            },
        }
    }

    fn fill(&mut self, [x0, x1, y0, y1]: [i64; 4], colour: Colour) {
        let (w, h) = (self.picture.width as i64, self.picture.height as i64);
        for y in y0.max(0)..y1.min(h) {
            for x in x0.max(0)..x1.min(w) {
                let at = 3 * (y * w + x) as usize;
                self.picture.rgb[at..at + 3].copy_from_slice(&colour);
            }
        }
    }

    fn outline(&mut self, [x0, x1, y0, y1]: [i64; 4], colour: Colour, thick: i64) {
        self.fill([x0, x1, y0, y0 + thick], colour);
        self.fill([x0, x1, y1 - thick, y1], colour);
        self.fill([x0, x0 + thick, y0, y1], colour);
        self.fill([x1 - thick, x1, y0, y1], colour);
    }

    /// Draws a picture into a rectangle, each pixel that of the nearest.
    fn stretch(&mut self, picture: &Picture, [x0, x1, y0, y1]: [i64; 4]) {
        let from = |v: i64, low: i64, high: i64, extent: usize| {
            let share = (v - low) as f64 / (high - low).max(1) as f64;
            ((share * extent as f64) as usize).min(extent.saturating_sub(1))
        };
        for y in y0..y1 {
            let row = from(y, y0, y1, picture.height);
            for x in x0..x1 {
                let at = 3 * (row * picture.width + from(x, x0, x1, picture.width));
                let Some(colour) = picture.rgb.get(at..at + 3) else {
                    continue;
                };
                self.fill([x, x + 1, y, y + 1], [colour[0], colour[1], colour[2]]);
            }
        }
    }

    fn paste(&mut self, panel: &Picture, [left, top]: [usize; 2]) {
        for row in 0..panel.height {
            let from = 3 * row * panel.width;
            let to = 3 * ((top + row) * self.picture.width + left);
            let length = 3 * panel.width;
            self.picture.rgb[to..to + length].copy_from_slice(&panel.rgb[from..from + length]);
        }
    }
}
