//! The products of a building, one for each part, and their relations.

use std::collections::BTreeMap;

use edifice_shape::solid::Finish;
use edifice_shape::{DetailedBuilding, Part, PartKind};
use serde_json::Value;

use super::properties::Sets;
use super::shapes::{self, Frame};
use super::step::{Id, Step, global_id, list, quoted, real};
use super::storeys::{Storey, aggregate};

/// A part that begins at most so far below a storey is on it (m).
const BELOW: f64 = 0.01;

/// The products while they are written.
pub(super) struct Products<'a> {
    pub(super) step: Step,
    pub(super) sets: Sets<'a>,
    pub(super) building: &'a DetailedBuilding,
    /// The context of bodies.
    pub(super) context: Id,
    pub(super) styles: BTreeMap<Finish, Id>,
    pub(super) storeys: Vec<Storey>,
    /// Instance and place of each part so far.
    pub(super) frames: Vec<(Id, Frame)>,
}

impl Products<'_> {
    /// The lines of the file, with all parts, the relations of storeys and roofs to them, and the common sets.
    pub(super) fn into_text(mut self) -> String {
        let building = self.building;
        for part in &building.parts {
            let product = if part.kind.is_opening() {
                self.opening(part)
            } else {
                self.surface(part)
            };
            self.frames.push(product);
            let attributes = &part.attributes;
            self.sets
                .own(&mut self.step, "part", &part.name, product.0, attributes);
        }
        for k in 0..self.storeys.len() {
            self.roof(k);
            let storey = &self.storeys[k];
            if !storey.elements.is_empty() {
                let id = self.id("storey/elements", &k.to_string());
                let elements = list(&storey.elements);
                let storey = storey.id;
                self.step.add(format_args!(
                    "IFCRELCONTAINEDINSPATIALSTRUCTURE({id},$,$,$,{elements},{storey})"
                ));
            }
        }
        self.sets.write(&mut self.step);
        self.step.into_text()
    }

    fn id(&self, kind: &str, name: &str) -> String {
        global_id(&[&self.building.name, kind, name])
    }

    /// The storey of a part: that of its attribute `floor`, else the highest that begins below it.
    fn storey(&self, part: &Part, low: f64) -> usize {
        let floor = part.attributes.get("floor").and_then(Value::as_u64);
        let floor = floor.and_then(|k| usize::try_from(k.saturating_sub(1)).ok());
        let below = || self.storeys.iter().rposition(|s| s.elevation < low + BELOW);
        floor
            .filter(|k| *k < self.storeys.len())
            .or_else(below)
            .unwrap_or(0)
    }

    /// A wall, a slab or what is attached.
    fn surface(&mut self, part: &Part) -> (Id, Frame) {
        let low = shapes::low_corner(self.building, part);
        let k = self.storey(part, low[2]);
        let outer = self.storeys[k].frame;
        let frame = Frame::new(&mut self.step, Some(&outer), low, [1.0, 0.0]);
        let is_chimney = part.triangles.iter().all(|(_, f)| *f == Finish::Chimney);
        let (class, predefined) = match part.kind {
            PartKind::WallSurface => ("Wall", "NOTDEFINED"),
            PartKind::RoofSurface => ("Slab", "ROOF"),
            PartKind::GroundSurface => ("Slab", "BASESLAB"),
            PartKind::OuterFloorSurface => ("Slab", "FLOOR"),
            PartKind::OuterCeilingSurface => ("Covering", "CEILING"),
            PartKind::BuildingInstallation if is_chimney => ("Chimney", "NOTDEFINED"),
            PartKind::BuildingInstallation | PartKind::Window | PartKind::Door => {
                ("BuildingElementProxy", "NOTDEFINED")
            }
        };
        let head = self.head(part, &frame);
        let class_name = class.to_uppercase();
        let product = self
            .step
            .add(format_args!("IFC{class_name}({head},.{predefined}.)"));
        self.sets.common(class, product);
        let storey = &mut self.storeys[k];
        match part.kind {
            PartKind::RoofSurface => storey.roofs.push(product),
            _ => storey.elements.push(product),
        }
        (product, frame)
    }

    /// A window or a door, in an opening of its wall if it has one.
    fn opening(&mut self, part: &Part) -> (Id, Frame) {
        let low = part
            .rect
            .map_or_else(|| shapes::low_corner(self.building, part), |r| r.corner);
        let along = part.rect.map_or([1.0, 0.0], |r| r.along);
        let k = self.storey(part, low[2]);
        let mut outer = self.storeys[k].frame;
        let mut hole = None;
        let wall = part.wall.and_then(|k| self.frames.get(k)).copied();
        if let Some((wall, around)) = wall {
            outer = Frame::new(&mut self.step, Some(&around), low, along);
            let name = quoted(&format!("opening_{}", part.name));
            let own = self.id("opening", &part.name);
            let opening = self.step.add(format_args!(
                "IFCOPENINGELEMENT({own},$,{name},$,$,{},$,$,.OPENING.)",
                outer.id
            ));
            let voids = self.id("voids", &part.name);
            self.step.add(format_args!(
                "IFCRELVOIDSELEMENT({voids},$,$,$,{wall},{opening})"
            ));
            hole = Some(opening);
        }
        let frame = Frame::new(&mut self.step, Some(&outer), low, along);
        let head = self.head(part, &frame);
        let size = part.rect.map_or("$,$".into(), |rect| {
            format!("{},{}", real(rect.height), real(rect.width))
        });
        let (class, kind) = match part.kind {
            PartKind::Door => ("Door", ".DOOR.,.NOTDEFINED.,$".to_owned()),
            _ => ("Window", format!(".WINDOW.,{}", partitioning(part))),
        };
        let class_name = class.to_uppercase();
        let product = self
            .step
            .add(format_args!("IFC{class_name}({head},{size},{kind})"));
        if let Some(hole) = hole {
            let fills = self.id("fills", &part.name);
            self.step.add(format_args!(
                "IFCRELFILLSELEMENT({fills},$,$,$,{hole},{product})"
            ));
        }
        self.sets.common(class, product);
        self.storeys[k].elements.push(product);
        (product, frame)
    }

    /// Attributes that all elements have: from `GlobalId` to `Tag`.
    fn head(&mut self, part: &Part, frame: &Frame) -> String {
        let shape = shapes::triangles(
            &mut self.step,
            self.building,
            part,
            frame,
            self.context,
            &self.styles,
        );
        let shape = shape.map_or("$".into(), |shape| shape.to_string());
        let style = style(part).map_or("$".into(), quoted);
        let id = self.id("part", &part.name);
        let name = quoted(&part.name);
        format!("{id},$,{name},$,{style},{},{shape},$", frame.id)
    }

    /// The roof whose planes begin in a storey.
    fn roof(&mut self, k: usize) {
        let planes = std::mem::take(&mut self.storeys[k].roofs);
        if planes.is_empty() {
            return;
        }
        let number = (k + 1).to_string();
        let id = self.id("roof", &number);
        let place = self.storeys[k].frame.id;
        let roof = self.step.add(format_args!(
            "IFCROOF({id},$,'Roof of storey {number}',$,$,{place},$,$,.NOTDEFINED.)"
        ));
        let id = self.id("roof/planes", &number);
        aggregate(&mut self.step, &id, roof, &planes);
        self.sets.common("Roof", roof);
        self.storeys[k].elements.push(roof);
    }
}

fn style(part: &Part) -> Option<&str> {
    part.attributes.get("style").and_then(Value::as_str)
}

/// The panels of a window by its style, where the style says it.
fn partitioning(part: &Part) -> String {
    match style(part) {
        Some("sash") => ".DOUBLE_PANEL_HORIZONTAL.,$".into(),
        Some("sliding") => ".DOUBLE_PANEL_VERTICAL.,$".into(),
        Some("fixed") => ".SINGLE_PANEL.,$".into(),
        Some(other) => format!(".USERDEFINED.,{}", quoted(other)),
        None => ".NOTDEFINED.,$".into(),
    }
}
