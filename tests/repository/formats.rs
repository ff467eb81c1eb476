//! FORMATS.md keeps its promise: its examples are read by the readers of the program, the ids of the sources stand in it, and
//! the lines for programs have the keys that it lists.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use assert_cmd::Command;
use edifice_io as io;
use edifice_model::network::Network;
use edifice_shape::Rect;

const PAGE: &str = include_str!("../../FORMATS.md");

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The blocks of code of the page: the second word after the fence, and the text.
fn examples() -> Vec<(&'static str, String)> {
    let mut found = Vec::new();
    let mut open: Option<(&str, String)> = None;
    for line in PAGE.lines() {
        match (line.strip_prefix("```"), open.take()) {
            (Some(_), Some(done)) => found.push(done),
            (Some(info), None) => {
                let kind = info.split(' ').nth(1).expect("a kind after the language");
                open = Some((kind, String::new()));
            }
            (None, Some((kind, text))) => open = Some((kind, text + line + "\n")),
            (None, None) => {}
        }
    }
    assert!(open.is_none(), "a block of code does not end");
    found
}

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

pub(crate) fn word(path: &Path) -> &str {
    path.to_str().expect("a path of text")
}

/// The last line of standard output of a command, as JSON.
pub(crate) fn line(words: &[&str]) -> serde_json::Value {
    let mut command = Command::cargo_bin("edifice").expect("the program");
    let output = command.current_dir(root()).args(words).assert().success();
    let text = String::from_utf8_lossy(&output.get_output().stdout).into_owned();
    let last = text.lines().last().unwrap_or_default().to_owned();
    serde_json::from_str(&last).unwrap_or_else(|e| panic!("{words:?}: {e}: {text}"))
}

pub(crate) fn keys(words: &[&str]) -> BTreeSet<String> {
    let line = line(words);
    let object = line.as_object().expect("an object");
    object.keys().cloned().collect()
}

/// The keys that the page lists for a command, those in brackets left out.
pub(crate) fn listed(command: &str) -> BTreeSet<String> {
    let all = table();
    let cell = all
        .get(command)
        .unwrap_or_else(|| panic!("no row of {command}"));
    let mut keys = BTreeSet::new();
    // Keys of inner objects stand in parentheses.
    let (mut depth, mut rest) = (0, cell.as_str());
    while let Some(at) = rest.find(['(', ')', '[', ']', '`']) {
        let sign = rest.as_bytes()[at];
        rest = &rest[at + 1..];
        match sign {
            b'(' | b'[' => depth += 1,
            b')' | b']' => depth -= 1,
            _ => {
                let end = rest.find('`').expect("code ends");
                if depth == 0 {
                    keys.insert(rest[..end].to_owned());
                }
                rest = &rest[end + 1..];
            }
        }
    }
    keys
}

