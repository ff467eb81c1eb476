//! Running a command for one task: in a folder of its own, without a shell, within limits.

use std::collections::BTreeMap;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::process::{Child, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use serde_json::{Map, Value};

use super::Command;
use super::limits::{bytes, bytes_below, resident};
use crate::trial::Posed;
use edifice_base::{Error, Progress, Result, Watched};

/// Most bytes that a command may write, answer and messages together.
const MOST: u64 = 64 << 20;
/// Between two looks at a running command.
const PAUSE: Duration = Duration::from_millis(20);
/// Looks at the time between two looks at memory.
const SELDOM: u32 = 10;

/// Why a command gave no answer.
#[derive(Debug, thiserror::Error)]
enum CommandError {
    #[error("the command cannot be started: {0}: {1}")]
    Start(String, std::io::Error),
    #[error("the command was stopped after {0} s, its `timeout`")]
    Timeout(f64),
    #[error("the command wrote more than {} MB and was stopped", MOST >> 20)]
    Size,
    #[error("the command used more than {0} of memory (`mem` of [task]) and was stopped")]
    Memory(String),
    #[error("the command ended with {status}{said}")]
    Status { status: String, said: String },
    #[error("the command wrote no answer to {{output}}")]
    NoAnswer,
    #[error("the command's answer is empty")]
    Empty,
    #[error("{{claims}} holds no JSON object of numbers: {0}")]
    Claims(String),
}

/// The circumstances of a command.
#[derive(Clone, Copy)]
pub struct Circumstances<'a> {
    /// All settings of the arm.
    pub settings: &'a Map<String, Value>,
    /// Seed of all chance.
    pub seed: u64,
    /// Most memory, as Slurm writes it.
    pub memory: &'a str,
    /// The run that the command belongs to: when it is stopped, so is the command.
    pub watched: &'a Watched<'a>,
}

/// Runs a command on a question until its answer lies in `output`; returns the metrics that it states of itself.
///
/// The command runs in an empty folder with copies of its files, and that folder goes with all that is in it. When it ends, so does every
/// process of its group.
///
/// # Errors
/// [`Error::Method`] with the reason, [`Error::Interrupted`].
pub fn ask(
    command: &Command,
    posed: &Posed,
    output: &Path,
    about: &Circumstances,
) -> Result<BTreeMap<String, f64>> {
    let folder = tempfile::tempdir().map_err(|e| Error::io("command".as_ref(), "prepare", e))?;
    let work = folder.path().join("work");
    let own = folder.path().join("own");
    for path in [&work, &own] {
        std::fs::create_dir(path).map_err(|e| Error::io(path, "create", e))?;
    }
    for file in &command.files {
        let to = work.join(&file.name);
        std::fs::copy(&file.path, &to).map_err(|e| Error::io(&file.path, "copy", e))?;
    }
    let settings = own.join("settings.json");
    let text = serde_json::to_vec(about.settings).map_err(Error::method)?;
    std::fs::write(&settings, text).map_err(|e| Error::io(&settings, "write", e))?;
    let claims = own.join("claims.json");
    let words = command.filled(|place| match place {
        "input" => words(&posed.input),
        "output" => words(output),
        // A study that does not learn has an empty folder for it.
        "learn" => words(posed.learn.as_deref().unwrap_or(&own)),
        "settings" => words(&settings),
        "claims" => words(&claims),
        _ => about.seed.to_string(),
    })?;
    let said = [own.join("stdout"), own.join("stderr")];
    let mut child = start(&words, &work, &said)?;
    let watched = [work.as_path(), own.as_path()];
    let ended = wait(&mut child, command, output, &watched, about);
    end(&mut child);
    let status = ended?;
    if !status.success() {
        let status = status.to_string();
        let said = last_words(&said[1]);
        return Err(Error::method(CommandError::Status { status, said }));
    }
    match std::fs::metadata(output) {
        Err(_) => return Err(Error::method(CommandError::NoAnswer)),
        Ok(about) if !about.is_file() => return Err(Error::method(CommandError::NoAnswer)),
        Ok(about) if about.len() == 0 => return Err(Error::method(CommandError::Empty)),
        Ok(about) if about.len() > MOST => return Err(Error::method(CommandError::Size)),
        Ok(_) => {}
    }
    stated(&claims)
}

