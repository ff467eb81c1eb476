//! Cities whose reference system counts in feet or other units, as metres.

use super::earth::unit_of;
use edifice_io::reference_system::IN_METRES;
use edifice_shape::triangles::City;

/// Makes coordinates, heights too, metres where the reference system is known to count in something else, and notes it. The reference
/// system is then called `EPSG:2263 in metres`.
pub(super) fn in_metres(city: &mut City) {
    let Some((system, unit)) = city
        .reference_system
        .as_ref()
        .and_then(|s| Some((s.clone(), unit_of(s)?)))
    else {
        return;
    };
    if (unit - 1.0).abs() < 1e-9 {
        return;
    }
    let before = city.origin;
    // Whole metres, as of all cities.
    let origin = before.map(|v| (v * unit).floor());
    for building in &mut city.buildings {
        let painted = building.paint.iter_mut().flat_map(|p| &mut p.corners);
        for p in building.mesh.positions.iter_mut().chain(painted) {
            *p = [0, 1, 2].map(|k| (p[k] + before[k]) * unit - origin[k]);
        }
    }
    city.origin = origin;
    city.notes.push(format!(
        "coordinates of {system}, heights too, are in units of {unit} m and were made metres"
    ));
    city.reference_system = Some(format!("{system}{IN_METRES}"));
}
