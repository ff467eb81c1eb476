//! No reader allocates by a number in a file: every number of every format is replaced by huge ones,
//! and the answer, an error or a value, comes without the memory that the number asks for.
//!
//! The file is read by the program itself, where the system can cap its memory.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use edifice::model::network::{Network, Variable};

/// Kilobytes of address space that the program gets: libraries, threads' stacks, little else.
const MOST_KILOBYTES: u64 = 1_000_000;

/// 2^32, the largest of 64 bits, beyond all integers, and none at all.
const NUMBERS: [&str; 4] = ["4294967296", "18446744073709551615", "1e300", "0"];

/// The program on `arguments`, with capped memory and time.
fn edifice(arguments: &[&str]) -> Output {
    let program = env!("CARGO_BIN_EXE_edifice");
    let script = format!("ulimit -v {MOST_KILOBYTES}; ulimit -t 20; exec \"$0\" \"$@\"");
    Command::new("sh")
        .args(["-c", &script, program])
        .args(arguments)
        .env("RAYON_NUM_THREADS", "1")
        .output()
        .expect("a shell")
}

/// Runs the program on a file; it may fail, with a message that names the file, and never in another way.
fn read(file: &Path, arguments: &[&str], what: &str) -> bool {
    let name = file.to_string_lossy();
    let arguments: Vec<&str> = arguments
        .iter()
        .map(|&a| if a == "FILE" { &name } else { a })
        .collect();
    let output = edifice(&arguments);
    let errors = String::from_utf8_lossy(&output.stderr);
    match output.status.code() {
        Some(0) => true,
        Some(1) => {
            assert!(errors.contains("error: "), "{what}: {errors}");
            false
        }
        _ => panic!("{what}: {:?}: {errors}", output.status),
    }
}

/// The ranges of the numbers in a text, outside of names in quotes.
fn numbers(text: &str) -> Vec<std::ops::Range<usize>> {
    let (mut found, mut quoted, mut start) = (Vec::new(), false, None);
    for (at, c) in text.char_indices() {
        quoted ^= c == '"';
        let inside = !quoted && (c.is_ascii_digit() || (start.is_some() && ".e-+".contains(c)));
        let word = text[..at].ends_with(|b: char| b.is_alphanumeric() || b == '_');
        match (inside, start) {
            (true, None) if !word => start = Some(at),
            (false, Some(from)) => {
                found.push(from..at);
                start = None;
            }
            _ => {}
        }
    }
    found.extend(start.map(|from| from..text.len()));
    found
}

fn seed(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// Puts every huge number in the place of numbers of the file, at most `places` of them, spread evenly.
fn check(path: &Path, arguments: &[&str], places: usize) {
    let folder = tempfile::tempdir().expect("a folder");
    let name = path.file_name().expect("a file");
    let file = folder.path().join(name);
    let name = name.to_string_lossy();
    let text = std::fs::read_to_string(path).expect("a text");
    std::fs::write(&file, &text).expect("written");
    assert!(read(&file, arguments, &name), "{name} as it is");
    let all = numbers(&text);
    assert!(!all.is_empty(), "{name} has no numbers");
    for range in all.iter().step_by(all.len().div_ceil(places)) {
        for number in NUMBERS {
            let mut changed = text.clone();
            changed.replace_range(range.clone(), number);
            std::fs::write(&file, &changed).expect("written");
            read(&file, arguments, &format!("{name}, {range:?}: {number}"));
        }
    }
}

#[test]
fn numbers_in_facades_and_grammars() {
    let out = tempfile::tempdir().expect("a folder");
    let [json, png] = ["a.facade.json", "a.png"].map(|name| out.path().join(name));
    let (json, png) = (json.to_string_lossy(), png.to_string_lossy());
    let to_json = ["facade", "convert", "FILE", "-o", &json];
    check(
        &seed("fuzz/seeds/facade_json/a.facade.json"),
        &["facade", "convert", "FILE", "-o", &png],
        12,
    );
    check(&seed("fuzz/seeds/cmp_xml/a.xml"), &to_json, 6);
    check(&seed("fuzz/seeds/annotation_xml/voc.xml"), &to_json, 6);
    check(&seed("fuzz/seeds/annotation_xml/polygon.xml"), &to_json, 6);
    let grammar = seed("fuzz/seeds/grammar_json/b.grammar.json");
    check(&grammar, &["grammar", "show", "FILE"], 30);
    check(&grammar, &["grammar", "derive", "FILE", "-o", &json], 8);
    check(
        &seed("fuzz/seeds/grammar_cga/a.cga"),
        &["grammar", "show", "FILE"],
        12,
    );
}

#[test]
fn numbers_in_models() {
    check(
        &seed("fuzz/seeds/houses_model/a.houses.json"),
        &["building", "show", "FILE"],
        16,
    );
    check(
        &seed("fuzz/seeds/logic_model/a.logic.json"),
        &["model", "show", "FILE"],
        16,
    );
    check(&seed("fuzz/seeds/bif/a.bif"), &["model", "show", "FILE"], 8);
    check(
        &seed("fuzz/seeds/network_json/a.json"),
        &["model", "show", "FILE"],
        12,
    );
    check(
        &seed("fuzz/seeds/building_json/a.buildings.jsonl"),
        &["building", "attributes", "FILE"],
        12,
    );
}

/// The model file of the report of this fault: every number of its structure.
#[test]
fn numbers_of_the_structure_of_a_houses_model_are_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("a.houses.json");
    let path = seed("fuzz/seeds/houses_model/a.houses.json");
    let text = std::fs::read_to_string(path).expect("a model");
    let whole: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let huge = serde_json::json!(4_294_967_296_u64);
    let pointers = [
        "/model/structure/styles",
        "/model/structure/selectors/0/Hidden",
        "/model/structure/parents/1",
        "/model/schema/offsets/1",
    ];
    for pointer in pointers {
        let mut changed = whole.clone();
        let value = changed.pointer_mut(pointer).expect(pointer);
        *value = match value {
            serde_json::Value::Array(_) => serde_json::json!([huge]),
            _ => huge.clone(),
        };
        std::fs::write(&file, changed.to_string()).expect("written");
        assert!(
            !read(&file, &["building", "show", "FILE"], pointer),
            "{pointer} is taken"
        );
    }
}

