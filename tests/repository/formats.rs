//! FORMATS.md keeps its promise: its examples are read by the readers of the program, and the ids of the sources stand in it.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use edifice::io;
use edifice_model::network::Network;
use edifice_shape::Rect;

use super::lines::{PAGE, examples, keys, line, listed, root, word};

/// Reads an example of some kind by the reader of that kind.
fn read(kind: &str, text: &str) -> Result<(), Box<dyn std::error::Error>> {
    let (bytes, path) = (text.as_bytes(), Path::new("FORMATS.md"));
    match kind {
        "facade" => {
            let read = io::facade_json::parse_annotated(bytes, path)?;
            assert!(read.photograph.is_some() && read.notes[0].probability == Some(0.75));
            // Written and read again it is the same.
            let again = io::facade_json::annotated_to_string(&read);
            assert_eq!(
                io::facade_json::parse_annotated(again.as_bytes(), path)?,
                read
            );
        }
        "label-map" => drop(io::LabelMap::parse(bytes, path)?),
        "labelme" => drop(io::labelme::parse(bytes, path)?),
        "coco" => drop(io::coco::parse(bytes, path, None)?),
        "cmp" => assert_eq!(io::cmp_xml::parse(bytes, path)?.objects.len(), 1),
        "annotation" => {
            let facade = io::annotation_xml::parse(bytes, path, None)?;
            let rects: Vec<_> = facade.regions.iter().map(|r| r.rect).collect();
            let door = Rect::new(10.0, 0.0, 50.0, 100.0);
            assert_eq!(rects, [Rect::new(20.0, 500.0, 30.0, 60.0), door]);
        }
        "label-text" => drop(io::label_text::parse(bytes, path, None)?),
        "grammar" => {
            let grammar = io::grammar_json::parse(bytes, path)?;
            let again = io::grammar_json::to_string(&grammar);
            assert_eq!(io::grammar_json::parse(again.as_bytes(), path)?, grammar);
        }
        "library" => {
            let library = io::grammar_library_json::parse(bytes, path)?;
            let again = io::grammar_library_json::to_string(&library)?;
            let again = io::grammar_library_json::parse(again.as_bytes(), path)?;
            assert_eq!(again.members(), library.members());
        }
        "cga" => drop(io::grammar_cga::parse(bytes, path)?),
        "solids" => {
            let scope = io::grammar_cga::solids::Scope {
                at: [0.0; 3],
                turn: 0.0,
                size: [12.0, 0.0, 9.0],
            };
            let rules = io::grammar_cga::solids::SolidRules::parse(text)?;
            let solids = rules.evaluate("B1", &BTreeMap::new(), scope)?;
            assert_eq!(solids[0].scope.size, [12.0, 6.0, 9.0]);
            assert_eq!(solids[1].asset.as_deref(), Some("CITY.assets/T2.obj"));
        }
        "building" => drop(io::building_json::parse(bytes, path)?),
        "ifc" => ifc(text)?,
        "footprint" => drop(io::footprint::parse(bytes, path)?),
        "schema" => {
            use edifice_model::tables::schema::{FORMAT, RELATED_VERSION, Schema, VERSION};
            io::json::check_versions(bytes, path, FORMAT, VERSION..=RELATED_VERSION)?;
            let schema: Schema = io::json::parse_json(bytes, path)?;
            schema.relations()?;
            let related = schema.relations.map_or(0, |relations| relations.len());
            assert_eq!(schema.groups.len(), 2 + related);
        }
        "network" => {
            let network = Network::from_json(text)?;
            assert_eq!(
                Network::from_json(&network.to_json()?)?.to_json()?,
                network.to_json()?
            );
            let old = text.replace(
                "\"format\": \"edifice/network\", \"version\": 1",
                "\"format\": \"edifice-network-1\"",
            );
            assert_ne!(old, text);
            assert_eq!(Network::from_json(&old)?.to_json()?, network.to_json()?);
            let newer = text.replace("\"version\": 1", "\"version\": 2");
            assert!(Network::from_json(&newer).is_err());
        }
        "bif" => drop(Network::from_bif(text)?),
        "city-grammar" => drop(io::city::grammar_json::parse(bytes, path)?),
        "city-plan" => {
            let plan =
                edifice_experiments::city_proceduralization::country::Plan::parse(bytes, path)?;
            assert_eq!((plan.tiles.len(), plan.buildings()), (1, 96));
        }
        "city-proposal" => {
            use io::city::proposal_json::{parse, to_bytes};
            let proposal = parse(bytes, path)?;
            let folder = tempfile::tempdir()?;
            let file = folder.path().join("again.city-proposal.json.gz");
            std::fs::write(&file, to_bytes(&proposal)?)?;
            assert_eq!(io::city::proposal_json::read(&file)?, proposal);
        }
        "city-view" => assert_eq!(io::city::view_json::parse(bytes, path)?.len(), 2),
        "made-city" => sweep("city_proceduralization/proceduralize", "made-city", text),
        "knapsack" => sweep("optim/annealing", "knapsack", text),
        "sweep" => {
            let folder = tempfile::tempdir()?;
            let file = folder.path().join("sweep.toml");
            std::fs::write(&file, text)?;
            let out = folder.path().join("out");
            let keys = keys(&["sweep", "plan", word(&file), "--out", word(&out), "--json"]);
            assert_eq!(keys, listed("sweep plan"));
        }
        other => panic!("no reader is known for examples of kind {other:?}"),
    }
    Ok(())
}

