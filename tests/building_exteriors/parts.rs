//! Parts of houses: every triangle in one, windows in their walls.

use edifice::io::building_json;
use edifice::methods::building_exteriors::house::parts::parts;
use edifice::methods::building_exteriors::house::{Joining, model};
use edifice::shape::PartKind;
use edifice::shape::solid::Finish;
use std::collections::{HashMap, HashSet};
use std::path::Path;

#[test]
fn every_triangle_of_a_house_is_in_one_part_and_every_element_in_a_wall() {
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("datasets/building_exteriors/houses.buildings.jsonl");
    for building in building_json::read(&shipped).unwrap().iter().step_by(7) {
        let model = model(building, Joining::Boxes).unwrap();
        let all = parts(building, &model);
        let mut seen: HashMap<[u32; 3], Finish> = HashMap::new();
        for (_, t, finish) in all.triangles() {
            assert_eq!(seen.insert(t, finish), None, "{}: twice", building.name);
        }
        let known: HashMap<[u32; 3], Finish> = model.surface.triangles.iter().copied().collect();
        assert_eq!(seen, known, "{}", building.name);
        let names: HashSet<&str> = all.parts.iter().map(|p| p.name.as_str()).collect();
        assert_eq!(names.len(), all.parts.len(), "{}: names", building.name);
        let placed = building.facades.iter().map(|p| p.elements.len());
        let placed = placed.sum::<usize>() - model.unplaced.len();
        let openings: Vec<_> = all.parts.iter().filter(|p| p.kind.is_opening()).collect();
        let garage = openings.iter().filter(|p| p.name.starts_with("garage"));
        assert_eq!(openings.len() - garage.count(), placed, "{}", building.name);
        for own in &openings {
            let place = format!("{} {}", building.name, own.name);
            let wall = own.wall.map(|k| all.parts[k].kind);
            assert_eq!(wall, Some(PartKind::WallSurface), "{place}");
            let shown = |f: &Finish| match own.kind {
                PartKind::Window => *f == Finish::Pane,
                _ => matches!(f, Finish::Door | Finish::GarageDoor),
            };
            assert!(own.triangles.iter().any(|(_, f)| shown(f)), "{place}");
            // Panes and leaves are in the element's rectangle, seen from the front.
            let rect = own.rect.unwrap();
            for (t, _) in own.triangles.iter().filter(|(_, f)| shown(f)) {
                for p in all.corners(*t) {
                    let along = (p[0] - rect.corner[0]) * rect.along[0]
                        + (p[1] - rect.corner[1]) * rect.along[1];
                    let up = p[2] - rect.corner[2];
                    let room = -1e-6..=rect.width + 1e-6;
                    assert!(room.contains(&along), "{place}: {along}");
                    assert!((-1e-6..=rect.height + 1e-6).contains(&up), "{place}: {up}");
                }
            }
        }
    }
}
