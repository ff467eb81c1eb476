//! Bundles as Research Object Crates.

use std::path::Path;

use super::running::edifice;

/// A bundle that is a Research Object Crate: one entity for each file, all links lead to an entity, the same bytes on the same
/// day, and still a bundle.
pub(crate) fn crates(folder: &Path) {
    let licence = "https://creativecommons.org/licenses/by/4.0/";
    let pack = |name: &str| {
        let sweep = ["bundle", "ablation.toml", "--out", "out", "-o", name];
        let crated = [
            "--ro-crate",
            "--published",
            "2026-02-28",
            "--licence",
            licence,
        ];
        edifice(folder, &[&sweep[..], &crated[..]].concat()).success();
        std::fs::read(folder.join(name)).unwrap()
    };
    let bytes = pack("c.zip");
    assert_eq!(bytes, pack("d.zip"));
    let mut archive = zip::ZipArchive::new(std::io::Cursor::new(bytes)).unwrap();
    let mut text = String::new();
    let mut metadata = archive.by_name("ro-crate-metadata.json").unwrap();
    std::io::Read::read_to_string(&mut metadata, &mut text).unwrap();
    drop(metadata);
    let metadata: serde_json::Value = serde_json::from_str(&text).unwrap();
    let graph = metadata["@graph"].as_array().unwrap();
    let ids: Vec<&str> = graph.iter().map(|e| e["@id"].as_str().unwrap()).collect();
    let root = graph.iter().find(|e| e["@id"] == "./").unwrap();
    assert_eq!(
        (&root["datePublished"], &root["license"]["@id"]),
        (&"2026-02-28".into(), &licence.into())
    );
    // All but the metadata themselves and the manifest, which is written last.
    let parts: Vec<&str> = (root["hasPart"].as_array().unwrap().iter())
        .map(|part| part["@id"].as_str().unwrap())
        .collect();
    let mut packed: Vec<String> = archive
        .file_names()
        .map(|name| name.unwrap().into_owned())
        .collect();
    packed.retain(|name| name != "manifest.json" && name != "ro-crate-metadata.json");
    packed.sort();
    let mut named: Vec<String> = parts.iter().map(|part| (*part).to_owned()).collect();
    named.sort();
    assert_eq!(named, packed);
    for link in text.split("\"@id\": \"").skip(1) {
        let id = link.split('"').next().unwrap();
        let outside = id == "https://w3id.org/ro/crate/1.1";
        assert!(outside || ids.contains(&id), "{id} leads nowhere");
    }
    let again = edifice(folder, &["verify", "c.zip", "--sample", "1", "--json"]).success();
    let text = String::from_utf8_lossy(&again.get_output().stdout).into_owned();
    assert!(text.contains(r#""rerun":1,"different":[]"#), "{text}");
    let wrong = [
        "bundle",
        "ablation.toml",
        "--out",
        "out",
        "-o",
        "e.zip",
        "--ro-crate",
        "--published",
        "28.2.2026",
    ];
    edifice(folder, &wrong).failure().code(2);
    assert!(!folder.join("e.zip").exists());
}
