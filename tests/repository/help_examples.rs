//! Every example of every `--help`, and every command line of the README, runs: in the order in which they stand, in one
//! folder, on files that ship or that an earlier line has made.
//!
//! Lines that take more than some seconds run with `EDIFICE_ALL_EXAMPLES=1`; without it, what later lines read of theirs
//! is copied from what ships. Lines that wait for a user are left out.

use std::path::{Path, PathBuf};
use std::process::Command;

/// Lines that wait for a user.
const WAITING: [&str; 1] = ["edifice studio"];
/// Parts of lines that take more than some seconds in a debug build.
const SLOW: [&str; 16] = [
    "edifice reproduce",
    "edifice facade train",
    "edifice sweep run ablation.toml --out ablation ",
    "edifice sweep retry",
    "edifice sweep report",
    "edifice building learn datasets/",
    "edifice building evaluate",
    "edifice building variations",
    "edifice building wish",
    "edifice building generate -n 12",
    "edifice building generate -n 6",
    "edifice model evaluate",
    "edifice model learn plans.csv --schema",
    "edifice building build sampled.csv",
    "edifice grammar town boulevard.cga --buildings 400",
    "edifice model learn plans.csv -o plans.table-model.json --from",
];
/// Files that slow lines make and later lines read, and the shipped files in their place.
const MADE: [(&str, &str); 1] = [(
    "structure_completion/default.completion.json",
    "mine.completion.json",
)];

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
    let mut inside = false;
    for line in text.lines() {
        match line.strip_prefix("Example: ") {
            Some(only) => found.push(only.to_owned()),
            None if line == "Examples:" || line == "Example:" => inside = true,
            None if inside && line.starts_with("  ") => found.push(line.trim().to_owned()),
            None => inside = false,
        }
    }
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

/// Command lines of the README, but for those of `cargo`.
fn of_readme() -> Vec<String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("README.md");
    let text = std::fs::read_to_string(path).expect("the README");
    let (mut lines, mut inside): (Vec<String>, bool) = (Vec::new(), false);
    for line in text.lines() {
        match lines.last_mut() {
            _ if line.starts_with("```") => inside = line == "```sh",
            _ if !inside => {}
            Some(last) if last.ends_with('\\') => {
                last.pop();
                last.push_str(line);
            }
            _ => lines.push(line.to_owned()),
        }
    }
    lines.retain(|line| !line.starts_with("cargo "));
    lines
}

#[test]
fn every_example_runs() {
    let folder = tempfile::tempdir().expect("a folder");
    let home = tempfile::tempdir().expect("a folder");
    for below in [
        ".local/share/bash-completion/completions",
        ".zfunc",
        ".config/fish/completions",
    ] {
        std::fs::create_dir_all(home.path().join(below)).expect("a folder");
    }
    for (name, bytes) in edifice_datasets::files() {
        let path = folder.path().join("datasets").join(name);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        std::fs::write(path, bytes).expect("a copy");
    }
    let all = std::env::var_os("EDIFICE_ALL_EXAMPLES").is_some();
    if !all {
        for (from, to) in MADE {
            let bytes = edifice_datasets::shipped_bytes(from).expect("a shipped file");
            std::fs::write(folder.path().join(to), bytes).expect("a copy");
        }
    }
    let mut lines = Vec::new();
    examples(&[], &mut lines);
    assert!(lines.len() > 120, "only {} examples of --help", lines.len());
    lines.extend(of_readme());
    let path = std::env::var("PATH").unwrap_or_default();
    let bin = program()
        .parent()
        .map(Path::to_path_buf)
        .unwrap_or_default();
    let (mut ran, mut slow, mut failed) = (0, 0, Vec::new());
    for line in &lines {
        if WAITING.iter().any(|s| line.contains(s)) {
            continue;
        }
        if !all && SLOW.iter().any(|s| line.contains(s)) {
            slow += 1;
            continue;
        }
        let start = std::time::Instant::now();
        let output = Command::new("bash")
            .args(["-c", line])
            .current_dir(folder.path())
            .env("PATH", format!("{}:{path}", bin.display()))
            .env("HOME", home.path())
            .env_remove("EDIFICE_DATA")
            .output()
            .expect("bash");
        ran += 1;
        let seconds = start.elapsed().as_secs_f64();
        if !output.status.success() {
            let errors = String::from_utf8_lossy(&output.stderr).into_owned();
            failed.push(format!("{line}\n    {errors}"));
        } else if seconds > 2.0 {
            eprintln!("{seconds:.0} s: {line}");
        }
    }
    eprintln!("{ran} examples run, {slow} slow ones left out");
    assert!(
        failed.is_empty(),
        "{} of {ran} fail:\n{}",
        failed.len(),
        failed.join("\n")
    );
    assert!(ran > 150, "only {ran} examples were run");
}
