//! CityJSON and CityGML of others: objects that are no buildings, instances of templates, feet.

use edifice::io::city::{citygml, cityjson};
use edifice::shape::triangles::{City, repair};
use serde_json::{Value, json};

/// The faces of a box over four corners and the four above them.
fn box_of(first: u64) -> Value {
    let face = |corners: [u64; 4]| json!([corners.map(|i| i + first)]);
    json!([[
        face([0, 3, 2, 1]),
        face([4, 5, 6, 7]),
        face([0, 1, 5, 4]),
        face([1, 2, 6, 5]),
        face([2, 3, 7, 6]),
        face([3, 0, 4, 7])
    ]])
}

fn corners(size: [f64; 3]) -> Vec<[f64; 3]> {
    let plan = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let corner = |i: usize| [plan[i % 4][0], plan[i % 4][1], (i / 4) as f64];
    (0..8)
        .map(|i| std::array::from_fn(|k| corner(i)[k] * size[k]))
        .collect()
}

fn read(objects: Value, system: Option<&str>) -> City {
    let document = json!({ "type": "CityJSON", "version": "2.0", "CityObjects": objects,
        "metadata": { "referenceSystem": system },
        "transform": { "scale": [1.0, 1.0, 1.0], "translate": [1000.0, 2000.0, 0.0] },
        "vertices": corners([10.0, 20.0, 6.0]),
        "geometry-templates": { "vertices-templates": corners([4.0, 3.0, 2.0]),
            "templates": [ { "type": "Solid", "lod": "2", "boundaries": box_of(0) } ] } });
    cityjson::parse(document.to_string().as_bytes(), "a.city.json".as_ref()).unwrap()
}

fn volume(city: &City, building: usize) -> f64 {
    city.buildings[building].mesh.volume_above(0.0)
}

fn solid() -> Value {
    json!([{ "type": "Solid", "lod": "2", "boundaries": box_of(0) }])
}

#[test]
fn roads_terrain_and_trees_are_no_buildings() {
    let city = read(
        json!({
            "house": { "type": "Building", "geometry": solid() },
            "old": { "geometry": solid() },
            "road": { "type": "Road", "geometry": solid() },
            "lane": { "type": "Road", "parents": ["road"], "geometry": solid() },
            "ground": { "type": "TINRelief", "geometry": solid() },
            "tree": { "type": "SolitaryVegetationObject", "geometry": solid() },
            "wing": { "type": "BuildingPart", "parents": ["house"], "geometry": solid() }
        }),
        None,
    );
    let ids: Vec<&str> = city.buildings.iter().map(|b| b.id.as_str()).collect();
    assert_eq!(ids, ["house", "old"]);
    assert_eq!(
        city.notes,
        ["left out: 3 city objects that are no buildings"]
    );
    assert!((volume(&city, 0) - 2400.0).abs() < 1e-9);
}

#[test]
fn instances_of_templates_stand_where_their_matrices_put_them() {
    // A quarter of a turn, twice as high, a metre up, at the corner (10, 20, 0).
    let matrix = [
        0.0, -1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 2.0, 1.0, 0.0, 0.0, 0.0, 1.0,
    ];
    let instance = |matrix: Value, template: u64, point: u64| {
        json!({ "house": { "type": "Building", "geometry": [ { "type": "GeometryInstance",
            "template": template, "boundaries": [point], "transformationMatrix": matrix } ] } })
    };
    let city = read(instance(json!(matrix), 0, 2), None);
    let (low, high) = city.buildings[0].mesh.bounds().unwrap();
    assert_eq!((low, high), ([7.0, 20.0, 1.0], [10.0, 24.0, 5.0]));
    assert_eq!(city.origin, [1000.0, 2000.0, 0.0]);
    for (objects, said) in [
        (instance(json!(matrix), 1, 2), "without a template"),
        (instance(json!([1.0]), 0, 2), "16 numbers"),
        (instance(json!(matrix), 0, 9), "9"),
    ] {
        let document = json!({ "type": "CityJSON", "version": "2.0", "CityObjects": objects,
            "vertices": corners([1.0; 3]), "geometry-templates": { "vertices-templates": [],
            "templates": [ { "type": "Solid", "lod": "2", "boundaries": box_of(0) } ] } });
        let read = cityjson::parse(document.to_string().as_bytes(), "a.city.json".as_ref());
        let error = read.map(|_| ()).unwrap_err().to_string();
        assert!(error.contains("house") && error.contains(said), "{error}");
    }
}

#[test]
fn feet_become_metres() {
    let foot: f64 = 1200.0 / 3937.0;
    let objects = || json!({ "house": { "type": "Building", "geometry": solid() } });
    for system in ["https://www.opengis.net/def/crs/EPSG/0/2263", "EPSG:2263"] {
        let city = read(objects(), Some(system));
        let volume = volume(&city, 0);
        assert!((volume / foot.powi(3) - 1200.0).abs() < 1e-6, "{volume}");
        let (low, _) = city.buildings[0].mesh.bounds().unwrap();
        for (k, feet) in [1000.0, 2000.0, 0.0].into_iter().enumerate() {
            assert!((low[k] + city.origin[k] - feet * foot).abs() < 1e-9);
            assert_eq!(city.origin[k], city.origin[k].floor());
        }
        assert_eq!(
            city.reference_system.as_deref(),
            Some(&*format!("{system} in metres"))
        );
        assert_eq!(city.notes.len(), 1);
        // What is written says nothing of feet.
        assert!(!cityjson::to_string(&city).contains("2263"));
    }
    let city = read(
        objects(),
        Some("https://www.opengis.net/def/crs/EPSG/0/7415"),
    );
    assert!((volume(&city, 0) - 1200.0).abs() < 1e-9 && city.notes.is_empty());
}

