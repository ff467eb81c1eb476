//! Facades with marked windows and doors: lengths in metres, and their place on the sides of a ground plan.

use edifice_shape::{ElementStyle, Facade, PlanUnion, Rect, Region, Side};

use super::facades_error::FacadesError;

/// Units of length that a layout may have, and metres in each.
const UNITS: [(&str, f64); 5] = [
    ("m", 1.0),
    ("cm", 0.01),
    ("mm", 0.001),
    ("ft", 0.3048),
    ("in", 0.0254),
];
/// Largest relative difference between the width of a facade and that of the side it is put on, and between the heights
/// of two facades.
const SAME_SCALE: f64 = 0.05;
/// Narrowest door (m), and the widest gap between two leaves of one door.
pub(super) const NARROWEST_DOOR: f64 = 0.6;
const GAP: f64 = 0.15;
/// Share of the width of a layout that its roof covers.
const ACROSS: f64 = 0.9;
/// Lengths nearer than this are the same (m).
const SAME: f64 = 0.01;

/// A side of a house as a rectified photograph shows it: from one corner to the other, from the ground to the eaves.
#[derive(Debug, Clone, PartialEq)]
pub struct MarkedFacade {
    /// The side.
    pub side: Side,
    /// The layout as it is seen from outside, in metres; of its regions windows and doors are used.
    pub layout: Facade,
}

/// A marked window or door on its side of the house.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Mark {
    pub side: Side,
    /// Indices of the regions of the layout; several for the leaves of one door.
    pub regions: Vec<usize>,
    /// The style that the label tells; `None` for a window of any style.
    pub style: Option<ElementStyle>,
    /// Its place: along the side in coordinates of the house, and over the ground.
    pub rect: Rect,
}

impl Mark {
    pub(super) fn is_door(&self) -> bool {
        self.style == Some(ElementStyle::Door)
    }
}

/// The layout in metres. Without a width and height (metres) its unit must be a length; with one of them the other follows,
/// with both the layout is stretched to them.
///
/// # Errors
/// [`FacadesError::Unit`] for another unit without a scale, [`FacadesError::Scale`] for a scale that is not a positive number.
pub fn in_metres(
    side: Side,
    layout: &Facade,
    width: Option<f64>,
    height: Option<f64>,
) -> Result<Facade, FacadesError> {
    if let Some(value) = [width, height]
        .into_iter()
        .flatten()
        .find(|v| !(v.is_finite() && *v > 0.0))
    {
        return Err(FacadesError::Scale { value });
    }
    let [x, y] = match (width, height) {
        (Some(w), Some(h)) => [w / layout.width, h / layout.height],
        (Some(w), None) => [w / layout.width; 2],
        (None, Some(h)) => [h / layout.height; 2],
        (None, None) => match UNITS.iter().find(|(name, _)| *name == layout.unit) {
            Some((_, metres)) => [*metres; 2],
            None => {
                let unit = layout.unit.clone();
                return Err(FacadesError::Unit { side, unit });
            }
        },
    };
    let scaled = |r: &Region| Region {
        label: r.label.clone(),
        rect: Rect::new(
            r.rect.x * x,
            r.rect.y * y,
            r.rect.width * x,
            r.rect.height * y,
        ),
    };
    Ok(Facade {
        name: layout.name.clone(),
        unit: "m".into(),
        width: layout.width * x,
        height: layout.height * y,
        regions: layout.regions.iter().map(scaled).collect(),
    })
}

/// The eaves of a layout, in its unit: the lower edge of a region `roof` that reaches over nearly its whole width, else its
/// height.
pub fn eaves(layout: &Facade) -> f64 {
    let roofs = layout
        .regions
        .iter()
        .filter(|r| r.label.eq_ignore_ascii_case("roof") && r.rect.width >= ACROSS * layout.width);
    let lower = roofs.map(|r| r.rect.y).filter(|y| *y > 0.0);
    lower.fold(layout.height, f64::min)
}

/// The style that a label tells: `None` for what is neither window nor door, `Some(None)` for a window of any style. A
/// number or a capital may follow the word, as in `window2`.
fn style_of(label: &str) -> Option<Option<ElementStyle>> {
    const WORDS: [(&str, Option<ElementStyle>); 7] = [
        ("window", None),
        ("door", Some(ElementStyle::Door)),
        ("sash", Some(ElementStyle::Sash)),
        ("sliding", Some(ElementStyle::Sliding)),
        ("casement", Some(ElementStyle::Casement)),
        ("bay", Some(ElementStyle::Bay)),
        ("fixed", Some(ElementStyle::Fixed)),
    ];
    let label = label.to_lowercase();
    let word = label.trim_end_matches(|c: char| !c.is_alphabetic());
    let word = word.strip_suffix('s').unwrap_or(word);
    let own = |name: &str| word == name || label.trim() == name;
    WORDS.into_iter().find(|(name, _)| own(name)).map(|w| w.1)
}

