//! Arms that are commands: the built-in method run as one finds the same to the bit, short methods in Python enter four studies, and answers that lie
//! fail their tasks with the reason and harm no other.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use assert_cmd::Command;

/// The program.
const EDIFICE: &str = env!("CARGO_BIN_EXE_edifice");

fn sweep(folder: &Path, verb: &str, words: &[&str]) -> assert_cmd::assert::Assert {
    Command::new(EDIFICE)
        .current_dir(folder)
        .args(["sweep", verb, "s.toml", "--out", "out"])
        .args(words)
        .assert()
}

fn prepared(text: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("s.toml"), text).unwrap();
    folder
}

/// Runs a sweep and returns its results: arm, instance, seed, metric, value.
fn results(folder: &Path) -> Vec<[String; 5]> {
    sweep(folder, "run", &[]).success();
    sweep(folder, "collect", &[]).success();
    let mut reader = csv::Reader::from_path(folder.join("out/results.csv")).unwrap();
    let row = |record: csv::StringRecord| [1, 2, 3, 4, 5].map(|k| record[k].to_owned());
    reader
        .records()
        .map(|record| row(record.unwrap()))
        .collect()
}

/// Rows of an arm without its name.
fn of<'a>(rows: &'a [[String; 5]], arm: &str) -> Vec<&'a [String]> {
    let own = rows.iter().filter(|row| row[0] == arm);
    own.map(|row| &row[1..]).collect()
}

fn python() -> bool {
    let found = std::process::Command::new("python3")
        .arg("--version")
        .output();
    found.is_ok_and(|output| output.status.success())
}

fn methods() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/arms")
}

/// Study, data, its own settings, the places of its command beside input and output, and the example in Python.
const STUDIES: [(&str, &str, &str, &str, &str); 4] = [
    (
        "facade_grammar/infer",
        "layouts/cottage_[12].facade.json",
        "iterations = 5",
        "",
        "grammar",
    ),
    (
        "structure_completion/complete",
        "layouts/o*.facade.json",
        "method = \"mirror\"",
        "{learn}",
        "completion",
    ),
    (
        "model/gmm",
        "mixture_1.csv",
        "most = 3",
        "{learn}",
        "density",
    ),
    (
        "procedural_logic/retrieval",
        "layouts/cottage_*.facade.json",
        "sizes = 2",
        "{learn}",
        "retrieval",
    ),
];

#[test]
fn a_built_in_method_run_as_a_command_gives_the_same_bits() {
    for (study, data, base, learn, _) in STUDIES {
        let learn = match learn {
            "" => "",
            _ => "--learn {learn}",
        };
        let folder = prepared(&format!(
            "study = {study:?}\ndata = [{data:?}]\nseeds = 2\n[base]\n{base}\n[[arm]]\nname = \"own\"\n[[arm]]\nname = \"command\"\n\
             command = \"{EDIFICE} sweep candidate {study} {{input}} {{output}} {learn} --seed {{seed}} --settings {{settings}} --claims {{claims}}\"\n"
        ));
        let rows = results(folder.path());
        let own: Vec<&[String]> = of(&rows, "own");
        // A bound is proven by a method, never stated by a command.
        let own: Vec<&[String]> = own.into_iter().filter(|row| row[2] != "bound").collect();
        assert!(own.len() >= 2, "{study}: {rows:?}");
        assert!(
            own.iter().all(|row| row[2] != "failure"),
            "{study}: {rows:?}"
        );
        assert_eq!(own, of(&rows, "command"), "{study}");
    }
}

