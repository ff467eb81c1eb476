//! CityGML: solids by reference, boundary surfaces, parts, degrees, and files that are damaged.

use std::path::Path;

use edifice::io::city::citygml::{from_stream, parse};
use edifice::rng::stream;
use edifice::shape::triangles::City;
use rand::RngExt;

const HEAD: &str = r#"<core:CityModel xmlns:core="http://www.opengis.net/citygml/2.0" xmlns:gml="http://www.opengis.net/gml"
  xmlns:bldg="http://www.opengis.net/citygml/building/2.0" xmlns:xlink="http://www.w3.org/1999/xlink">
  <gml:boundedBy><gml:Envelope srsName="SYSTEM" srsDimension="3"/></gml:boundedBy>"#;

/// The faces of a box, counterclockwise from outside, as texts of corners.
fn faces(low: [f64; 3], size: [f64; 3]) -> Vec<String> {
    let corner = |k: usize| {
        let p = [0, 1, 2].map(|i| low[i] + if k >> i & 1 == 1 { size[i] } else { 0.0 });
        format!("{} {} {}", p[0], p[1], p[2])
    };
    let rings = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [1, 3, 7, 5],
        [3, 2, 6, 7],
        [2, 0, 4, 6],
    ];
    let text = |r: [usize; 4]| {
        let closed = r.into_iter().chain([r[0]]).map(corner);
        closed.collect::<Vec<_>>().join(" ")
    };
    rings.map(text).to_vec()
}

fn polygon(id: &str, corners: &str) -> String {
    format!(
        "<gml:Polygon gml:id=\"{id}\"><gml:exterior><gml:LinearRing><gml:posList>{corners}</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon>"
    )
}

/// A building with boundary surfaces and a solid that refers to them.
fn building(id: &str, low: [f64; 3], size: [f64; 3]) -> String {
    let (mut surfaces, mut members) = (String::new(), String::new());
    for (k, face) in faces(low, size).iter().enumerate() {
        let kind = ["GroundSurface", "RoofSurface", "WallSurface"][k.min(2)];
        let polygon = polygon(&format!("{id}_{k}"), face);
        surfaces.push_str(&format!(
            "<bldg:boundedBy><bldg:{kind}><bldg:lod2MultiSurface><gml:MultiSurface><gml:surfaceMember>{polygon}</gml:surfaceMember></gml:MultiSurface></bldg:lod2MultiSurface></bldg:{kind}></bldg:boundedBy>"
        ));
        members.push_str(&format!("<gml:surfaceMember xlink:href=\"#{id}_{k}\"/>"));
    }
    format!(
        "<core:cityObjectMember><bldg:Building gml:id=\"{id}\"><bldg:measuredHeight uom=\"m\">9.5</bldg:measuredHeight><bldg:function>1000</bldg:function>{surfaces}<bldg:lod2Solid><gml:Solid><gml:exterior><gml:CompositeSurface>{members}</gml:CompositeSurface></gml:exterior></gml:Solid></bldg:lod2Solid></bldg:Building></core:cityObjectMember>"
    )
}

fn document(system: &str, members: &str) -> String {
    let head = HEAD.replace("SYSTEM", system);
    format!("{head}{members}</core:CityModel>")
}

fn read(text: &str) -> City {
    parse(text.as_bytes(), Path::new("a.gml")).unwrap()
}

fn volume(city: &City, building: usize) -> f64 {
    let mesh = &city.buildings[building].mesh;
    mesh.volume_above(mesh.bounds().unwrap().0[2])
}

#[test]
fn solids_by_reference_are_read_once_with_attributes_and_system() {
    let low = [391_253.25, 5_819_011.5, 34.5];
    let text = document(
        "urn:ogc:def:crs:EPSG::25833",
        &building("b", low, [10.0, 8.0, 6.0]),
    );
    let city = read(&text);
    assert_eq!(city.reference_system.as_deref(), Some("EPSG:25833"));
    assert_eq!(city.buildings.len(), 1);
    let b = &city.buildings[0];
    assert_eq!((b.id.as_str(), b.mesh.triangles.len()), ("b", 12));
    assert!((volume(&city, 0) - 480.0).abs() < 1e-6);
    assert_eq!(b.attributes["measuredHeight"], 9.5);
    let at = b.mesh.bounds().unwrap().0;
    for k in 0..3 {
        assert!((at[k] + city.origin[k] - low[k]).abs() < 1e-9);
    }
    assert!(city.notes.is_empty(), "{:?}", city.notes);
}