/// The rows of the table of lines: command, and the cell of its keys.
pub(crate) fn table() -> BTreeMap<String, String> {
    let rows = PAGE.split("| command | keys |").nth(1).expect("the table");
    let rows = rows.lines().skip(2).take_while(|l| l.starts_with('|'));
    let mut table = BTreeMap::new();
    for row in rows {
        let cells: Vec<&str> = row.trim_matches('|').split('|').map(str::trim).collect();
        let [commands, keys] = cells[..] else {
            panic!("{row}");
        };
        let (commands, about) = match commands.rsplit_once("`") {
            Some((commands, about)) => (commands, about.trim_matches([',', ';', ' '])),
            None => panic!("{row}"),
        };
        let about = match about.starts_with("of ") {
            true => format!(" {about}"),
            false => String::new(),
        };
        let mut room = "";
        for name in commands.split('`').filter(|n| !matches!(*n, "" | ", ")) {
            let name = match name.split_once(' ') {
                Some((first, second)) => {
                    room = first;
                    second
                }
                None => name,
            };
            table.insert(format!("{room} {name}{about}"), keys.to_owned());
        }
    }
    table
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

#[test]
fn lines_for_programs_have_the_keys_of_the_page() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let at = |name: &str| word(&folder.path().join(name)).to_owned();
    let cottage = "datasets/facade_grammar/layouts/cottage_1.facade.json";
    let terraces =
        ["a", "b"].map(|k| format!("datasets/facade_grammar/layouts/terrace_{k}.facade.json"));
    let houses = "datasets/building_exteriors/real.houses.json";
    let town = "datasets/city_proceduralization/town.city-grammar.json";
    let asia = "datasets/model/asia.bif";
    let (grammar, half, logic) = (
        at("c.grammar.json"),
        at("half.facade.json"),
        at("l.logic.json"),
    );
    let (out, whole, quarter) = (
        at("houses"),
        at("whole.facade.json"),
        at("q.city-grammar.json"),
    );
    let again = at("again.city-grammar.json");
    let city = at("town.obj");
    let table = at("table.csv");
    let bif = at("t.bif");
    let fitted = at("fitted.bif");
    let rows = "b,c\nx,yes\ny,no\nx,yes\ny,no\nx,no\nx,yes\ny,yes\nx,no\n";
    std::fs::write(&table, rows).expect("a written file");
    let view = at("view.json");
    let (_, text) = examples()
        .into_iter()
        .find(|(kind, _)| *kind == "city-view")
        .expect("a view");
    std::fs::write(&view, text).expect("a written file");
    let house = at("houses/house_0001.building.json");
    let cases: &[(&str, &[&str])] = &[
        (
            "grammar infer",
            &[
                "grammar", "infer", cottage, "--method", "greedy", "-o", &grammar,
            ],
        ),
        ("grammar show", &["grammar", "show", &grammar]),
        (
            "facade hide",
            &["facade", "hide", cottage, "--task", "side50", "-o", &half],
        ),
        (
            "facade complete",
            &["facade", "complete", &half, "-o", &whole],
        ),
        ("facade score", &["facade", "score", cottage]),
        (
            "logic fit",
            &["logic", "fit", &terraces[0], &terraces[1], "-o", &logic],
        ),
        (
            "logic compare",
            &[
                "logic",
                "compare",
                "--model",
                &logic,
                "--query",
                "terrace_a",
            ],
        ),
        ("model show of a logic model", &["model", "show", &logic]),
        ("model show of a network", &["model", "show", asia]),
        (
            "model structure",
            &["model", "structure", &table, "-o", &bif, "--restarts", "1"],
        ),
        ("model fit", &["model", "fit", &bif, &table, "-o", &fitted]),
        ("building show", &["building", "show", houses]),
        (
            "building generate",
            &["building", "generate", houses, "-n", "1", "-o", &out],
        ),
        (
            "building from-facades",
            &[
                "building",
                "from-facades",
                "--front",
                "datasets/examples/front.facade.json",
                "--footprint",
                "datasets/examples/lot.geojson",
                "--height",
                "6",
                "-o",
                &out,
            ],
        ),
        ("building check", &["building", "check", &house]),
        ("city show", &["city", "show", town]),
        (
            "city synthesize",
            &[
                "city",
                "synthesize",
                town,
                "--polygon",
                "0,0,60,0,60,60,0,60",
                "-o",
                &quarter,
            ],
        ),
        ("city derive", &["city", "derive", town, "-o", &city]),
        (
            "city compare",
            &["city", "compare", &city, &city, "--resolution", "2"],
        ),
        (
            "city proceduralize",
            &["city", "proceduralize", &city, "-o", &again],
        ),
        (
            "city locate",
            &["city", "locate", town, "--view", &view, "--top", "1"],
        ),
        ("sweep studies", &["sweep", "studies"]),
    ];
    for (command, words) in cases {
        if *command == "city derive" {
            let mut derive = Command::cargo_bin("edifice").expect("the program");
            derive.current_dir(root()).args(*words).assert().success();
            continue;
        }
        let found = keys(&[words, &["--json"][..]].concat());
        assert_eq!(found, listed(command), "{command}");
    }
    // A line a variable.
    let answers = line(&["model", "query", asia, "--of", "lung", "--json"]);
    assert!(answers["lung"]["probabilities"].is_array());
}