#[test]
fn twenty_lines_of_python_enter_four_studies() {
    if !python() {
        eprintln!("not run: there is no python3");
        return;
    }
    for (study, data, base, learn, method) in STUDIES {
        let source = methods().join(format!("{method}.py"));
        let text = std::fs::read_to_string(&source).unwrap();
        assert!(text.lines().count() <= 20, "{method}");
        let folder = prepared(&format!(
            "study = {study:?}\ndata = [{data:?}]\nseeds = 2\n[base]\n{base}\n[[arm]]\nname = \"own\"\n[[arm]]\nname = \"mine\"\n\
             command = \"python3 mine.py {{input}} {{output}} {learn}\"\nfiles = [\"mine.py\"]\n"
        ));
        std::fs::write(folder.path().join("mine.py"), text).unwrap();
        let rows = results(folder.path());
        let mine = of(&rows, "mine");
        assert!(
            mine.iter().all(|row| row[2] != "failure"),
            "{study}: {mine:?}"
        );
        let first = |arm: &str| of(&rows, arm).len();
        assert!(
            first("mine") > 0 && first("mine") <= first("own"),
            "{study}"
        );
        sweep(folder.path(), "report", &[]).success();
        sweep(folder.path(), "bundle", &["-o", "b.zip"]).success();
        let verify = |more: &[&str]| {
            let run = Command::new(EDIFICE)
                .current_dir(folder.path())
                .args(["sweep", "verify", "b.zip", "--sample", "4", "--json"])
                .args(more)
                .assert()
                .success();
            String::from_utf8_lossy(&run.get_output().stdout).into_owned()
        };
        // Programs of a bundle are run only when that is said.
        assert!(!verify(&[]).contains("\"not_run\":0"), "{study}");
        assert!(verify(&["--commands"]).contains("\"not_run\":0"), "{study}");
        // A changed method runs its tasks again, and no other's.
        let more = "# Another version.\n";
        let path = folder.path().join("mine.py");
        let text = std::fs::read_to_string(&path).unwrap();
        std::fs::write(&path, text + more).unwrap();
        sweep(folder.path(), "run", &[]).failure();
        sweep(folder.path(), "plan", &[]).success();
        let again = sweep(folder.path(), "run", &["--json"]).success();
        let said = String::from_utf8_lossy(&again.get_output().stdout).into_owned();
        let tasks = |rows: &[&[String]]| {
            let mut tasks: Vec<(&str, &str)> = rows
                .iter()
                .map(|r| (r[0].as_str(), r[1].as_str()))
                .collect();
            tasks.dedup();
            tasks.len()
        };
        let expected = format!("\"before\":{}", tasks(&of(&rows, "own")));
        assert!(said.contains(&expected), "{study}: {said}, {expected}");
    }
}

/// A shell script that gives an answer, and the reason of its failure.
const LIES: [(&str, &str, &str); 12] = [
    ("nothing", "true", "wrote no answer"),
    ("empty", ": > \"$2\"", "is empty"),
    (
        "status",
        "echo broken >&2; exit 3",
        "exit status: 3: broken",
    ),
    ("hang", "sleep 1000", "stopped after"),
    (
        "a child that hangs",
        "sleep 1000 & cp \"$1\" \"$2\"",
        "unknown format",
    ),
    (
        "two gigabytes",
        "head -c 2000000000 /dev/zero > \"$2\"; sleep 5",
        "wrote more than 64 MB",
    ),
    (
        "much said",
        "head -c 2000000000 /dev/zero; sleep 5",
        "wrote more than 64 MB",
    ),
    (
        "not a number",
        "sed 's/\"size\": [0-9.]*/\"size\": NaN/' \"$ANSWER\" > \"$2\"",
        "line",
    ),
    (
        "wrong size",
        "sed 's/\"width\": [0-9.]*/\"width\": 1/' \"$ANSWER\" > \"$2\"",
        "",
    ),
    ("no grammar", "echo hello > \"$2\"", ""),
    (
        "another facade",
        "sed 's/\"symbol\": \"wall\"/\"symbol\": \"door\"/' \"$ANSWER\" > \"$2\"",
        "",
    ),
    ("a folder", "mkdir \"$2\"", "wrote no answer"),
];

#[test]
fn lying_answers_fail_with_their_reason_and_harm_no_other() {
    let mut text = "study = \"facade_grammar/infer\"\ndata = [\"layouts/cottage_1.facade.json\"]\n[base]\niterations = 5\n\
        [[arm]]\nname = \"honest\"\n"
        .to_owned();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let layout = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("datasets/facade_grammar/layouts/cottage_1.facade.json");
    let answer = path.join("answer.grammar.json");
    Command::new(EDIFICE)
        .args(["grammar", "infer"])
        .arg(&layout)
        .arg("-o")
        .arg(&answer)
        .assert()
        .success();
    for (index, (name, script, _)) in LIES.iter().enumerate() {
        let script = format!("ANSWER='{}'\n{script}\n", answer.display());
        std::fs::write(path.join(format!("{index}.sh")), script).unwrap();
        text += &format!(
            "[[arm]]\nname = {name:?}\ncommand = \"sh {index}.sh {{input}} {{output}}\"\nfiles = [\"{index}.sh\"]\ntimeout = {}\n",
            if *name == "hang" { 1.5 } else { 20.0 }
        );
    }
    std::fs::write(path.join("s.toml"), text).unwrap();
    let start = Instant::now();
    let rows = results(path);
    assert!(start.elapsed() < Duration::from_secs(90));
    assert!(of(&rows, "honest").iter().all(|row| row[2] != "failure"));
    for (name, _, reason) in LIES {
        let own = of(&rows, name);
        assert_eq!(own.len(), 1, "{name}: {own:?}");
        assert_eq!(own[0][2], "failure", "{name}: {own:?}");
        assert!(own[0][3].contains(reason), "{name}: {own:?}");
    }
}

