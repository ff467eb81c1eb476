//! The program itself is killed while it saves, and the disk is full: nothing is lost.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use edifice::rng::stream;
use edifice_editing as editing;
use edifice_editing::work::Work;
use rand::RngExt;

/// A studio in a process of its own.
pub(crate) struct Process {
    pub child: Child,
    port: u16,
    pub token: String,
    /// Folder of its state, unless the test has one of its own.
    _state: Option<tempfile::TempDir>,
}

impl Process {
    /// Runs `prefix... edifice studio --no-open FILE`.
    pub(crate) fn start(prefix: &[&str], file: &Path) -> Self {
        let state = tempfile::tempdir().expect("a folder");
        let mut process = Self::start_in(prefix, file, state.path());
        process._state = Some(state);
        process
    }

    /// The same with a folder of its state.
    pub(crate) fn start_in(prefix: &[&str], file: &Path, state: &Path) -> Self {
        let words = [
            prefix,
            &[env!("CARGO_BIN_EXE_edifice"), "studio", "--no-open"],
        ]
        .concat();
        let mut command = Command::new(words[0]);
        command.args(&words[1..]).arg(file);
        Self::run(command, state)
    }

    /// Runs a command that is a studio.
    pub(crate) fn run(mut command: Command, state: &Path) -> Self {
        let mut child = command
            .env("XDG_STATE_HOME", state)
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("starts");
        let mut line = String::new();
        let out = child.stdout.take().expect("piped");
        BufReader::new(out)
            .read_line(&mut line)
            .expect("an address");
        let (place, token) = line.trim().split_once("/#token=").expect("a token");
        let port = place.rsplit(':').next().and_then(|p| p.parse().ok());
        Self {
            child,
            port: port.expect("a port"),
            token: token.to_owned(),
            _state: None,
        }
    }

    /// Sends a request; the connection that its answer comes on.
    fn send(&self, path: &str, body: &str) -> Option<TcpStream> {
        self.send_to(&format!("/api/documents/d1/{path}"), body)
    }