/// Checks that the lines of an example of IFC are written for the building of the page.
fn ifc(example: &str) -> Result<(), Box<dyn std::error::Error>> {
    use edifice::methods::building_exteriors::house;
    let (_, building) = examples()
        .into_iter()
        .find(|(kind, _)| *kind == "building")
        .expect("an example of a building");
    let building = io::building_json::parse(building.as_bytes(), Path::new("FORMATS.md"))?;
    let model = house::model(&building, house::Joining::Boxes)?;
    let parts = house::parts::parts(&building, &model);
    let text = io::detailed_ifc::to_text(&parts, |finish| house::scene::colour(finish, 0));
    for line in example.lines() {
        assert!(
            text.lines().any(|l| l == line),
            "{line} is not written:\n{text}"
        );
    }
    Ok(())
}

/// Runs a study on one instance; a task that fails makes the command fail or count.
fn sweep(study: &str, ending: &str, text: &str) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let instance = folder.path().join(format!("example.{ending}.json"));
    std::fs::write(&instance, text).expect("a written file");
    let file = folder.path().join("sweep.toml");
    let definition = format!("study = {study:?}\ndata = [{instance:?}]\n[[arm]]\nname = \"one\"\n");
    std::fs::write(&file, definition).expect("a written file");
    let out = folder.path().join("out");
    let line = line(&["sweep", "run", word(&file), "--out", word(&out), "--json"]);
    assert_eq!(line["failed"], 0, "{study} on the example");
    assert_eq!(line["finished"], 1, "{study} on the example");
}

#[test]
fn the_examples_are_read_by_their_readers() {
    let examples = examples();
    assert!(examples.len() >= 19, "{} examples", examples.len());
    for (kind, text) in examples {
        read(kind, &text).unwrap_or_else(|e| panic!("the example of {kind}: {e}"));
    }
}

#[test]
fn the_files_that_the_page_names_exist() {
    let files = PAGE.split("xample: `").skip(1);
    let files: Vec<&str> = files.filter_map(|rest| rest.split('`').next()).collect();
    assert!(files.len() >= 4, "{files:?}");
    for file in files {
        let text = std::fs::read(root().join(file)).expect(file);
        let text = String::from_utf8_lossy(&text);
        let read = match file.rsplit_once('/').map_or(file, |(_, name)| name) {
            name if name.ends_with("table-model.json") => {
                edifice_model::tables::table_model::TableModel::from_json(&text)
                    .map(drop)
                    .map_err(|e| e.to_string())
            }
            name if name.ends_with("houses.json") => {
                edifice::methods::building_exteriors::model_file::ModelFile::from_json(&text)
                    .map(drop)
                    .map_err(|e| e.to_string())
            }
            name if name.ends_with("completion.json") => {
                edifice::methods::structure_completion::model::Model::from_json(&text)
                    .map(drop)
                    .map_err(|e| e.to_string())
            }
            name if name.ends_with(".bin") => io::city::compact::read(&root().join(file))
                .map(drop)
                .map_err(|e| e.to_string()),
            name => panic!("no reader is known for {name}"),
        };
        assert_eq!(read, Ok(()), "{file}");
    }
}

#[test]
fn every_id_of_the_sources_stands_on_the_page() {
    let mut folders = vec![root().join("src"), root().join("experiments")];
    let mut ids = BTreeSet::new();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "rs") {
                let text = std::fs::read_to_string(&path).expect("text");
                for rest in text.split("\"edifice/").skip(1) {
                    let id: &str = rest.split(['"', '\\']).next().unwrap_or_default();
                    ids.insert(format!("edifice/{id}"));
                }
            }
        }
    }
    assert!(ids.len() >= 13, "{ids:?}");
    for id in ids {
        assert!(
            PAGE.contains(&format!("`{id}`")),
            "{id} is not in FORMATS.md"
        );
    }
}
