//! Places on the earth: earth-centred, earth-fixed coordinates (ECEF, EPSG 4978) of cities in a projected reference system.

use proj4rs::Proj;
use proj4rs::transform::transform;

use super::citygml::system::epsg;
use super::faceted::unit;
use edifice_io::reference_system::IN_METRES;
use edifice_shape::vec3::{cross, sub};

/// Semi-major axis of the ellipsoid of WGS 84, in metres, and its flattening.
const AXIS: f64 = 6_378_137.0;
pub(super) const FLATTENING: f64 = 1.0 / 298.257_223_563;
/// Directions of the grid are measured over so many metres.
const REACH: f64 = 100.0;

/// The matrix, column by column, that puts a city on the earth, if its reference system is known, for example `EPSG:7415`: coordinates
/// in metres, less `origin`, z up, become earth-centred ones. It is exact at `middle`, a point of the city; at a distance d from there, it
/// is off by d² / 12,700 km, since the earth is round. Heights are taken for heights above the ellipsoid.
pub fn place(system: &str, origin: [f64; 3], middle: [f64; 3]) -> Option<[f64; 16]> {
    let from = projection(system.strip_suffix(IN_METRES).unwrap_or(system))?;
    let metres = from.to_meter();
    if (metres - 1.0).abs() > 1e-9 && !system.ends_with(IN_METRES) {
        return None;
    }
    let to = Proj::from_proj_string("+proj=longlat +datum=WGS84 +no_defs").ok()?;
    let at = |x: f64, y: f64| -> Option<[f64; 3]> {
        let [x, y] = [origin[0] + middle[0] + x, origin[1] + middle[1] + y].map(|v| v / metres);
        let mut point = (x, y, 0.0);
        transform(&from, &to, &mut point).ok()?;
        let place = earth_centred(point.0, point.1, origin[2] + middle[2]);
        place.iter().all(|v| v.is_finite()).then_some(place)
    };
    let here = at(0.0, 0.0)?;
    let (a, b) = (at(-REACH, 0.0)?, at(REACH, 0.0)?);
    let east = unit(sub(b, a))?;
    let (c, d) = (at(0.0, -REACH)?, at(0.0, REACH)?);
    let up = unit(cross(east, sub(d, c)))?;
    let north = cross(up, east);
    let moved = |k: usize| here[k] - east[k] * middle[0] - north[k] * middle[1] - up[k] * middle[2];
    let [e, n, u] = [east, north, up];
    Some([
        e[0],
        e[1],
        e[2],
        0.0,
        n[0],
        n[1],
        n[2],
        0.0,
        u[0],
        u[1],
        u[2],
        0.0,
        moved(0),
        moved(1),
        moved(2),
        1.0,
    ])
}

/// The height of a plane above the earth at a distance from where they touch, both in metres.
pub(super) fn bend(distance: f64) -> f64 {
    distance * distance / (2.0 * AXIS)
}

/// Metres in a unit of a projected reference system, if it is known.
pub(super) fn unit_of(system: &str) -> Option<f64> {
    Some(projection(system)?.to_meter())
}

/// The projection of a reference system, if it is known and is one.
fn projection(system: &str) -> Option<Proj> {
    let code = u16::try_from(epsg(system)?).ok()?;
    let plan = HORIZONTAL.iter().find(|(whole, _)| *whole == code);
    let definition = crs_definitions::from_code(plan.map_or(code, |p| p.1))?;
    let projection = Proj::from_proj_string(definition.proj4).ok()?;
    (!projection.is_latlong() && !projection.is_geocent()).then_some(projection)
}

/// Compound systems, and the horizontal ones in them.
const HORIZONTAL: [(u16, u16); 6] = [
    (7415, 28992),
    (5554, 25831),
    (5555, 25832),
    (5556, 25833),
    (7405, 27700),
    (5698, 2154),
];

/// Earth-centred coordinates of a place, by longitude and latitude in radians and height above the ellipsoid in metres.
pub(super) fn earth_centred(longitude: f64, latitude: f64, height: f64) -> [f64; 3] {
    let square = FLATTENING * (2.0 - FLATTENING);
    let (sin, cos) = latitude.sin_cos();
    let normal = AXIS / (1.0 - square * sin * sin).sqrt();
    let (s, c) = longitude.sin_cos();
    [
        (normal + height) * cos * c,
        (normal + height) * cos * s,
        (normal * (1.0 - square) + height) * sin,
    ]
}

/// Longitude and latitude in radians and height above the ellipsoid in metres of a place, by earth-centred coordinates: within 1 µm and
/// 1e-12 radians for places up to 100 km above the ellipsoid and 20 km below it.
pub fn geodetic([x, y, z]: [f64; 3]) -> [f64; 3] {
    let square = FLATTENING * (2.0 - FLATTENING);
    let flat = x.hypot(y);
    let mut latitude = z.atan2(flat * (1.0 - square));
    // Each step divides the error by 150.
    for _ in 0..8 {
        let sin = latitude.sin();
        let normal = AXIS / (1.0 - square * sin * sin).sqrt();
        latitude = (z + square * normal * sin).atan2(flat);
    }
    let (sin, cos) = latitude.sin_cos();
    let height = flat * cos + z * sin - AXIS * (1.0 - square * sin * sin).sqrt();
    [y.atan2(x), latitude, height]
}

#[cfg(test)]
mod tests {
    use super::{earth_centred, place};
    use edifice_base::rng::stream;
    use rand::RngExt;
    use std::f64::consts::{FRAC_PI_2, PI};