#[test]
fn surfaces_without_a_solid_parts_and_rooms() {
    let shell = |id: &str, low: [f64; 3]| {
        let members: String = (faces(low, [4.0; 3]).iter().enumerate())
            .map(|(k, f)| format!("<gml:surfaceMember>{}</gml:surfaceMember>", polygon(&format!("{id}{k}"), f)))
            .collect();
        format!("<bldg:lod1MultiSurface><gml:MultiSurface>{members}</gml:MultiSurface></bldg:lod1MultiSurface>")
    };
    let part = |id: &str, low| {
        let own = shell(id, low);
        format!("<bldg:consistsOfBuildingPart><bldg:BuildingPart gml:id=\"{id}\">{own}</bldg:BuildingPart></bldg:consistsOfBuildingPart>")
    };
    let room = format!("<bldg:interiorRoom><bldg:Room>{}</bldg:Room></bldg:interiorRoom>", shell("r", [0.0; 3]));
    let parts = [part("p", [0.0; 3]), part("q", [9.0, 0.0, 0.0])].concat();
    let foot = "<bldg:lod0FootPrint><gml:MultiSurface/></bldg:lod0FootPrint>";
    let whole = format!("<core:cityObjectMember><bldg:Building gml:id=\"w\">{foot}{parts}{room}</bldg:Building></core:cityObjectMember><core:cityObjectMember><Road/></core:cityObjectMember>");
    let city = read(&document("EPSG:25832", &whole));
    assert_eq!(city.buildings.len(), 1);
    assert!((volume(&city, 0) - 128.0).abs() < 1e-9);
    let notes = city.notes.join("; ");
    assert!(notes.contains("1 rooms") && notes.contains("1 city objects"), "{notes}");
}

#[test]
fn degrees_become_metres_latitude_first() {
    let text = document(
        "http://www.opengis.net/def/crs/EPSG/0/6697",
        &building("b", [35.26, 139.74, 2.25], [1e-4, 2e-4, 10.0]),
    );
    let city = read(&text);
    let (low, high) = city.buildings[0].mesh.bounds().unwrap();
    // 110.96 m of the meridian and 90.98 m of the parallel for a thousandth of a degree.
    assert!((high[0] - low[0] - 18.197).abs() < 0.01, "{low:?} {high:?}");
    assert!((high[1] - low[1] - 11.095).abs() < 0.01, "{low:?} {high:?}");
    assert_eq!(city.reference_system.as_deref(), Some("EPSG:6697"));
}

#[test]
fn wrong_files_say_where() {
    let whole = document("EPSG:25832", &building("b", [0.0; 3], [5.0; 3]));
    let say = |text: &str| parse(text.as_bytes(), Path::new("a.gml")).unwrap_err().to_string();
    for (text, what) in [
        (whole.replacen("5 0 0", "5 x 0", 1), "\"x\" is no coordinate"),
        (whole.replacen("5 0 0", "5 0", 1), "coordinates"),
        (whole[..whole.len() - 40].to_owned(), "a.gml"),
        ("<a/>".to_owned(), "expected <CityModel>"),
        (String::new(), "expected <CityModel>"),
    ] {
        let message = say(&text);
        assert!(message.starts_with("a.gml") && message.contains(what), "{message}");
    }
    let deep = "<a>".repeat(400);
    assert!(say(&document("x", &deep)).contains("deep"));
}

#[test]
fn damaged_files_end_in_an_error_or_a_city() {
    let whole = [
        building("b", [0.0; 3], [5.0; 3]),
        building("c", [9.0, 0.0, 0.0], [5.0; 3]),
    ];
    let whole = document("EPSG:25832", &whole.concat()).into_bytes();
    let mut rng = stream(1, "citygml", 0);
    for _ in 0..2000 {
        let mut bytes = whole.clone();
        for _ in 0..rng.random_range(1..6) {
            let at = rng.random_range(0..bytes.len());
            match rng.random_range(0..3) {
                0 => bytes[at] = rng.random(),
                1 => bytes.truncate(at + 1),
                _ => {
                    let end = (at + rng.random_range(1..60)).min(bytes.len());
                    let copy = bytes[at..end].to_vec();
                    bytes.splice(at..at, copy);
                }
            }
        }
        let _ = parse(&bytes, Path::new("a.gml"));
    }
}

#[test]
fn a_stream_is_read_as_the_bytes_are() {
    let text = document("EPSG:25832", &building("b", [0.0; 3], [5.0; 3]));
    let small = std::io::BufReader::with_capacity(7, text.as_bytes());
    let city = from_stream(small, "a", Path::new("a.gml")).unwrap();
    assert_eq!(city, read(&text));
}
