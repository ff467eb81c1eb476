//! Every example of every `--help`, and every command line of the README, runs: in the order in which they stand, in one
//! folder, on files that ship or that an earlier line has made.
//!
//! Lines whose files neither ship nor are made (photographs, tables of one's own) are left out, but counted: their number
//! must not grow. Lines that take minutes are run with `EDIFICE_ALL_EXAMPLES=1`.

use std::path::{Path, PathBuf};
use std::process::Command;

/// Lines at most whose files are the reader's own.
const WITHOUT_FILES: usize = 75;
/// Beginnings of lines that take minutes, wait for a user, or leave the machine.
const SLOW: [&str; 7] = [
    "edifice studio",
    "edifice reproduce",
    "edifice sweep",
    "edifice building learn datasets/building_exteriors/houses.buildings.jsonl",
    "edifice building evaluate",
    "edifice model evaluate",
    "edifice model learn",
];

fn program() -> PathBuf {
    assert_cmd::cargo::cargo_bin("edifice")
}

fn help(words: &[String]) -> String {
    let output = Command::new(program())
        .args(words)
        .arg("--help")
        .output()
        .expect("the program");
    String::from_utf8(output.stdout).expect("text")
}

/// Examples of a command and those below it, in the order of the help.
fn examples(words: &[String], found: &mut Vec<String>) {
    let text = help(words);
    let lines = text.lines();
    found
        .extend(lines.filter_map(|l| l.strip_prefix("  edifice ").map(|l| format!("edifice {l}"))));
    let commands = text.split("Commands:\n").nth(1).unwrap_or_default();
    for line in commands.lines().take_while(|l| l.starts_with("  ")) {
        let Some(name) = line.split_whitespace().next() else {
            continue;
        };
        // Continued descriptions are indented further.
        if name != "help" && !line.starts_with("    ") {
            let mut below = words.to_vec();
            below.push(name.to_owned());
            examples(&below, found);
        }
    }
}

fn of_readme() -> Vec<String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("README.md");
    let text = std::fs::read_to_string(path).expect("the README");
    let mut lines: Vec<String> = Vec::new();
    for line in text.lines() {
        match lines.last_mut() {
            Some(last) if last.ends_with('\\') => {
                last.pop();
                last.push_str(line);
            }
            _ if line.starts_with("edifice ") => lines.push(line.to_owned()),
            _ => {}
        }
    }
    lines
}

/// True if the files that a line reads are there: words with a dot that do not follow an option of output.
fn has_files(line: &str, folder: &Path) -> bool {
    let outputs = ["-o", "--out", "--svg", "--report", "--glb", "--output", ">"];
    let command = line.split(" #").next().unwrap_or_default();
    let words: Vec<&str> = command.split_whitespace().collect();
    (0..words.len()).all(|k| {
        let word = words[k].trim_matches('\'');
        let written = k > 0 && outputs.contains(&words[k - 1]);
        let numeric =
            word.chars().any(|c| c == '=' || c == '@' || c == ',') || word.parse::<f64>().is_ok();
        let is_file = (word.contains('.') || word.ends_with('/')) && !written && !numeric;
        if !is_file || word.starts_with('-') {
            return true;
        }
        // What the line itself makes before.
        if command.split("&&").count() > 1 && command.contains(&format!("> {word}")) {
            return true;
        }
        match word.contains('*') {
            true => {
                let parent = folder.join(word).parent().map(Path::to_path_buf);
                parent.is_some_and(|p| p.is_dir())
            }
            false => folder.join(word).exists(),
        }
    })
}

#[test]
#[ignore = "minutes: cargo test --test repository help_examples -- --ignored"]
fn every_example_runs() {
    let folder = tempfile::tempdir().expect("a folder");
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    #[cfg(unix)]
    std::os::unix::fs::symlink(root.join("datasets"), folder.path().join("datasets"))
        .expect("a link");
    let all = std::env::var_os("EDIFICE_ALL_EXAMPLES").is_some();
    // What a slow first line makes, from what ships.
    let made = [("default.houses.json", "model.houses.json")];
    if !all {
        for (from, to) in made {
            let from = root.join("datasets/building_exteriors").join(from);
            std::fs::copy(from, folder.path().join(to)).expect("a copy");
        }
    }
    let mut lines = Vec::new();
    examples(&[], &mut lines);
    assert!(lines.len() > 80, "only {} examples of --help", lines.len());
    lines.extend(of_readme());
    let path = std::env::var("PATH").unwrap_or_default();
    let bin = program()
        .parent()
        .map(Path::to_path_buf)
        .unwrap_or_default();
    let (mut ran, mut without, mut failed) = (0, Vec::new(), Vec::new());
    for line in &lines {
        if !all && SLOW.iter().any(|s| line.starts_with(s)) {
            continue;
        }
        if !has_files(line, folder.path()) {
            without.push(line);
            continue;
        }
        let start = std::time::Instant::now();
        let output = Command::new("bash")
            .args(["-c", line])
            .current_dir(folder.path())
            .env("PATH", format!("{}:{path}", bin.display()))
            .output()
            .expect("bash");
        ran += 1;
        let seconds = start.elapsed().as_secs_f64();
        if !output.status.success() {
            let errors = String::from_utf8_lossy(&output.stderr).into_owned();
            failed.push(format!("{line}\n    {errors}"));
        } else if seconds > 20.0 {
            eprintln!("{seconds:.0} s: {line}");
        }
    }
    eprintln!("{ran} examples run, {} without their files", without.len());
    assert!(
        failed.is_empty(),
        "{} of {ran} fail:\n{}",
        failed.len(),
        failed.join("\n")
    );
    assert!(
        without.len() <= WITHOUT_FILES,
        "{} lines lack files: {without:#?}",
        without.len()
    );
    assert!(ran > 30, "only {ran} examples were run");
}