fn words(path: &Path) -> String {
    path.to_string_lossy().into_owned()
}

fn start(words: &[String], work: &Path, said: &[PathBuf; 2]) -> Result<Child> {
    let sink = |path: &PathBuf| File::create(path).map_err(|e| Error::io(path, "create", e));
    let mut program = std::process::Command::new(&words[0]);
    program
        .args(&words[1..])
        .current_dir(work)
        .stdin(Stdio::null())
        .stdout(sink(&said[0])?)
        .stderr(sink(&said[1])?);
    #[cfg(unix)]
    {
        use std::os::unix::process::CommandExt;
        program.process_group(0);
    }
    let failed = |e| Error::method(CommandError::Start(words[0].clone(), e));
    program.spawn().map_err(failed)
}

/// The result of a call, and the seconds that it took: told beside results, never part of them.
pub fn timed<T>(call: impl FnOnce() -> T) -> (T, f64) {
    let start = Instant::now();
    let found = call();
    (found, start.elapsed().as_secs_f64())
}

/// Waits for the end of a command, or for a reason to end it.
fn wait(
    child: &mut Child,
    command: &Command,
    output: &Path,
    watched: &[&Path],
    about: &Circumstances,
) -> Result<ExitStatus> {
    let start = Instant::now();
    let memory = bytes(about.memory);
    for look in 0u32.. {
        let ended = child.try_wait();
        if let Some(status) = ended.map_err(|e| Error::io("command".as_ref(), "wait for", e))? {
            return Ok(status);
        }
        if !about.watched.goes_on(Progress::stage("command")) {
            return Err(Error::Interrupted);
        }
        if start.elapsed().as_secs_f64() > command.timeout {
            return Err(Error::method(CommandError::Timeout(command.timeout)));
        }
        let answer = std::fs::metadata(output).map_or(0, |about| about.len());
        let written: u64 = watched.iter().map(|folder| bytes_below(folder)).sum();
        let copied: u64 = (command.files.iter())
            .map(|file| std::fs::metadata(&file.path).map_or(0, |about| about.len()))
            .sum();
        if answer.saturating_add(written).saturating_sub(copied) > MOST {
            return Err(Error::method(CommandError::Size));
        }
        if look % SELDOM == 0 && resident(child.id()) > memory {
            let memory = about.memory.to_owned();
            return Err(Error::method(CommandError::Memory(memory)));
        }
        // Short commands are met soon, long ones cost nothing.
        std::thread::sleep(PAUSE.min(Duration::from_millis(1 + u64::from(look))));
    }
    Err(Error::Interrupted)
}

/// Ends a command with all processes of its group.
fn end(child: &mut Child) {
    #[cfg(unix)]
    if let Ok(id) = i32::try_from(child.id()) {
        use nix::sys::signal::{Signal, killpg};
        // There is no such group when all have ended.
        let _ = killpg(nix::unistd::Pid::from_raw(id), Signal::SIGKILL);
    }
    let _ = child.kill();
    let _ = child.wait();
}

/// The end of what a command said, for the reason of a failure.
fn last_words(path: &Path) -> String {
    use std::io::{Read, Seek, SeekFrom};
    /// Bytes that are looked at.
    const END: u64 = 2000;
    let read = || -> std::io::Result<String> {
        let mut file = File::open(path)?;
        let length = file.metadata()?.len();
        file.seek(SeekFrom::Start(length.saturating_sub(END)))?;
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes)?;
        Ok(String::from_utf8_lossy(&bytes).into_owned())
    };
    let text = read().unwrap_or_default();
    let last = text.lines().rev().find(|line| !line.trim().is_empty());
    last.map_or_else(String::new, |line| format!(": {}", line.trim()))
}

/// The metrics that a command states of itself.
fn stated(path: &Path) -> Result<BTreeMap<String, f64>> {
    let wrong = |e: &dyn std::fmt::Display| Error::method(CommandError::Claims(e.to_string()));
    match std::fs::read(path) {
        Ok(bytes) => serde_json::from_slice(&bytes).map_err(|e| wrong(&e)),
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => Ok(BTreeMap::new()),
        Err(e) => Err(wrong(&e)),
    }
}
