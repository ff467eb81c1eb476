//! The refusals of `.ci/sizes`, on repositories of a few files.

use std::path::Path;
use std::process::Command;

/// Writes the files into a new repository and returns what the script says; `None` when it passes.
fn complaint(files: &[(&str, usize)]) -> Option<String> {
    let folder = tempfile::tempdir().expect("a folder");
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join(".ci/sizes");
    for (name, bytes) in files {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("made");
        std::fs::write(path, vec![b'x'; *bytes]).expect("written");
    }
    std::fs::create_dir_all(folder.path().join(".ci")).expect("made");
    std::fs::copy(script, folder.path().join(".ci/sizes")).expect("copied");
    let run = |program: &str, words: &[&str]| {
        let mut command = Command::new(program);
        command.current_dir(folder.path()).args(words);
        command.output().expect("git and bash")
    };
    assert!(run("git", &["init", "-q"]).status.success());
    assert!(run("git", &["add", "-A"]).status.success());
    let output = run("bash", &[".ci/sizes"]);
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    (!output.status.success()).then_some(errors)
}

#[test]
fn large_files_have_to_be_listed() {
    let listed = "datasets/building_exteriors/houses.buildings.jsonl";
    assert_eq!(
        complaint(&[("a b.txt", 1_000_000), (listed, 1_200_000)]),
        None
    );
    let text = complaint(&[("a b.txt", 1_000_001)]).expect("too large");
    assert!(text.contains("a b.txt has 1000001 bytes"), "{text}");
}

#[test]
fn reports_stay_below_8_megabytes() {
    let files: Vec<String> = (0..9).map(|i| format!("reports/paper/{i}.csv")).collect();
    let sized = |n: usize| {
        files[..n]
            .iter()
            .map(|f| (f.as_str(), 900_000))
            .collect::<Vec<_>>()
    };
    assert_eq!(complaint(&sized(8)), None);
    let text = complaint(&sized(9)).expect("too large");
    assert!(text.contains("reports have 8100000 bytes"), "{text}");
}

#[test]
fn pictures_of_the_readme_are_packaged() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let text = |name: &str| std::fs::read_to_string(root.join(name)).expect("a text");
    let (readme, manifest) = (text("README.md"), text("Cargo.toml"));
    let links = readme
        .split("](")
        .skip(1)
        .filter_map(|l| l.split(')').next());
    let pictures: Vec<&str> = links.filter(|l| l.ends_with(".png")).collect();
    assert!(!pictures.is_empty());
    for picture in pictures {
        assert!(manifest.contains(&format!("\"!{picture}\"")), "{picture}");
    }
}
