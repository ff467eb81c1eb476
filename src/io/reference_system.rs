//! Names of reference systems of coordinates.

/// The ending of the name of a reference system whose coordinates were feet, or others, and have been made metres.
pub const IN_METRES: &str = " in metres";

/// The beginning of the standard's names of reference systems.
const OPEN_GIS: &str = "https://www.opengis.net/def/crs/";

/// A reference system as CityJSON 2.0 names it: `EPSG:7415` is `https://www.opengis.net/def/crs/EPSG/0/7415`. The standard
/// allows no other names: such are left out.
pub fn standard_name(system: &str) -> Option<String> {
    // No system has these coordinates any more.
    if system.ends_with(IN_METRES) {
        return None;
    }
    if let Some(rest) = system.strip_prefix("http://www.opengis.net/def/crs/") {
        return Some(format!("{OPEN_GIS}{rest}"));
    }
    if system.starts_with(OPEN_GIS) {
        return Some(system.to_owned());
    }
    let code = system.rsplit(':').next().filter(|c| !c.is_empty())?;
    let digits = code.chars().all(|c| c.is_ascii_digit());
    (digits && system.to_uppercase().contains("EPSG")).then(|| format!("{OPEN_GIS}EPSG/0/{code}"))
}
