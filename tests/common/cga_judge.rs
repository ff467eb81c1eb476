//! A city by the rules of its grammar beside the same city evaluated from CGA, building by building.

use std::collections::BTreeMap;
use std::path::Path;

use edifice::grammar::instance::InstanceGrammar;
use edifice::io::city::cga;
use edifice::shape::triangles::City;

/// Volume in cubic metres, and bounds with the city's origin, of each building.
pub(crate) type Measures = BTreeMap<String, (f64, [[f64; 3]; 2])>;

/// The measures of a city.
pub(crate) fn measures(city: &City) -> Measures {
    let one = |b: &edifice::shape::triangles::CityBuilding| {
        let (low, high) = b.mesh.bounds()?;
        let shift = |p: [f64; 3]| [0, 1, 2].map(|k| p[k] + city.origin[k]);
        let volume = b.mesh.volume_above(low[2]);
        Some((b.id.clone(), (volume, [shift(low), shift(high)])))
    };
    city.buildings.iter().filter_map(one).collect()
}

/// Writes a grammar as `city.cga` into a folder, reads it, and holds each building against what the rules derive: number of
/// buildings, and the largest differences of volume, as a share, and of bounds, in metres.
pub(crate) fn judge(grammar: &InstanceGrammar, folder: &Path) -> (usize, f64, f64) {
    let path = folder.join("city.cga");
    cga::write(grammar, &path).unwrap();
    let found = measures(&cga::read(&path).unwrap());
    let rules = grammar.rules_only();
    let expected = measures(&rules.derive().unwrap().city(&rules));
    assert_eq!(
        found.keys().collect::<Vec<_>>(),
        expected.keys().collect::<Vec<_>>()
    );
    let (mut volume, mut bounds) = (0f64, 0f64);
    for ((id, a), b) in expected.iter().zip(found.values()) {
        let apart = (a.0 - b.0).abs() / a.0.abs().max(1e-3);
        let corners = a.1.iter().flatten().zip(b.1.iter().flatten());
        let moved = corners.map(|(p, q)| (p - q).abs()).fold(0.0, f64::max);
        assert!(apart < 1e-3, "{id}: {} and {} m3", a.0, b.0);
        assert!(moved < 0.01, "{id}: {:?} and {:?}", a.1, b.1);
        (volume, bounds) = (volume.max(apart), bounds.max(moved));
    }
    println!(
        "{} buildings: volume {volume:.1e}, bounds {bounds:.1e} m",
        found.len()
    );
    (found.len(), volume, bounds)
}
