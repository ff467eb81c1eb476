//! Runs that are killed at any moment: what they leave is whole or absent, and the next run tidies up.

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use edifice::io::city::{self, obj};
use edifice_generators_city_proceduralization as synthetic;

/// Moments at which a run is killed, as shares of the time that it takes undisturbed.
const MOMENTS: [f64; 9] = [0.02, 0.2, 0.4, 0.6, 0.8, 0.9, 0.95, 0.98, 1.0];

fn command(folder: &Path, args: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_edifice"));
    command.arg("city").args(args).current_dir(folder);
    command.stdout(Stdio::null()).stderr(Stdio::null());
    command
}

/// Kills the command at each moment; `whole` looks at what is left after it.
fn killed(folder: &Path, args: &[&str], whole: &dyn Fn()) {
    let start = Instant::now();
    assert!(
        command(folder, args).status().unwrap().success(),
        "{args:?}"
    );
    let time = start.elapsed();
    whole();
    for moment in MOMENTS {
        remove(folder);
        let mut child = command(folder, args).spawn().unwrap();
        std::thread::sleep(time.mul_f64(moment).max(Duration::from_millis(1)));
        child.kill().unwrap();
        child.wait().unwrap();
        whole();
    }
    // The next run is not disturbed by what is left, and leaves no temporary files.
    assert!(
        command(folder, args).status().unwrap().success(),
        "{args:?}"
    );
    whole();
    let folders = [folder.to_path_buf(), folder.join("out-tiles")];
    let names = folders.iter().filter_map(|f| std::fs::read_dir(f).ok());
    for entry in names.flatten() {
        let name = entry.unwrap().file_name();
        let name = name.to_string_lossy();
        assert!(!name.starts_with(".edifice-"), "{args:?} left {name}");
    }
}

/// Removes the results of a run, not what a killed one left beside them.
fn remove(folder: &Path) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if name.starts_with("out") {
            match path.is_dir() {
                true => std::fs::remove_dir_all(path).unwrap(),
                false => std::fs::remove_file(path).unwrap(),
            }
        }
    }
}

#[test]
fn killed_runs_leave_whole_files_or_none() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let (made, _) = synthetic::city(16, 0.0, 3);
    std::fs::write(folder.join("c.obj"), obj::to_string(&made)).unwrap();
    let grammar = folder.join("out.city-grammar.bin");
    let args = ["proceduralize", "c.obj", "-o", "out.city-grammar.bin"];
    killed(folder, &args, &|| {
        if grammar.exists() {
            let read = city::grammar_file::read(&grammar).unwrap();
            assert!(!read.templates.is_empty());
        }
    });
    std::fs::copy(&grammar, folder.join("g.city-grammar.bin")).unwrap();
    remove(folder);

    let derived = folder.join("out.obj");
    let args = ["derive", "g.city-grammar.bin", "-o", "out.obj"];
    killed(folder, &args, &|| {
        if derived.exists() {
            assert_eq!(city::read(&derived).unwrap().buildings.len(), 96);
        }
    });
    remove(folder);

    let tiles = folder.join("out-tiles");
    let args = ["tiles", "g.city-grammar.bin", "-o", "out-tiles"];
    killed(folder, &args, &|| {
        // The tileset is written last: where it is, its tiles are.
        let Ok(text) = std::fs::read_to_string(tiles.join("tileset.json")) else {
            return;
        };
        let tileset: serde_json::Value = serde_json::from_str(&text).unwrap();
        let contents = contents(&tileset["root"]);
        assert!(!contents.is_empty());
        for name in contents {
            let bytes = std::fs::read(tiles.join(&name)).unwrap();
            assert_eq!(&bytes[..4], b"glTF", "{name}");
        }
    });
}

/// The files of a tile and of those below it.
fn contents(tile: &serde_json::Value) -> Vec<String> {
    let mut all: Vec<String> = Vec::new();
    all.extend(tile["content"]["uri"].as_str().map(String::from));
    for child in tile["children"].as_array().into_iter().flatten() {
        all.extend(contents(child));
    }
    all
}