    /// Longitude and latitude in degrees and height in metres.
    fn geodetic(p: [f64; 3]) -> [f64; 3] {
        let [x, y, z] = super::geodetic(p);
        [x.to_degrees(), y.to_degrees(), z]
    }

    /// The example of EPSG Guidance Note 7-2, and the ends of the axes of WGS 84.
    #[test]
    fn published_places_are_where_they_are_published() {
        let degrees = |d: f64, m: f64, s: f64| (d + m / 60.0 + s / 3600.0).to_radians();
        let (longitude, latitude) = (degrees(2.0, 7.0, 46.38), degrees(53.0, 48.0, 33.82));
        for (place, at) in [
            (
                [longitude, latitude, 73.0],
                [3_771_793.968, 140_253.342, 5_124_304.349],
            ),
            ([0.0, 0.0, 0.0], [6_378_137.0, 0.0, 0.0]),
            ([0.0, FRAC_PI_2, 0.0], [0.0, 0.0, 6_356_752.314_245]),
        ] {
            let found = earth_centred(place[0], place[1], place[2]);
            let back = super::geodetic(at);
            for k in 0..3 {
                assert!((found[k] - at[k]).abs() < 1e-3, "{found:?}");
                assert!(
                    (back[k] - place[k]).abs() < [1e-9, 1e-9, 1e-3][k],
                    "{back:?}"
                );
            }
        }
    }

    #[test]
    fn geodetic_coordinates_lead_back_to_their_place() {
        let mut rng = stream(1, "places", 0);
        for case in 0..5000 {
            let longitude = rng.random_range(-PI..PI);
            let latitude = match case % 10 {
                0 => FRAC_PI_2 * if case % 20 == 0 { 1.0 } else { -1.0 },
                1 => rng.random_range(-1e-6..1e-6),
                _ => rng.random_range(-FRAC_PI_2..FRAC_PI_2),
            };
            let height = rng.random_range(-2e4..1e5);
            let [x, y, z] = super::geodetic(earth_centred(longitude, latitude, height));
            assert!((z - height).abs() < 1e-6, "{latitude} {height}: {z}");
            assert!((y - latitude).abs() < 1e-12, "{latitude} {height}: {y}");
            // A longitude is a smaller distance near a pole.
            assert!(
                (x - longitude).abs() * latitude.cos() < 1e-12,
                "{longitude} {x}"
            );
        }
    }

    fn applied(m: &[f64; 16], [x, y, z]: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|k| m[k] * x + m[4 + k] * y + m[8 + k] * z + m[12 + k])
    }

    /// Towers whose coordinates are published in both systems: the origin of the Dutch grid, and points of others.
    #[test]
    fn known_places_are_where_they_are() {
        for (system, at, [longitude, latitude]) in [
            (
                "EPSG:28992",
                [155_000.0, 463_000.0],
                [5.387_206, 52.155_174],
            ),
            ("EPSG:7415", [155_000.0, 463_000.0], [5.387_206, 52.155_174]),
            (
                "https://www.opengis.net/def/crs/EPSG/0/25832",
                [500_000.0, 5_761_038.2],
                [9.0, 52.0],
            ),
            ("EPSG:2154", [700_000.0, 6_600_000.0], [3.0, 46.5]),
            // 984,250 survey feet east of the origin, which is on the meridian.
            ("EPSG:2263 in metres", [300_000.0, 0.0], [-74.0, 40.166_667]),
        ] {
            let m = place(system, [at[0], at[1], 0.0], [0.0; 3]).unwrap();
            let [x, y, height] = geodetic(applied(&m, [0.0; 3]));
            assert!((x - longitude).abs() < 2e-5, "{system}: {x}");
            assert!((y - latitude).abs() < 2e-5, "{system}: {y}");
            assert!(height.abs() < 1e-3, "{system}: {height}");
        }
    }

    #[test]
    fn it_turns_and_moves_and_nothing_else() {
        let m = place("EPSG:7415", [85_000.0, 446_000.0, 0.0], [120.0, -40.0, 0.0]).unwrap();
        let axes = [0, 1, 2].map(|k| [m[4 * k], m[4 * k + 1], m[4 * k + 2]]);
        for (i, a) in axes.iter().enumerate() {
            for (j, b) in axes.iter().enumerate() {
                let dot: f64 = a.iter().zip(b).map(|(a, b)| a * b).sum();
                assert!(
                    (dot - f64::from(u8::from(i == j))).abs() < 1e-12,
                    "{i} {j} {dot}"
                );
            }
        }
        // A point 30 m above the middle is 30 m above the ellipsoid; one a kilometre to the north is where the grid has it.
        let above = geodetic(applied(&m, [120.0, -40.0, 30.0]));
        assert!((above[2] - 30.0).abs() < 1e-6, "{above:?}");
        let north = geodetic(applied(&m, [120.0, 960.0, 0.0]));
        let other = place("EPSG:7415", [85_120.0, 446_960.0, 0.0], [0.0; 3]).unwrap();
        let there = geodetic(applied(&other, [0.0; 3]));
        assert!((north[0] - there[0]).abs() < 2e-6 && (north[1] - there[1]).abs() < 2e-6);
        assert!(
            (north[2] - 1000.0_f64.powi(2) / 12.7e6).abs() < 1e-2,
            "{north:?}"
        );
    }

    #[test]
    fn systems_that_are_not_known_have_no_place() {
        for system in ["EPSG:4326", "EPSG:2263", "EPSG:99999", "here", ""] {
            assert_eq!(place(system, [0.0; 3], [0.0; 3]), None, "{system}");
        }
        assert_eq!(place("EPSG:28992", [f64::MAX, 0.0, 0.0], [0.0; 3]), None);
    }
}
