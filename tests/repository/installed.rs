//! The program away from its checkout, twice at once, and after a kill.

use std::path::Path;

use assert_cmd::Command;

fn reproduce(folder: &Path) -> Command {
    let mut command = Command::cargo_bin("edifice").expect("the program");
    command
        .current_dir(folder)
        .env_remove("EDIFICE_DATA")
        .args([
            "reproduce",
            "facade_grammar",
            "--only",
            "table_3",
            "--budget",
            "smoke",
            "--out",
            "out",
        ]);
    command
}

#[test]
fn a_second_run_on_the_same_folder_says_so_and_a_run_after_a_kill_cleans_up() {
    let folder = tempfile::tempdir().expect("a folder");
    let paper = folder.path().join("out/facade_grammar");
    std::fs::create_dir_all(&paper).expect("a folder");
    // What another run holds, and what one that was killed leaves.
    let lock = std::fs::File::create(paper.join(".lock")).expect("a file");
    lock.lock().expect("locked");
    let left_over = paper.join(".edifice-Kill9d.tmp");
    std::fs::write(&left_over, b"half a fi").expect("written");
    let done = reproduce(folder.path()).assert().failure().code(1);
    let errors = String::from_utf8_lossy(&done.get_output().stderr).into_owned();
    assert!(
        errors.contains("out/facade_grammar: another run writes here"),
        "{errors}"
    );
    assert!(!paper.join("run.json").exists());

    drop(lock);
    reproduce(folder.path()).assert().success();
    assert!(paper.join("table_3.md").exists() && paper.join("run.json").exists());
    assert!(!left_over.exists());
    assert!(!paper.join(".work").exists());
}

#[test]
fn a_command_after_a_kill_cleans_up() {
    let folder = tempfile::tempdir().expect("a folder");
    let left_over = folder.path().join(".edifice-Kill9d.tmp");
    std::fs::write(&left_over, b"half a fi").expect("written");
    let asia = Path::new(env!("CARGO_MANIFEST_DIR")).join("datasets/model/asia.bif");
    let mut command = Command::cargo_bin("edifice").expect("the program");
    let convert = command
        .current_dir(folder.path())
        .args(["model", "convert"]);
    convert
        .arg(asia)
        .args(["-o", "asia.json"])
        .assert()
        .success();
    assert!(folder.path().join("asia.json").exists() && !left_over.exists());
}

/// The path of the checkout is known to the tests only: a program that looks there works on the
/// machine that built it and nowhere else.
#[test]
fn no_source_looks_into_the_checkout() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut folders = vec![root.join("src"), root.join("experiments")];
    let mut seen = 0;
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "rs") {
                let text = std::fs::read_to_string(&path).expect("source");
                let code = text.split("#[cfg(test)]").next().unwrap_or_default();
                assert!(
                    !code.contains("env!(\"CARGO_MANIFEST_DIR\")"),
                    "{}",
                    path.display()
                );
                seen += 1;
            }
        }
    }
    assert!(seen > 100, "only {seen} files found");
}
