//! The files that fuzzing found worth keeping (`fuzz/seeds/`) go through the readers in the ordinary tests.

use std::path::Path;

use edifice::io::json::parse_json;
use edifice::io::{
    LabelMap, annotation_xml, building_csv, building_json, city, cmp_xml, coco, facade_json,
    footprint, grammar_cga, grammar_json, label_image, label_text, labelme, surface_obj,
};
use edifice::methods::building_exteriors::model_file;
use edifice::methods::procedural_logic::{Model, ModelFile};
use edifice::methods::structure_completion::model::Model as CompletionModel;
use edifice::model::network::Network;
use edifice::model::tables::schema::Schema;
use edifice::model::tables::table_model::TableModel;

/// True if the reader of that name takes the bytes.
fn read(reader: &str, bytes: &[u8]) -> bool {
    let path = Path::new("seed");
    let text = std::str::from_utf8(bytes).ok();
    match reader {
        "annotation_xml" => annotation_xml::parse(bytes, path, None).is_ok(),
        "bif" => text.is_some_and(|t| Network::from_bif(t).is_ok()),
        "building_csv" => building_csv::parse(bytes, path).is_ok(),
        "building_json" => {
            let one = building_json::parse(bytes, path).is_ok();
            building_json::parse_lines(bytes, path).is_ok() || one
        }
        "city_grammar" => city::grammar_json::parse(bytes, path).is_ok(),
        "city_grammar_compact" => city::compact::from_bytes(bytes).is_ok(),
        "city_gltf" => city::gltf::parse(bytes, path).is_ok(),
        "city_gml" => city::citygml::parse(bytes, path).is_ok(),
        "city_json" => city::cityjson::parse(bytes, path).is_ok(),
        "city_npz" => city::npz::parse(bytes.to_vec(), path).is_ok(),
        "city_obj" => city::obj::parse(bytes, path).is_ok(),
        "cmp_xml" => cmp_xml::parse(bytes, path).is_ok_and(|c| c.label_grid(30.0, 40.0).is_ok()),
        "coco" => coco::parse(bytes, path, None).is_ok(),
        "completion_model" => text.is_some_and(|t| CompletionModel::from_json(t).is_ok()),
        "footprint" => footprint::parse(bytes, path).is_ok(),
        "solids_cga" => text.is_some_and(|t| grammar_cga::solids::SolidRules::parse(t).is_ok()),
        "surface_obj" => {
            surface_obj::parse(bytes, path).is_ok_and(|s| s.check().is_ok_and(|r| r.shells == 1))
        }
        "facade_json" => facade_json::parse(bytes, path).is_ok(),
        "grammar_cga" => grammar_cga::parse(bytes, path).is_ok(),
        "grammar_json" => grammar_json::parse(bytes, path).is_ok(),
        "houses_model" => text.is_some_and(|t| model_file::ModelFile::from_json(t).is_ok()),
        "label_map" => LabelMap::parse(bytes, path).is_ok(),
        "label_png" => {
            let numbers = label_image::parse(bytes, path, Some(&LabelMap::cmp())).is_ok();
            label_image::parse(bytes, path, None).is_ok() || numbers
        }
        "label_text" => label_text::parse(bytes, path, None).is_ok(),
        "labelme" => labelme::parse(bytes, path).is_ok(),
        "logic_model" => {
            parse_json::<ModelFile>(bytes, path).is_ok_and(|file| Model::try_from(file).is_ok())
        }
        "network_json" => text.is_some_and(|t| Network::from_json(t).is_ok()),
        "table_csv" => building_csv::parse(bytes, path).is_ok_and(|table| {
            let schema = Schema::guess(&table.header, &table.rows);
            schema.is_ok_and(|s| s.read(&table.header, &table.rows).is_ok())
        }),
        "table_model" => text.is_some_and(|t| TableModel::from_json(t).is_ok()),
        "xmlbif" => text.is_some_and(|t| Network::from_xmlbif(t).is_ok()),
        "partial_facade" => facade_json::parse_annotated(bytes, path).is_ok(),
        other => panic!("no reader for fuzz/seeds/{other}"),
    }
}

#[test]
fn seeds_are_errors_or_values_and_the_named_ones_are_values() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz");
    let mut targets = 0;
    for entry in std::fs::read_dir(root.join("fuzz_targets")).expect("a folder") {
        let target = entry.expect("an entry").path();
        let name = target
            .file_stem()
            .expect("a name")
            .to_string_lossy()
            .into_owned();
        let mut values = 0;
        for seed in std::fs::read_dir(root.join("seeds").join(&name)).expect("seeds of a target") {
            let seed = seed.expect("an entry").path();
            let taken = read(&name, &std::fs::read(&seed).expect("a seed"));
            // Seeds written by hand have an extension, found ones have none.
            assert!(taken || seed.extension().is_none(), "{}", seed.display());
            values += usize::from(taken);
        }
        assert!(values > 0, "no seed of {name} is taken");
        targets += 1;
    }
    assert_eq!(targets, 31);
}
