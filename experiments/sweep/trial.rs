//! Studies in three parts, so that a foreign program can take the place of the middle one: *prepare* makes a question and what only the judge
//! knows, a *candidate* answers it, and the *judge* measures the answer. A built-in method and a command answer the same question
//! and pass the same judge.
//!
//! Question and answer are files of the contract when a command is asked, and the same values when a built-in method is: numbers are written so that
//! they read back to the same bits, and a built-in method that is asked as a command gives the same metrics.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use schemars::JsonSchema;
use serde::Serialize;
use serde::de::DeserializeOwned;

use super::given::Given;
use edifice_base::{Result, Watched};

/// An answer, and what its author says of it.
#[derive(Debug, Clone)]
pub struct Answered<A> {
    /// The answer.
    pub answer: A,
    /// Metrics that the judge cannot measure, by name; only those of [`Trial::CLAIMS`].
    pub claims: BTreeMap<String, f64>,
    /// The best value of the first metric by evaluations, of built-in methods.
    pub trace: Vec<[f64; 2]>,
    /// A proven bound of the first metric, of built-in methods.
    pub bound: Option<f64>,
}

impl<A> Answered<A> {
    /// An answer without a word on it.
    pub fn plain(answer: A) -> Self {
        Self {
            answer,
            claims: BTreeMap::new(),
            trace: Vec::new(),
            bound: None,
        }
    }
}

/// The files of a question.
#[derive(Debug, Clone, PartialEq)]
pub struct Posed {
    /// The file or folder that the question is about: `{input}`.
    pub input: PathBuf,
    /// The file or folder to learn from, if there is one: `{learn}`.
    pub learn: Option<PathBuf>,
}

/// A study whose candidate can be a command.
pub trait Trial: 'static {
    /// Settings of the question, the built-in methods and the judge.
    type Settings: Serialize + DeserializeOwned + JsonSchema + Default + 'static;
    /// The question to a candidate: all that it sees.
    type Question;
    /// The truth about a question: only the judge sees it.
    type Truth;
    /// The answer of a candidate.
    type Answer;

    /// Name of the file of an answer, whose ending says its format.
    const OUTPUT: &'static str;
    /// Names of metrics that a candidate may state, since no judge can measure them.
    const CLAIMS: &'static [&'static str];

    /// Makes the question of a task, and what its judge knows.
    ///
    /// # Errors
    /// Where the instance cannot serve.
    fn prepare(settings: &Self::Settings, given: &Given) -> Result<(Self::Question, Self::Truth)>;

    /// Answers by a built-in method; once `watched` is stopped, what it answers is not judged.
    ///
    /// # Errors
    /// Those of the method.
    fn candidate(
        settings: &Self::Settings,
        question: &Self::Question,
        seed: u64,
        watched: &Watched,
    ) -> Result<Answered<Self::Answer>>;

    /// Measures an answer.
    ///
    /// # Errors
    /// Why the answer is none.
    fn judge(
        settings: &Self::Settings,
        question: &Self::Question,
        truth: &Self::Truth,
        answer: &Self::Answer,
    ) -> Result<BTreeMap<String, f64>>;

    /// Writes a question into a folder.
    ///
    /// # Errors
    /// [`edifice_base::Error::Io`].
    fn pose(question: &Self::Question, folder: &Path) -> Result<Posed>;

    /// Reads a question that was written.
    ///
    /// # Errors
    /// Where the files are no question.
    fn posed(posed: &Posed) -> Result<Self::Question>;

    /// Writes an answer.
    ///
    /// # Errors
    /// [`edifice_base::Error::Io`].
    fn write(question: &Self::Question, answer: &Self::Answer, path: &Path) -> Result<()>;

    /// Reads the answer to a question.
    ///
    /// # Errors
    /// Why the file is no answer.
    fn read(question: &Self::Question, path: &Path) -> Result<Self::Answer>;
}