#[test]
fn a_repeat_of_a_billion_periods_is_refused_by_what_derives_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("a.grammar.json");
    let out = folder.path().join("a.facade.json");
    for (width, shown) in [(4.0e6, true), (4.0e9, false)] {
        let text = format!(
            "{{ \"format\": \"edifice/grammar\", \"version\": 1, \"axiom\": \"A\", \"unit\": \"m\", \"width\": {width}, \
             \"height\": 1.0, \"rules\": [ {{ \"symbol\": \"A\", \"op\": \"repeat\", \"axis\": \"x\", \
             \"successors\": [ {{ \"symbol\": \"w\", \"size\": 1.0 }} ] }} ] }}"
        );
        std::fs::write(&file, text).expect("written");
        assert_eq!(read(&file, &["grammar", "show", "FILE"], "a repeat"), shown);
    }
    assert!(!read(
        &file,
        &["grammar", "derive", "FILE", "-o", &out.to_string_lossy()],
        "a repeat"
    ));
}

#[test]
fn a_default_row_stands_for_as_much_as_there_is_room_for() {
    let parents: Vec<String> = (0..40).map(|i| format!("p{i}")).collect();
    let bif = |parents: &[String]| {
        let mut text = String::from("network n {\n}\n");
        for name in parents {
            text += &format!(
                "variable {name} {{ type discrete [ 2 ] {{ no, yes }}; }}\nprobability ( {name} ) {{ table 0.5, 0.5; }}\n"
            );
        }
        text += "variable c { type discrete [ 2 ] { no, yes }; }\n";
        text + &format!(
            "probability ( c | {} ) {{ default 0.25, 0.75; }}\n",
            parents.join(", ")
        )
    };
    let few = Network::from_bif(&bif(&parents[..3])).expect("eight rows");
    assert_eq!(few.probabilities("c").expect("a table").len(), 16);
    for count in [22, 40] {
        let text = Network::from_bif(&bif(&parents[..count]))
            .expect_err("too many")
            .to_string();
        assert!(text.contains("`default` stands for more than"), "{text}");
    }
    let many: Vec<String> = (0..70).map(|i| format!("p{i}")).collect();
    let text = Network::from_bif(&bif(&many))
        .expect_err("too many")
        .to_string();
    assert!(text.contains("than can be counted"), "{text}");
    let missing = bif(&parents[..3]).replace("default 0.25, 0.75;", "(no, no, yes) 0.25, 0.75;");
    let text = Network::from_bif(&missing)
        .expect_err("seven rows are missing")
        .to_string();
    assert!(
        text.contains("a configuration has no probabilities"),
        "{text}"
    );
}

#[test]
fn coordinates_of_a_network_are_counted_by_what_is_stated() {
    let network = Network::new(vec![
        Variable::linear("x", 1, &[], &[(&[0.0], &[1.0])]),
        Variable::linear("y", 1, &["x"], &[(&[0.0, 1.0], &[1.0])]),
    ]);
    let text = network.expect("two numbers").to_json().expect("written");
    for number in ["4294967296", "18446744073709551615"] {
        // The parent, which the child's regressors are counted by, stands after it and before it.
        for place in [1, 2] {
            let parts: Vec<&str> = text.split("\"dimension\": 1").collect();
            let mut changed = parts[0].to_owned();
            for (i, part) in (1..).zip(&parts[1..]) {
                let value = if i == place { number } else { "1" };
                changed += &format!("\"dimension\": {value}{part}");
            }
            let error = Network::from_json(&changed).expect_err("nothing is stated");
            let error = error.to_string();
            assert!(
                error.contains("needed") || error.contains("counted"),
                "{error}"
            );
        }
    }
}

/// A table of a few bytes that unpacks to millions of cells.
#[test]
fn cells_of_a_compressed_table_are_counted() {
    use std::io::Write;
    let mut packed = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    packed.write_all(b"a,b,c,d\n").expect("packed");
    let rows = b"1,1,1,1\n".repeat(1 << 16);
    for _ in 0..65 {
        packed.write_all(&rows).expect("packed");
    }
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("a.csv.gz");
    std::fs::write(&file, packed.finish().expect("packed")).expect("written");
    let error = edifice::io::building_csv::read(&file).expect_err("too many cells");
    assert!(
        error.to_string().contains("more than 16777216 cells"),
        "{error}"
    );
}
