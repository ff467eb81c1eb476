//! No other user of the machine sees the token: not in the arguments or the environment of a process, not in a file.

#![cfg(target_os = "linux")]

use std::io::{BufRead, BufReader};
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

/// A program in place of the browser's opener: it writes down its arguments and environment, and stays for a while.
const OPENER: &str = "#!/bin/sh\nfor a in \"$@\"; do echo \"$a\" >> \"$SEEN.part\"; done\nenv > \"$SEEN.env\"\nmv \"$SEEN.part\" \"$SEEN\"\nsleep 20\n";

/// Waits for a file.
fn awaited(path: &Path) -> String {
    for _ in 0..500 {
        if let Ok(text) = std::fs::read_to_string(path) {
            return text;
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    panic!("{} does not come", path.display());
}

/// All that `/proc` tells of the arguments and environments of all processes.
fn told_by_proc() -> String {
    let mut all = Vec::new();
    for entry in std::fs::read_dir("/proc").expect("listed").flatten() {
        for name in ["cmdline", "environ"] {
            all.extend(std::fs::read(entry.path().join(name)).unwrap_or_default());
        }
    }
    String::from_utf8_lossy(&all).into_owned()
}

#[test]
fn the_token_is_in_no_argument_and_in_no_file_of_others() {
    let script = Command::new("script").arg("--version").output();
    if !script.is_ok_and(|s| s.status.success()) {
        println!("no program `script` to make a terminal: not tested");
        return;
    }
    // Each folder above is one that others may enter: only the studio's own is closed.
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::set_permissions(folder.path(), std::fs::Permissions::from_mode(0o755)).expect("set");
    let (bin, seen) = (folder.path().join("bin"), folder.path().join("seen"));
    std::fs::create_dir(&bin).expect("a folder");
    let opener = bin.join("xdg-open");
    std::fs::write(&opener, OPENER).expect("written");
    std::fs::set_permissions(&opener, std::fs::Permissions::from_mode(0o755)).expect("set");
    let path = format!(
        "{}:{}",
        bin.display(),
        std::env::var("PATH").unwrap_or_default()
    );
    // A terminal, in which the studio opens the browser.
    let command = format!("exec {} studio", env!("CARGO_BIN_EXE_edifice"));
    let mut child = Command::new("script")
        .args(["-qefc", &command, "/dev/null"])
        .env("PATH", path)
        .env("SEEN", &seen)
        .env("XDG_STATE_HOME", folder.path().join("state"))
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .expect("starts");
    let mut line = String::new();
    let out = child.stdout.take().expect("piped");
    let mut out = BufReader::new(out);
    out.read_line(&mut line).expect("an address");
    let (address, token) = line.trim().split_once("/#token=").expect("a token");
    let given = awaited(&seen);
    let all = told_by_proc();
    // The looking itself would find it.
    assert!(all.contains("studio"));
    let hidden = !all.contains(token);
    let environment = std::fs::read_to_string(folder.path().join("seen.env")).expect("written");
    let redirect = PathBuf::from(given.trim());
    let page = std::fs::read_to_string(&redirect).expect("the file");
    let mode = |p: &Path| std::fs::metadata(p).expect("there").permissions().mode() & 0o777;
    let modes = [mode(&redirect), mode(redirect.parent().expect("a folder"))];
    let stranger = as_another_user(&redirect, token);
    // Ctrl-C on the terminal: the file goes with the studio.
    {
        use std::io::Write;
        let stdin = child.stdin.as_mut().expect("piped");
        stdin.write_all(b"\x03").expect("sent");
    }
    let status = child.wait().expect("ends");
    assert!(
        hidden,
        "the token is among the arguments or the environment of a process"
    );
    assert!(!given.contains(token) && !environment.contains(token));
    assert!(page.contains(address) && page.contains(token), "{page}");
    assert_eq!(modes, [0o600, 0o700]);
    if let Some(seen) = stranger {
        assert!(!seen.contains(token), "another user sees the token");
    }
    assert!(status.success(), "{status}");
    assert!(!redirect.exists(), "the file is left");
}

/// All that the user `nobody` sees: the processes, and the file; `None` where the test may not become another user.
fn as_another_user(redirect: &Path, token: &str) -> Option<String> {
    let look = format!(
        "ps axeww; cat /proc/[0-9]*/cmdline /proc/[0-9]*/environ 2>/dev/null; cat '{0}'; ls '{1}'; echo looked",
        redirect.display(),
        redirect.parent().expect("a folder").display()
    );
    let id = Command::new("id").arg("-u").output().ok()?;
    if String::from_utf8_lossy(&id.stdout).trim() != "0" {
        println!("not run by root: another user was not asked");
        return None;
    }
    let seen = Command::new("setpriv")
        .args([
            "--reuid=65534",
            "--regid=65534",
            "--clear-groups",
            "sh",
            "-c",
            &look,
        ])
        .output()
        .ok()?;
    let text = String::from_utf8_lossy(&seen.stdout).into_owned();
    assert!(
        text.contains("looked"),
        "{}",
        String::from_utf8_lossy(&seen.stderr)
    );
    assert!(!token.is_empty());
    Some(text)
}
