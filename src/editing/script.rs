//! The commands of a document as a shell script that needs no studio.

use std::fmt::Write;

/// A word of a command line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Word {
    /// A text that stands for itself.
    Text(String),
    /// The file of the state before.
    Input,
    /// The file or folder that the command writes.
    Output,
    /// A file that the script holds: how its name ends, and its text.
    File(&'static str, String),
    /// A file beside the script.
    Beside(String),
}

/// A command as shell.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Shell {
    /// The arguments of `edifice`; none for a command that only picks an answer.
    pub words: Vec<Word>,
    /// The ending of the output's name; empty for a folder.
    pub ending: &'static str,
    /// The place of the new state: a file below the last output, or the output itself when empty; `None` leaves the
    /// state where it was.
    pub result: Option<String>,
}

impl Shell {
    /// A command line from words; `<` is the input and `>` the output.
    pub fn new<'a>(words: impl IntoIterator<Item = &'a str>) -> Self {
        let word = |w: &str| match w {
            "<" => Word::Input,
            ">" => Word::Output,
            text => Word::Text(text.to_owned()),
        };
        Self {
            words: words.into_iter().map(word).collect(),
            ..Self::default()
        }
    }

    /// Adds an argument.
    pub fn arg(mut self, text: impl Into<String>) -> Self {
        self.words.push(Word::Text(text.into()));
        self
    }

    /// Adds an option with its value.
    pub fn option(self, name: &str, value: impl ToString) -> Self {
        // One word, so that a value that begins with a minus is no option.
        self.arg(format!("{name}={}", value.to_string()))
    }

    /// Sets the place of the new state.
    pub fn gives(mut self, ending: &'static str, result: Option<String>) -> Self {
        (self.ending, self.result) = (ending, result);
        self
    }
}

/// The script that takes the start through the commands to a file of the name `target`. A start that no command needs, since
/// one begins anew with another file, is not asked for.
///
/// # Errors
/// Those of `start`.
pub fn script<E>(
    target: &str,
    ending: &str,
    start: impl Fn() -> Result<Vec<u8>, E>,
    steps: &[Shell],
) -> Result<String, E> {
    let mut text = begin(target);
    text.push_str("here=$(dirname \"$0\")\nwork=$(mktemp -d)\ntrap 'rm -rf \"$work\"' EXIT\n");
    let mut input = format!("\"$work\"/0{ending}");
    let mut output = String::new();
    let anew = |s: &Shell| !s.words.is_empty() && !s.words.contains(&Word::Input);
    let first = steps.iter().rposition(anew);
    if first.is_none() {
        // The start is part of the script: a file that is saved over itself would not be there to start from.
        text.push_str(&held(&input, &String::from_utf8_lossy(&start()?)));
    }
    for (k, step) in steps.iter().enumerate().skip(first.unwrap_or(0)) {
        if !step.words.is_empty() {
            output = format!("\"$work\"/{}{}", k + 1, step.ending);
            let mut line = String::from("\"$edifice\"");
            for (n, word) in step.words.iter().enumerate() {
                let word = match word {
                    Word::Text(t) => quoted(t),
                    Word::Input => input.clone(),
                    Word::Output => output.clone(),
                    Word::Beside(name) => format!("\"$here\"/{}", quoted(name)),
                    Word::File(ending, content) => {
                        let place = format!("\"$work\"/{}_{n}{ending}", k + 1);
                        text.push_str(&held(&place, content));
                        place
                    }
                };
                line.push_str(&format!(" {word}"));
            }
            text.push_str(&format!("{line} > /dev/null\n"));
        }
        match step.result.as_deref() {
            None => {}
            Some("") => input.clone_from(&output),
            Some(file) => input = format!("{output}/{}", quoted(file)),
        }
    }
    let _ = writeln!(text, "cp {input} \"$target\"");
    let sum = checksum(&text);
    let _ = writeln!(text, "{SUM}{sum:016x}");
    Ok(text)
}

/// The first lines of a script that writes a file of the name `target`.
fn begin(target: &str) -> String {
    format!(
        "#!/bin/sh\n# Written by `edifice studio`: the same edits as commands. Writes the file named by its argument.\nset -eu\n\
         edifice=${{EDIFICE:-edifice}}\ntarget=${{1:-{}}}\n",
        quoted(target)
    )
}

/// Begins the last line of a script, which holds a checksum of all lines above it.
const SUM: &str = "# Unchanged since it was written if the lines above have this sum: ";

/// FNV-1a of the bytes: it tells a script that somebody changed from one that nobody did; it is no seal.
fn checksum(text: &str) -> u64 {
    let step = |h: u64, b: u8| (h ^ u64::from(b)).wrapping_mul(0x0000_0100_0000_01b3);
    text.bytes().fold(0xcbf2_9ce4_8422_2325, step)
}

/// True for a script that [`script`] wrote for a file of the name `target` and that nobody changed since.
pub fn is_written(text: &str, target: &str) -> bool {
    let Some((above, sum)) = text.rsplit_once(SUM) else {
        return false;
    };
    above.starts_with(&begin(target)) && sum == format!("{:016x}\n", checksum(above))
}

/// The lines that write a text to a place.
fn held(place: &str, content: &str) -> String {
    let end = terminator(content);
    let content = content.trim_end_matches('\n');
    format!("cat > {place} <<'{end}'\n{content}\n{end}\n")
}

/// A line that the text does not have.
fn terminator(text: &str) -> String {
    let mut end = String::from("END_OF_FILE");
    while text.lines().any(|line| line == end) {
        end.push('_');
    }
    end
}

/// A word as the shell reads it back.
fn quoted(text: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_=./,:@+".contains(c);
    match !text.is_empty() && text.chars().all(plain) {
        true => text.to_owned(),
        false => format!("'{}'", text.replace('\'', "'\\''")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_reach_the_shell_as_they_are() {
        for word in [
            "a b",
            "it's",
            "$(rm -rf /)",
            "`x`",
            "",
            "-o",
            "a\nb",
            "\"",
            "\\",
            "*",
        ] {
            let out = std::process::Command::new("sh")
                .arg("-c")
                .arg(format!("printf %s {}", quoted(word)))
                .output()
                .unwrap();
            assert_eq!(String::from_utf8(out.stdout).unwrap(), word);
        }
    }

    #[test]
    fn a_script_that_somebody_changed_is_known() {
        let none = || Ok::<_, ()>(b"a\n".to_vec());
        let text = script("out file", ".txt", none, &[]).unwrap();
        assert!(is_written(&text, "out file"));
        assert!(!is_written(&text, "out"));
        assert!(!is_written(&text.replace("set -eu", "set -e"), "out file"));
        assert!(!is_written(&format!("{text}echo mine\n"), "out file"));
        assert!(!is_written("#!/bin/sh\necho mine\n", "out file"));
    }

    #[test]
    fn a_start_may_hold_any_line() {
        let start = "END_OF_FILE\n$(x)\n";
        let none = || Ok::<_, ()>(start.as_bytes().to_vec());
        let text = script("out", ".txt", none, &[]).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.sh");
        std::fs::write(&path, text).unwrap();
        let done = std::process::Command::new("sh")
            .arg(&path)
            .current_dir(folder.path())
            .status()
            .unwrap();
        assert!(done.success());
        let copied = std::fs::read_to_string(folder.path().join("out")).unwrap();
        assert_eq!(copied, start);
    }
}