    fn send_to(&self, path: &str, body: &str) -> Option<TcpStream> {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).ok()?;
        stream
            .set_read_timeout(Some(Duration::from_secs(30)))
            .ok()?;
        let text = format!(
            "{} {path} HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nX-Edifice-Token: {}\r\nConnection: close\r\n\
             Content-Type: application/json\r\nContent-Length: {}\r\n\r\n{body}",
            if body.is_empty() { "GET" } else { "POST" },
            self.port,
            self.token,
            body.len()
        );
        stream.write_all(text.as_bytes()).ok()?;
        Some(stream)
    }

    pub(crate) fn post(&self, path: &str, body: &str) -> String {
        self.ask(&format!("/api/documents/d1/{path}"), body)
    }

    /// The answer to a request; GET without a body.
    pub(crate) fn ask(&self, path: &str, body: &str) -> String {
        let mut text = String::new();
        let mut stream = self.send_to(path, body).expect("connects");
        stream.read_to_string(&mut text).expect("answers");
        text
    }

    pub(crate) fn edit(&self, revision: usize, edit: &str) -> String {
        let body = format!(
            "{{\"commands\": [{{\"do\": \"edit\", \"edits\": [\"{edit}\"]}}], \"revision\": {revision}}}"
        );
        self.post("edit", &body)
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// A layout of `count` elements: its file takes a while to write.
pub(crate) fn large(folder: &Path, count: usize) -> PathBuf {
    let region = |k: usize| {
        let (x, y) = (k % 100, k / 100);
        format!(
            "{{ \"label\": \"window\", \"x\": {x}, \"y\": {y}, \"width\": 0.5, \"height\": 0.5 }}"
        )
    };
    let regions: Vec<String> = (0..count).map(region).collect();
    let text = format!(
        "{{ \"format\": \"edifice/facade\", \"version\": 1, \"name\": \"f\", \"unit\": \"m\", \"width\": 101, \"height\": {}, \"regions\": [{}] }}",
        count / 100 + 2,
        regions.join(",\n")
    );
    let path = folder.join("f.facade.json");
    std::fs::write(&path, text).expect("written");
    path
}

fn opens(path: &Path) -> bool {
    let bytes = std::fs::read(path).expect("there");
    editing::open(path, &bytes, &Work::default()).is_ok()
}

#[cfg(unix)]
#[test]
fn killed_while_it_saves_it_leaves_a_whole_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = large(folder.path(), 2500);
    let mut rng = stream(3, "studio/kill", 0);
    let (mut old, mut new) = (0, 0);
    for round in 0..25 {
        let before = std::fs::read(&path).expect("there");
        let mut process = Process::start(&[], &path);
        let answer = process.edit(0, &format!("move #0={},0.25", 0.01 * f64::from(round + 1)));
        assert!(answer.starts_with("HTTP/1.1 200"), "{answer}");
        let _waiting = process.send("save", "{}").expect("connects");
        std::thread::sleep(Duration::from_micros(rng.random_range(0..30_000)));
        process.child.kill().expect("killed");
        process.child.wait().expect("ended");
        assert!(opens(&path), "round {round}: the file is whole");
        match std::fs::read(&path).expect("there") == before {
            true => old += 1,
            false => new += 1,
        }
    }
    // At least one save came in time, and at least one did not: the kills fell around the write.
    println!("killed 25 times: {old} times the old file, {new} times the new one, never a part");
    // What killed writers left is removed by the next one.
    let process = Process::start(&[], &path);
    process.edit(0, "move #1=1.25,0.25");
    let saved = process.post("save", "{}");
    assert!(saved.starts_with("HTTP/1.1 200"), "{saved}");
    let names = std::fs::read_dir(folder.path()).expect("listed").flatten();
    let mut names: Vec<String> = names
        .map(|e| e.file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    assert_eq!(names, ["f.facade.json", "f.sh"]);
}

/// Saves where there is no room, then where there is.
#[cfg(unix)]
fn no_room(process: &Process, path: &Path, make_room: impl Fn()) {
    let before = std::fs::read(path).expect("there");
    let answer = process.edit(0, "move #0=0.5,0.25");
    assert!(answer.starts_with("HTTP/1.1 200"), "{answer}");
    let refused = process.post("save", "{}");
    assert!(refused.starts_with("HTTP/1.1 422"), "{refused}");
    assert!(refused.contains("cannot write"), "{refused}");
    assert_eq!(std::fs::read(path).expect("there"), before);
    // The edit is still there, and saved once there is room.
    let document = process.edit(1, "move #1=1.5,0.25");
    assert!(
        document.contains("\"x\":0.5") && document.contains("\"x\":1.5"),
        "it answers"
    );
    make_room();
    let saved = process.post("save", "{}");
    assert!(saved.starts_with("HTTP/1.1 200"), "{saved}");
    assert!(opens(path));
    let names = std::fs::read_dir(path.parent().expect("a folder")).expect("listed");
    let left = names
        .flatten()
        .filter(|e| e.file_name().to_string_lossy().contains(".tmp"));
    assert_eq!(left.count(), 0);
}

#[cfg(target_os = "linux")]
#[test]
fn a_limit_on_files_is_told_and_nothing_is_lost() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = large(folder.path(), 2500);
    // Files of at most 64 blocks of 512 bytes; without the trap the system would end the program.
    let limit = [
        "sh",
        "-c",
        "trap '' XFSZ; ulimit -S -f 64; exec \"$0\" \"$@\"",
    ];
    let process = Process::start(&limit, &path);
    let raise = || {
        let id = process.child.id().to_string();
        let done = Command::new("prlimit")
            .args(["--pid", &id, "--fsize=unlimited"])
            .status();
        assert!(done.expect("prlimit runs").success());
    };
    no_room(&process, &path, raise);
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_told_and_nothing_is_lost() {
    let folder = tempfile::tempdir().expect("a folder");
    let disk = folder.path().join("disk");
    std::fs::create_dir(&disk).expect("a folder");
    let mount = Command::new("mount")
        .args(["-t", "tmpfs", "-o", "size=1m", "none"])
        .arg(&disk)
        .output();
    if !mount.is_ok_and(|m| m.status.success()) {
        println!("no right to mount a small disk: not tested");
        return;
    }
    let path = large(&disk, 2500);
    // What is left is less than the file.
    let filler = disk.join("filler");
    let mut rest = std::fs::File::create(&filler).expect("created");
    while rest.write_all(&[0; 4096]).is_ok() {}
    drop(rest);
    let process = Process::start(&[], &path);
    no_room(&process, &path, || {
        std::fs::remove_file(&filler).expect("removed")
    });
    drop(process);
    let done = Command::new("umount").arg(&disk).status();
    assert!(done.expect("umount runs").success());
}
