//! The commands of a document as a shell script that needs no studio.

use std::fmt::Write;

/// A word of a command line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Word {
    /// As it is.
    Text(String),
    /// The file of the state before.
    Input,
    /// Where the command writes.
    Output,
}

/// A command as shell.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Shell {
    /// The arguments of `edifice`; none for a command that only picks an answer.
    pub words: Vec<Word>,
    /// How the name of the output ends; a folder has no ending.
    pub ending: &'static str,
    /// Where the new state is: a file below the last output, or the output itself when empty; `None` leaves the
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

    /// Where the new state is.
    pub fn gives(mut self, ending: &'static str, result: Option<String>) -> Self {
        (self.ending, self.result) = (ending, result);
        self
    }
}

/// The script that takes `start` through the commands to a file of the name `target`.
pub fn script(target: &str, ending: &str, start: &[u8], steps: &[Shell]) -> String {
    let mut text = format!(
        "#!/bin/sh\n# Written by `edifice studio`: the same edits as commands. Writes the file named by its argument.\nset -eu\n\
         edifice=${{EDIFICE:-edifice}}\ntarget=${{1:-{}}}\nwork=$(mktemp -d)\ntrap 'rm -rf \"$work\"' EXIT\n",
        quoted(target)
    );
    let mut input = format!("\"$work\"/0{ending}");
    let mut output = String::new();
    // The start is part of the script: a file that is saved over itself would not be there to start from.
    let start = String::from_utf8_lossy(start);
    let end = terminator(&start);
    let _ = writeln!(
        text,
        "cat > {input} <<'{end}'\n{}\n{end}",
        start.trim_end_matches('\n')
    );
    for (k, step) in steps.iter().enumerate() {
        if !step.words.is_empty() {
            output = format!("\"$work\"/{}{}", k + 1, step.ending);
            text.push_str("\"$edifice\"");
            for word in &step.words {
                match word {
                    Word::Text(t) => text.push_str(&format!(" {}", quoted(t))),
                    Word::Input => text.push_str(&format!(" {input}")),
                    Word::Output => text.push_str(&format!(" {output}")),
                }
            }
            text.push_str(" > /dev/null\n");
        }
        match step.result.as_deref() {
            None => {}
            Some("") => input.clone_from(&output),
            Some(file) => input = format!("{output}/{}", quoted(file)),
        }
    }
    let _ = writeln!(text, "cp {input} \"$target\"");
    text
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
    fn a_start_may_hold_any_line() {
        let start = "END_OF_FILE\n$(x)\n";
        let text = script("out", ".txt", start.as_bytes(), &[]);
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
