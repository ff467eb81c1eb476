//! Buildings in parts as IFC4: products with surfaces, storeys, openings and properties.
//!
//! The schema is IFC4 (ISO 16739-1:2018, IFC 4 ADD2 TC1) in the clear text of ISO 10303-21. Lengths are metres, z up;
//! coordinates are rounded to a micrometre.
//!
//! | in the building | in the file |
//! | --- | --- |
//! | the building | `IfcProject`, `IfcSite` and `IfcBuilding`, one in another |
//! | attributes `storeysAboveGround`, `floorHeight` | an `IfcBuildingStorey` at each multiple of the height |
//! | `WallSurface` | `IfcWall` |
//! | `RoofSurface` | `IfcSlab` (`ROOF`), those of a storey in one `IfcRoof` |
//! | `GroundSurface` | `IfcSlab` (`BASESLAB`) |
//! | `OuterFloorSurface` | `IfcSlab` (`FLOOR`) |
//! | `OuterCeilingSurface` | `IfcCovering` (`CEILING`) |
//! | `Window`, `Door` | `IfcWindow`, `IfcDoor` with the width and the height of the rectangle |
//! | `BuildingInstallation` | `IfcChimney` where all of it is a chimney, else `IfcBuildingElementProxy` |
//! | triangles | `IfcTriangulatedFaceSet`, one for each finish, with an `IfcSurfaceStyle` |
//! | the wall of a window or a door | `IfcOpeningElement`, `IfcRelVoidsElement`, `IfcRelFillsElement` |
//! | attributes | `IfcPropertySet` `Edifice` |
//!
//! Walls are surfaces that have their holes already. Therefore an `IfcOpeningElement` has a place, the lower left corner of
//! the rectangle, and no shape: there is nothing to cut. With a box as its shape, also one that is a representation
//! `Reference`, which the standard has for openings that the body of a wall leaves out, `IfcOpenShell` 0.9 cuts the open
//! surface; where edges of the box lie on edges of the hole, it adds the sides of the box to the wall.
//!
//! The sets `Pset_WallCommon`, `Pset_WindowCommon` and so on say that all is external. A `GlobalId` is a digest of the
//! name of the building and the name of the part, so that a house that is written again has the same ones; the
//! time in the head is that of Unix time 0, and there is no `IfcOwnerHistory`.

mod products;
mod properties;
mod shapes;
mod step;

use edifice_shape::DetailedBuilding;
use edifice_shape::solid::Finish;
use serde_json::Value;

use products::Products;
use properties::Sets;
use shapes::Frame;
use step::{Id, Step, exact, global_id, list, quoted};

/// Most storeys that are written; a building that says it had more gets so many.
const MOST_STOREYS: u64 = 200;