/// The width of a side of a plan in metres, and where it starts.
fn extent(side: Side, plan: &[Rect]) -> [f64; 2] {
    let bounds = PlanUnion::new(plan).bounding_box();
    let bounds = bounds.unwrap_or(Rect::new(0.0, 0.0, 0.0, 0.0));
    match side {
        Side::Front | Side::Back => [bounds.x, bounds.width],
        Side::Left | Side::Right => [bounds.y, bounds.height],
    }
}

/// The marks of all facades on a plan, and the height of the eaves (m): that of the first facade. Facades that are narrower or wider than
/// their side by at most 5 % stand in its middle.
///
/// # Errors
/// [`FacadesError`] for facades that do not fit the plan or each other, or that have neither windows nor doors.
pub(super) fn marks(
    facades: &[MarkedFacade],
    plan: &[Rect],
) -> Result<(Vec<Mark>, f64), FacadesError> {
    let first = facades.first().ok_or(FacadesError::NoFacade)?;
    let height = first.layout.height;
    let mut marks = Vec::new();
    for (k, facade) in facades.iter().enumerate() {
        let (side, layout) = (facade.side, &facade.layout);
        if facades[..k].iter().any(|f| f.side == side) {
            return Err(FacadesError::Twice { side });
        }
        if layout.unit != "m" {
            let unit = layout.unit.clone();
            return Err(FacadesError::Unit { side, unit });
        }
        let [start, width] = extent(side, plan);
        if (layout.width - width).abs() > SAME_SCALE * width {
            return Err(FacadesError::Width {
                side,
                facade: layout.width,
                plan: width,
            });
        }
        if (layout.height - height).abs() > SAME_SCALE * height {
            return Err(FacadesError::Height {
                side,
                facade: layout.height,
                first: first.side,
                height,
            });
        }
        let shift = (width - layout.width) / 2.0;
        // Seen from outside, the back and the left run against their coordinate.
        let mirrored = matches!(side, Side::Back | Side::Left);
        let mut own: Vec<Mark> = Vec::new();
        for (index, region) in layout.regions.iter().enumerate() {
            let Some(style) = style_of(&region.label) else {
                continue;
            };
            let r = region.rect;
            let u = match mirrored {
                true => start + width - shift - r.right(),
                false => start + shift + r.x,
            };
            let [u, y, w, h] = [u, r.y, r.width, r.height].map(millimetres);
            let mark = Mark {
                side,
                regions: vec![index],
                style,
                rect: Rect::new(u, y, w, h),
            };
            match own.iter_mut().find(|m| are_leaves(m, &mark)) {
                Some(door) => join(door, &mark),
                None => own.push(mark),
            }
        }
        if own.is_empty() {
            return Err(FacadesError::NoElements { side });
        }
        marks.extend(own);
    }
    Ok((marks, height))
}

/// True for two doors beside each other, equally high, each too narrow for a door of its own.
fn are_leaves(a: &Mark, b: &Mark) -> bool {
    let (p, q) = (a.rect, b.rect);
    let near = |u: f64, v: f64| (u - v).abs() < SAME;
    let gap = (q.x - p.right()).max(p.x - q.right());
    a.is_door()
        && b.is_door()
        && p.width.min(q.width) < NARROWEST_DOOR
        && near(p.y, q.y)
        && near(p.height, q.height)
        && (-SAME..=GAP).contains(&gap)
}

fn millimetres(v: f64) -> f64 {
    (v * 1e3).round() / 1e3
}

fn join(door: &mut Mark, leaf: &Mark) {
    door.regions.extend(&leaf.regions);
    let (p, q) = (door.rect, leaf.rect);
    let (low, high) = (p.x.min(q.x), p.right().max(q.right()));
    door.rect = Rect::new(low, p.y, millimetres(high - low), p.height);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_tell_windows_doors_and_styles() {
        assert_eq!(style_of("window"), Some(None));
        assert_eq!(style_of("Window2"), Some(None));
        assert_eq!(style_of("windows"), Some(None));
        assert_eq!(style_of("door"), Some(Some(ElementStyle::Door)));
        assert_eq!(style_of("sash"), Some(Some(ElementStyle::Sash)));
        assert_eq!(style_of("bay"), Some(Some(ElementStyle::Bay)));
        assert_eq!(style_of("balcony"), None);
        assert_eq!(style_of("doorstep"), None);
    }
}