#[test]
fn an_answer_below_a_proven_bound_is_no_record() {
    let folder = prepared(
        "study = \"facade_grammar/infer\"\ndata = [\"layouts/cottage_1.facade.json\"]\n[base]\niterations = 5\n\
         [[arm]]\nname = \"best\"\n[[arm]]\nname = \"greedy\"\nset.method = \"greedy\"\n",
    );
    let rows = results(folder.path());
    let bound = rows.iter().find(|row| row[3] == "bound").unwrap();
    let bound: f64 = bound[4].parse().unwrap();
    let journal = folder.path().join("out/journal/0-of-1.jsonl");
    let text = std::fs::read_to_string(&journal).unwrap();
    let forged: Vec<String> = text
        .lines()
        .map(|line| {
            let mut entry: serde_json::Value = serde_json::from_str(line).unwrap();
            if entry["outcome"]["bound"].is_null() {
                entry["outcome"]["metrics"]["cost"] = (0.9 * bound).into();
            }
            entry.to_string()
        })
        .collect();
    std::fs::write(&journal, forged.join("\n") + "\n").unwrap();
    let rows = results(folder.path());
    let greedy = of(&rows, "greedy");
    assert_eq!(greedy[0][2], "failure", "{greedy:?}");
    assert!(
        greedy[0][3].contains("that arm `best` proved"),
        "{greedy:?}"
    );
    assert!(of(&rows, "best").iter().any(|row| row[2] == "cost"));
}

#[test]
fn refused_sweeps_leave_no_folder() {
    for (text, expected) in [
        ("study = \"nothing\"\ndata = [\"a\"]\n", "no study"),
        (
            "study = \"model/gmm\"\ndata = [\"nothing_like_it\"]\n[[arm]]\nname = \"a\"\n",
            "no file is called so",
        ),
        (
            "study = \"model/gmm\"\ndata = [\"mixture_1.csv\"]\n[[arm]]\nname = \"a\"\ncommand = \"a {input}\"\n",
            "line 5, column 11: command: it has no {output}",
        ),
        (
            "study = \"optim/genetic\"\ndata = [\"*.json\"]\n[[arm]]\nname = \"a\"\ncommand = \"a {input} {output}\"\n",
            "takes none",
        ),
        (
            "study = \"model/gmm\"\ndata = [\"mixture_1.csv\"]\n[[arm]]\nname = \"a\"\ntimeout = 3.0\n",
            "only an arm with a `command`",
        ),
        (
            "study = \"model/gmm\"\ndata = [\"mixture_1.csv\"]\n[[arm]]\nname = \"a\"\ncommand = \"a {input} {output}\"\nfiles = [\"b.py\"]\n",
            "line 6, column 9: files: there is no file `b.py`",
        ),
        (
            "study = \"model/gmm\"\ndata = [\"mixture_1.csv\"]\n[base]\nmost = 0\n[[arm]]\nname = \"a\"\n",
            "nonzero",
        ),
    ] {
        let folder = prepared(text);
        for verb in ["plan", "run"] {
            let failed = sweep(folder.path(), verb, &[]).failure().code(1);
            let said = String::from_utf8_lossy(&failed.get_output().stderr).into_owned();
            assert!(said.contains(expected), "{text}: {said}");
            assert!(!folder.path().join("out").exists(), "{text}");
        }
    }
}

#[test]
fn bundles_whose_names_lead_out_are_refused() {
    if !python() {
        eprintln!("not run: there is no python3");
        return;
    }
    let folder = prepared(
        "study = \"optim/annealing\"\ndata = [\"weakly_1.knapsack.json\"]\n[base]\nrounds = 2\n[[arm]]\nname = \"a\"\n",
    );
    let path = folder.path();
    sweep(path, "run", &[]).success();
    sweep(path, "bundle", &["-o", "b.zip"]).success();
    for (name, expected) in [
        ("../evil", "leads out of the folder"),
        ("a/../../evil", "leads out of the folder"),
        ("/evil", "is not in the manifest"),
        ("more", "is not in the manifest"),
    ] {
        std::fs::copy(path.join("b.zip"), path.join("c.zip")).unwrap();
        let code = format!("import zipfile; zipfile.ZipFile('c.zip', 'a').writestr({name:?}, 'x')");
        let made = std::process::Command::new("python3")
            .current_dir(path)
            .args(["-c", &code])
            .status();
        assert!(made.unwrap().success());
        let failed = Command::new(EDIFICE)
            .current_dir(path)
            .args(["sweep", "verify", "c.zip"])
            .assert()
            .failure()
            .code(1);
        let said = String::from_utf8_lossy(&failed.get_output().stderr).into_owned();
        assert!(said.contains(expected), "{name}: {said}");
    }
}
