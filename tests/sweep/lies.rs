//! Foreign answers of completion, densities and retrieval that lie: each fails its own task with the reason.

use std::path::Path;

use assert_cmd::Command;

/// The program.
const EDIFICE: &str = env!("CARGO_BIN_EXE_edifice");

/// Name, shell script with the question as `$1` and the answer as `$2`, and the reason of the failure.
type Lie = (&'static str, &'static str, &'static str);

/// Study, data, settings, and its lies.
const STUDIES: [(&str, &str, &str, &[Lie]); 3] = [
    (
        "structure_completion/complete",
        "layouts/office_*.facade.json",
        "method = \"mirror\"",
        &[
            (
                "region outside",
                "sed 's/\"x\": [0-9.]*/\"x\": 99999/' \"$1\" > \"$2\"",
                "reaches outside",
            ),
            (
                "wrong size",
                "$EDIFICE facade edit \"$1\" 'outline 9999,9999' -o \"$2\"",
                "in size, the facade",
            ),
            (
                "observed left out",
                "$EDIFICE facade edit \"$1\" 'remove #0' -o \"$2\"",
                "is not in the answer",
            ),
            (
                "unknown class",
                "$EDIFICE facade edit \"$1\" 'relabel #0=tree' -o \"$2\"",
                "is a `tree`",
            ),
            (
                "not a number",
                "sed 's/\"width\": [0-9.]*/\"width\": NaN/' \"$1\" > \"$2\"",
                "line",
            ),
            ("empty", ": > \"$2\"", "is empty"),
        ],
    ),
    (
        "model/gmm",
        "mixture_1.csv",
        "most = 2",
        &[
            (
                "not a number",
                "printf 'log_density\\nNaN\\n' > \"$2\"",
                "`NaN` is no finite number",
            ),
            (
                "infinite",
                "printf 'log_density\\ninf\\n' > \"$2\"",
                "`inf` is no finite number",
            ),
            (
                "too few",
                "printf 'log_density\\n-1\\n' > \"$2\"",
                "1 log densities, expected one for each of",
            ),
            (
                "too dense",
                "awk 'NR == 1 { print \"log_density\" } NR > 1 { print 100 }' \"$1\" > \"$2\"",
                "no log densities of a density",
            ),
            (
                "no column",
                "printf 'density\\n1\\n' > \"$2\"",
                "there is no column `log_density`",
            ),
            ("empty", ": > \"$2\"", "is empty"),
        ],
    ),
    (
        "procedural_logic/retrieval",
        "layouts/cottage_*.facade.json",
        "sizes = 2",
        &[
            (
                "nobody",
                "printf 'query,facade,distance\\nnobody,nothing,1\\n' > \"$2\"",
                "nobody",
            ),
            (
                "nothing ranked",
                "printf 'query,facade,distance\\n' > \"$2\"",
                "has no rows",
            ),
            (
                "below zero",
                "printf 'query,facade,distance\\n%s,%s,-1\\n' \"$(sed -n 2p \"$1\")\" \"$(sed -n 3p \"$1\")\" > \"$2\"",
                "is no finite number of at least 0",
            ),
            (
                "one of many",
                "printf 'query,facade,distance\\n%s,%s,1\\n' \"$(sed -n 2p \"$1\")\" \"$(sed -n 3p \"$1\")\" > \"$2\"",
                "is missing",
            ),
            (
                "other columns",
                "printf 'a,b\\n1,2\\n' > \"$2\"",
                "expected query, facade and distance",
            ),
            ("empty", ": > \"$2\"", "is empty"),
        ],
    ),
];

fn sweep(folder: &Path, verb: &str) {
    let words = ["sweep", verb, "s.toml", "--out", "out"];
    let mut command = Command::new(EDIFICE);
    command.current_dir(folder).args(words).assert().success();
}

#[test]
fn lies_of_each_study_fail_with_their_reason_and_harm_no_other() {
    for (study, data, settings, lies) in STUDIES {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path();
        let mut text = format!(
            "study = {study:?}\ndata = [{data:?}]\n[base]\n{settings}\n[[arm]]\nname = \"honest\"\n"
        );
        for (index, (name, script, _)) in lies.iter().enumerate() {
            let script = format!("EDIFICE='{EDIFICE}'\n{script}\n");
            std::fs::write(path.join(format!("{index}.sh")), script).expect("a script");
            text += &format!(
                "[[arm]]\nname = {name:?}\ncommand = \"sh {index}.sh {{input}} {{output}}\"\nfiles = [\"{index}.sh\"]\ntimeout = 20.0\n"
            );
        }
        std::fs::write(path.join("s.toml"), text).expect("a sweep");
        sweep(path, "run");
        sweep(path, "collect");
        let mut reader = csv::Reader::from_path(path.join("out/results.csv")).expect("results");
        let rows: Vec<csv::StringRecord> = reader.records().map(|r| r.expect("a row")).collect();
        let of = |arm: &str| -> Vec<(String, String)> {
            let own = rows.iter().filter(|row| &row[1] == arm);
            own.map(|row| (row[4].to_owned(), row[5].to_owned()))
                .collect()
        };
        let honest = of("honest");
        assert!(!honest.is_empty(), "{study}: {rows:?}");
        assert!(
            honest.iter().all(|(metric, _)| metric != "failure"),
            "{study}: {honest:?}"
        );
        for (name, _, reason) in lies {
            let own = of(name);
            assert!(!own.is_empty(), "{study}, {name}");
            for (metric, value) in own {
                assert_eq!(metric, "failure", "{study}, {name}: {value}");
                assert!(value.contains(reason), "{study}, {name}: {value}");
            }
        }
    }
}
