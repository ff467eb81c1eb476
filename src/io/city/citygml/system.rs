//! Reference systems of CityGML: their EPSG codes, the order of their axes, and degrees as metres.

/// Semi-major axis and flattening of GRS 80.
const RADIUS: f64 = 6_378_137.0;
const FLATTENING: f64 = 1.0 / 298.257_222_101;
/// Geographic systems in which latitude comes first.
const GEOGRAPHIC: [u32; 12] = [
    4326, 4979, 4258, 4937, 6668, 6697, 6695, 4612, 4301, 4269, 4283, 7844,
];
/// Names of the German surveys: plan systems.
const SURVEY: [(&str, u32); 6] = [
    ("ETRS89_UTM31", 25831),
    ("ETRS89_UTM32", 25832),
    ("ETRS89_UTM33", 25833),
    ("DE_DHDN_3GK2", 31466),
    ("DE_DHDN_3GK3", 31467),
    ("DE_DHDN_3GK4", 31468),
];

/// The EPSG code that a name of a reference system has, the horizontal one of several: `EPSG:7415`,
/// `urn:ogc:def:crs:EPSG::25833`, `http://www.opengis.net/def/crs/EPSG/0/6697`,
/// `urn:ogc:def:crs,crs:EPSG:6.12:3068,crs:EPSG:6.12:5783`, `urn:adv:crs:ETRS89_UTM32*DE_DHHN92_NH`.
pub fn epsg(name: &str) -> Option<u32> {
    let upper = name.to_uppercase();
    if let Some(at) = upper.find("EPSG") {
        let rest = upper[at + 4..].split([',', '+']).next().unwrap_or_default();
        let mut parts = rest.split([':', '/']).filter(|p| !p.is_empty());
        return parts.next_back().and_then(|code| code.trim().parse().ok());
    }
    let known = SURVEY.iter().find(|(system, _)| upper.contains(system));
    known.map(|(_, code)| *code)
}

/// A file's reference system, and what its coordinates are moved by.
#[derive(Default)]
pub struct System {
    name: Option<String>,
    code: Option<u32>,
    /// The origin that is taken off: whole metres, or degrees of latitude and longitude.
    origin: Option<Origin>,
}

#[derive(Clone, Copy)]
enum Origin {
    Metres([f64; 3]),
    Degrees {
        latitude: f64,
        longitude: f64,
        first_is_latitude: bool,
        height: f64,
    },
}

impl System {
    /// Takes the first name that has a code, or else the first.
    pub(super) fn name(&mut self, name: &str) {
        if self.code.is_some() || name.trim().is_empty() {
            return;
        }
        let code = epsg(name);
        if code.is_some() || self.name.is_none() {
            self.name = Some(name.trim().to_owned());
            self.code = code;
        }
    }

    /// `EPSG:` and the code, or the name as the file has it.
    pub(super) fn label(&self) -> Option<String> {
        let code = self.code.map(|code| format!("EPSG:{code}"));
        code.or_else(|| self.name.clone())
    }

    /// The offset to add to a city's coordinates, in metres.
    pub(super) fn origin(&self) -> [f64; 3] {
        match self.origin {
            Some(Origin::Metres(origin)) => origin,
            Some(Origin::Degrees { height, .. }) => [0.0, 0.0, height],
            None => [0.0; 3],
        }
    }

    /// True if degrees were projected.
    pub(super) fn is_projected_here(&self) -> bool {
        matches!(self.origin, Some(Origin::Degrees { .. }))
    }

    /// A corner of the file in the city's metres.
    pub(super) fn metres(&mut self, p: [f64; 3]) -> [f64; 3] {
        let geographic = self.code.is_some_and(|c| GEOGRAPHIC.contains(&c));
        let origin = *self.origin.get_or_insert_with(|| match geographic {
            true => {
                // Latitudes end at 90 degrees.
                let first_is_latitude = p[0].abs() <= 90.0;
                let (latitude, longitude) = match first_is_latitude {
                    true => (p[0], p[1]),
                    false => (p[1], p[0]),
                };
                Origin::Degrees {
                    latitude,
                    longitude,
                    first_is_latitude,
                    height: p[2].floor(),
                }
            }
            false => Origin::Metres(p.map(f64::floor)),
        });
        match origin {
            Origin::Metres(origin) => [0, 1, 2].map(|k| p[k] - origin[k]),
            Origin::Degrees {
                latitude,
                longitude,
                first_is_latitude,
                height,
            } => {
                let (north, east) = match first_is_latitude {
                    true => (p[0], p[1]),
                    false => (p[1], p[0]),
                };
                // Radii of curvature along the parallel and the meridian.
                let (sin, cos) = latitude.to_radians().sin_cos();
                let square = FLATTENING * (2.0 - FLATTENING);
                let w = 1.0 - square * sin * sin;
                let parallel = RADIUS / w.sqrt() * cos;
                let meridian = RADIUS * (1.0 - square) / (w * w.sqrt());
                [
                    (east - longitude).to_radians() * parallel,
                    (north - latitude).to_radians() * meridian,
                    p[2] - height,
                ]
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_found_in_all_kinds_of_names() {
        for (name, code) in [
            ("EPSG:7415", Some(7415)),
            ("urn:ogc:def:crs:EPSG::25833", Some(25833)),
            ("http://www.opengis.net/def/crs/EPSG/0/6697", Some(6697)),
            (
                "urn:ogc:def:crs,crs:EPSG:6.12:3068,crs:EPSG:6.12:5783",
                Some(3068),
            ),
            ("urn:adv:crs:ETRS89_UTM32*DE_DHHN92_NH", Some(25832)),
            ("EPSG:25832+5783", Some(25832)),
            ("local", None),
        ] {
            assert_eq!(epsg(name), code, "{name}");
        }
    }

    #[test]
    fn a_degree_of_the_meridian_is_as_long_as_it_is() {
        let mut system = System::default();
        system.name("EPSG:6697");
        let first = system.metres([45.0, 10.0, 5.5]);
        assert_eq!(first, [0.0, 0.0, 0.5]);
        let [east, north, _] = system.metres([45.01, 10.01, 5.5]);
        // 111,132 m and 78,847 m a degree at 45 degrees.
        assert!((north - 1111.32).abs() < 0.1 && (east - 788.47).abs() < 0.1);
    }
}