/// The text of a file. Its bytes depend on the building and the colours (red, green, blue) alone.
///
/// All coordinates have to be finite. Panes are written with a transparency.
pub fn to_text(building: &DetailedBuilding, colour: impl Fn(Finish) -> [u8; 3]) -> String {
    let mut step = Step::default();
    let axes = outermost(&mut step);
    let context = format!("IFCGEOMETRICREPRESENTATIONCONTEXT($,'Model',3,1.E-05,{axes},$)");
    let context = step.add(context);
    let body = step.add(format_args!(
        "IFCGEOMETRICREPRESENTATIONSUBCONTEXT('Body','Model',*,*,*,*,{context},$,.MODEL_VIEW.,$)"
    ));
    let units = units(&mut step);
    let name = quoted(&building.name);
    let id = |class: &str| global_id(&[&building.name, class]);
    let project = format!(
        "IFCPROJECT({},$,{name},$,$,$,$,({context}),{units})",
        id("project")
    );
    let project = step.add(project);
    let frame = Frame::new(&mut step, None, [0.0; 3], [1.0, 0.0]);
    let site = format!(
        "IFCSITE({},$,'Site',$,$,{},$,$,.ELEMENT.,$,$,$,$,$)",
        id("site"),
        frame.id
    );
    let site = step.add(site);
    let frame = Frame::new(&mut step, Some(&frame), [0.0; 3], [1.0, 0.0]);
    let whole = format!(
        "IFCBUILDING({},$,{name},$,$,{},$,$,.ELEMENT.,$,$,$)",
        id("building"),
        frame.id
    );
    let whole = step.add(whole);
    let storeys = storeys(&mut step, building, &frame);
    aggregate(&mut step, &id("project/sites"), project, &[site]);
    aggregate(&mut step, &id("site/buildings"), site, &[whole]);
    let ids: Vec<Id> = storeys.iter().map(|s| s.id).collect();
    aggregate(&mut step, &id("building/storeys"), whole, &ids);

    let sets = Sets::new(&building.name);
    sets.own(&mut step, "building", "", whole, &building.attributes);
    let styles = shapes::styles(&mut step, building, &colour);
    let products = Products {
        step,
        sets,
        building,
        context: body,
        styles,
        storeys,
        frames: Vec::new(),
    };
    format!(
        "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION(('ViewDefinition [NotYetAssigned]'),'2;1');\n\
         FILE_NAME({},'1970-01-01T00:00:00',(''),(''),'Edifice {1}','Edifice {1}','');\n\
         FILE_SCHEMA(('IFC4'));\nENDSEC;\nDATA;\n{2}ENDSEC;\nEND-ISO-10303-21;\n",
        quoted(&format!("{}.ifc", building.name)),
        env!("CARGO_PKG_VERSION"),
        products.into_text(),
    )
}

/// A storey, and the products on it.
struct Storey {
    id: Id,
    /// Height of its floor above that of the first (m).
    elevation: f64,
    frame: Frame,
    elements: Vec<Id>,
    /// Planes of roofs that begin in it.
    roofs: Vec<Id>,
}

/// The storeys of a building, at least one.
fn storeys(step: &mut Step, building: &DetailedBuilding, frame: &Frame) -> Vec<Storey> {
    let attribute = |name: &str| building.attributes.get(name);
    let height = attribute("floorHeight").and_then(Value::as_f64);
    let count = attribute("storeysAboveGround").and_then(Value::as_u64);
    let (height, count) = match (height, count) {
        (Some(height), Some(count)) if height > 0.0 => (height, count.clamp(1, MOST_STOREYS)),
        _ => (0.0, 1),
    };
    let storey = |k: u64| {
        let elevation = k as f64 * height;
        let frame = Frame::new(step, Some(frame), [0.0, 0.0, elevation], [1.0, 0.0]);
        let number = (k + 1).to_string();
        let id = global_id(&[&building.name, "storey", &number]);
        let id = step.add(format_args!(
            "IFCBUILDINGSTOREY({id},$,'Storey {number}',$,$,{},$,$,.ELEMENT.,{})",
            frame.id,
            exact(elevation)
        ));
        Storey {
            id,
            elevation,
            frame,
            elements: Vec::new(),
            roofs: Vec::new(),
        }
    };
    (0..count).map(storey).collect()
}

/// Relates parts to their whole; no parts, no relation.
fn aggregate(step: &mut Step, id: &str, whole: Id, parts: &[Id]) {
    if !parts.is_empty() {
        step.add(format_args!(
            "IFCRELAGGREGATES({id},$,$,$,{whole},{})",
            list(parts)
        ));
    }
}

fn outermost(step: &mut Step) -> Id {
    let at = shapes::point(step, [0.0; 3]);
    step.share(format_args!("IFCAXIS2PLACEMENT3D({at},$,$)"))
}

/// Metres, their squares and cubes, radians.
fn units(step: &mut Step) -> Id {
    let all = [
        ("LENGTHUNIT", "METRE"),
        ("AREAUNIT", "SQUARE_METRE"),
        ("VOLUMEUNIT", "CUBIC_METRE"),
        ("PLANEANGLEUNIT", "RADIAN"),
    ];
    let all = all.map(|(kind, name)| step.add(format_args!("IFCSIUNIT(*,.{kind}.,$,.{name}.)")));
    step.add(format_args!("IFCUNITASSIGNMENT({})", list(all)))
}
