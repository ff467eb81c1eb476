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
mod storeys;

use edifice_shape::DetailedBuilding;
use edifice_shape::solid::Finish;

use products::Products;
use properties::Sets;
use shapes::Frame;
use step::{Id, Step, global_id, list, quoted};
use storeys::{aggregate, storeys};

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
