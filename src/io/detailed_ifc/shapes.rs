//! Placements, bodies and colours.

use std::collections::BTreeMap;

use edifice_shape::solid::Finish;
use edifice_shape::vec3::sub;
use edifice_shape::{DetailedBuilding, Part};

use super::step::{Id, Step, exact, list, real};

/// Share of the light that passes through a pane.
const TRANSPARENCY: f64 = 0.6;

/// A level system of coordinates with its `IfcLocalPlacement`; its second axis is `along` turned to the left.
#[derive(Debug, Clone, Copy)]
pub(super) struct Frame {
    pub(super) id: Id,
    /// In the coordinates of the building (m).
    origin: [f64; 3],
    /// Unit vector of the first axis in the coordinates of the building.
    along: [f64; 2],
}

impl Frame {
    /// A frame in another one, or the outermost one; origin and direction are in the coordinates of the building.
    pub(super) fn new(
        step: &mut Step,
        outer: Option<&Frame>,
        origin: [f64; 3],
        along: [f64; 2],
    ) -> Self {
        let (at, [c, s]) = match outer {
            Some(outer) => (outer.local(origin), outer.turned(along)),
            None => (origin, along),
        };
        let at = point(step, at);
        let axes = if [c, s] == [1.0, 0.0] {
            "$,$".to_owned()
        } else {
            let up = step.share("IFCDIRECTION((0.,0.,1.))");
            let ahead = list([exact(c), exact(s), real(0.0)]);
            format!("{up},{}", step.share(format_args!("IFCDIRECTION({ahead})")))
        };
        let axes = step.share(format_args!("IFCAXIS2PLACEMENT3D({at},{axes})"));
        let outer = outer.map_or("$".to_owned(), |outer| outer.id.to_string());
        let id = step.add(format_args!("IFCLOCALPLACEMENT({outer},{axes})"));
        Self { id, origin, along }
    }

    /// A point in the coordinates of the frame.
    fn local(&self, p: [f64; 3]) -> [f64; 3] {
        let [x, y, z] = sub(p, self.origin);
        let [x, y] = self.turned([x, y]);
        [x, y, z]
    }

    fn turned(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [c, s] = self.along;
        [c * x + s * y, c * y - s * x]
    }
}

/// An `IfcCartesianPoint`.
pub(super) fn point(step: &mut Step, p: impl IntoIterator<Item = f64>) -> Id {
    step.share(format_args!(
        "IFCCARTESIANPOINT({})",
        list(p.into_iter().map(real))
    ))
}

/// The lowest coordinates of a part, 0 of one without triangles (m).
pub(super) fn low_corner(building: &DetailedBuilding, part: &Part) -> [f64; 3] {
    let corners = part
        .triangles
        .iter()
        .flat_map(|(t, _)| building.corners(*t));
    let low = corners.reduce(|a, b| [0, 1, 2].map(|i| f64::min(a[i], b[i])));
    low.unwrap_or_default()
}

/// The finishes of a building as `IfcSurfaceStyle`, in the order of the finishes.
pub(super) fn styles(
    step: &mut Step,
    building: &DetailedBuilding,
    colour: &dyn Fn(Finish) -> [u8; 3],
) -> BTreeMap<Finish, Id> {
    let mut all = BTreeMap::new();
    let mut used: Vec<Finish> = building.triangles().map(|(_, _, f)| f).collect();
    used.sort_unstable();
    used.dedup();
    for finish in used {
        let [r, g, b] = colour(finish).map(|c| real(f64::from(c) / 255.0));
        let colour = step.share(format_args!("IFCCOLOURRGB($,{r},{g},{b})"));
        let through = if finish == Finish::Pane {
            TRANSPARENCY
        } else {
            0.0
        };
        let shading = step.share(format_args!(
            "IFCSURFACESTYLESHADING({colour},{})",
            real(through)
        ));
        let name = format!("{finish:?}").to_lowercase();
        let style = format_args!("IFCSURFACESTYLE('{name}',.BOTH.,({shading}))");
        all.insert(finish, step.add(style));
    }
    all
}

/// The triangles of a part as an `IfcProductDefinitionShape`: one list of points and a set of triangles for each finish.
/// None for a part without triangles.
pub(super) fn triangles(
    step: &mut Step,
    building: &DetailedBuilding,
    part: &Part,
    frame: &Frame,
    context: Id,
    styles: &BTreeMap<Finish, Id>,
) -> Option<Id> {
    if part.triangles.is_empty() {
        return None;
    }
    let mut numbers: BTreeMap<u32, usize> = BTreeMap::new();
    let mut points = Vec::new();
    let mut sets: BTreeMap<Finish, Vec<String>> = BTreeMap::new();
    for (triangle, finish) in &part.triangles {
        let corners = triangle.map(|v| {
            *numbers.entry(v).or_insert_with(|| {
                points.push(list(frame.local(building.positions[v as usize]).map(real)));
                points.len()
            })
        });
        sets.entry(*finish).or_default().push(list(corners));
    }
    let points = step.add(format_args!("IFCCARTESIANPOINTLIST3D({})", list(points)));
    let mut items = Vec::new();
    for (finish, corners) in sets {
        let corners = list(corners);
        let item = step.add(format_args!(
            "IFCTRIANGULATEDFACESET({points},$,.F.,{corners},$)"
        ));
        if let Some(style) = styles.get(&finish) {
            step.add(format_args!("IFCSTYLEDITEM({item},({style}),$)"));
        }
        items.push(item);
    }
    let items = list(items);
    let body = step.add(format_args!(
        "IFCSHAPEREPRESENTATION({context},'Body','Tessellation',{items})"
    ));
    Some(step.add(format_args!("IFCPRODUCTDEFINITIONSHAPE($,$,({body}))")))
}