#[test]
fn citygml_in_feet_becomes_metres() {
    let gml = |system: &str| {
        format!(
            "<CityModel xmlns=\"http://www.opengis.net/citygml/2.0\" xmlns:bldg=\"http://www.opengis.net/citygml/building/2.0\" \
             xmlns:gml=\"http://www.opengis.net/gml\"><gml:boundedBy><gml:Envelope srsName=\"{system}\"/></gml:boundedBy>\
             <cityObjectMember><bldg:Building gml:id=\"a\"><bldg:lod1MultiSurface><gml:MultiSurface><gml:surfaceMember><gml:Polygon>\
             <gml:exterior><gml:LinearRing><gml:posList>980000 200000 10 980100 200000 10 980100 200050 10 980000 200050 10 980000 200000 10</gml:posList>\
             </gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember></gml:MultiSurface></bldg:lod1MultiSurface></bldg:Building>\
             </cityObjectMember></CityModel>"
        )
    };
    let size = |system: &str| {
        let city = citygml::parse(gml(system).as_bytes(), "a.gml".as_ref()).unwrap();
        let (low, high) = city.buildings[0].mesh.bounds().unwrap();
        (
            [high[0] - low[0], high[1] - low[1]],
            low[2] + city.origin[2],
        )
    };
    let foot: f64 = 1200.0 / 3937.0;
    let ([width, depth], height) = size("EPSG:2263");
    assert!((width - 100.0 * foot).abs() < 1e-6 && (depth - 50.0 * foot).abs() < 1e-6);
    assert!((height - 10.0 * foot).abs() < 1e-9);
    assert_eq!(size("EPSG:25833"), ([100.0, 50.0], 10.0));
}

#[test]
fn footprints_with_heights_are_buildings() {
    let square = |x: f64, y: f64, side: f64| {
        json!([
            [x, y],
            [x, y + side],
            [x + side, y + side],
            [x + side, y],
            [x, y]
        ])
    };
    let feature = |properties: Value, rings: Value| json!({ "type": "Feature", "properties": properties, "geometry": { "type": "Polygon", "coordinates": rings } });
    let features = json!({ "type": "FeatureCollection",
    "crs": { "type": "name", "properties": { "name": "urn:ogc:def:crs:EPSG::28992" } }, "features": [
        feature(json!({ "id": "court", "height": "12.5 m" }), json!([square(85000.0, 446000.0, 20.0), square(85005.0, 446005.0, 10.0)])),
        feature(json!({ "building:levels": 4, "min_height": 2 }), json!([square(85040.0, 446000.0, 10.0)])),
        feature(json!({ "height": null }), json!([square(85080.0, 446000.0, 10.0)])),
        { "type": "Feature", "properties": { "height": 3 }, "geometry": { "type": "Point", "coordinates": [85000, 446000] } } ] });
    let parse = |v: &Value| {
        edifice::io::city::footprints::parse(v.to_string().as_bytes(), "a.geojson".as_ref())
    };
    let city = parse(&features).unwrap();
    assert_eq!(city.origin, [85000.0, 446000.0, 0.0]);
    assert_eq!(city.notes, ["left out: 1 footprints without a height"]);
    let ids: Vec<&str> = city.buildings.iter().map(|b| b.id.as_str()).collect();
    assert_eq!(ids, ["court", "building_2"]);
    assert!((volume(&city, 0) - 300.0 * 12.5).abs() < 1e-6);
    let other = &city.buildings[1].mesh;
    let (low, high) = other.bounds().unwrap();
    assert_eq!((low[2], high[2]), (2.0, 12.0));
    assert!((other.volume_above(2.0) - 1000.0).abs() < 1e-6);
    for building in &city.buildings {
        assert_eq!(repair(&building.mesh).1.open_edges, 0, "{}", building.id);
    }
    // A degree of latitude at 52 degrees is 111,267 m long, one of longitude 68,678 m.
    let small = feature(
        json!({ "height": 10 }),
        json!([[
            [4.36, 52.01],
            [4.361, 52.01],
            [4.361, 52.011],
            [4.36, 52.011]
        ]]),
    );
    let city = parse(&small).unwrap();
    let (low, high) = city.buildings[0].mesh.bounds().unwrap();
    assert!(
        (high[0] - low[0] - 68.67).abs() < 0.05,
        "{}",
        high[0] - low[0]
    );
    assert!(
        (high[1] - low[1] - 111.27).abs() < 0.05,
        "{}",
        high[1] - low[1]
    );
    let wrong = feature(json!({ "height": 10 }), json!([[["a", 1.0]]]));
    let said = parse(&wrong).map(|_| ()).unwrap_err().to_string();
    assert!(said.contains("features[0]"), "{said}");
    assert!(parse(&json!({ "features": [] })).is_err());
}
