//! Studies: methods with typed settings, which a sweep can vary.

use std::collections::BTreeMap;
use std::path::Path;

use schemars::{JsonSchema, schema_for};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::given::Given;
use super::trial::{Answered, Posed, Trial};
use edifice_base::{Error, Result, Watched, unwatched};
use edifice_frame::Program;

/// The values of a metric that are better.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Better {
    /// Smaller ones.
    Lower,
    /// Larger ones.
    Higher,
}

/// The outcome of one task.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// Value of each metric; the same task gives the same values, so times do not belong here.
    pub metrics: BTreeMap<String, f64>,
    /// The best value of the first metric by evaluations, if the method reports it: `[evaluations, value]`, rising.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub trace: Vec<[f64; 2]>,
    /// No value of the first metric is better, as far as it is proven.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bound: Option<f64>,
}

/// A setting, as `edifice sweep studies` lists it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Setting {
    /// Name in the sweep file.
    pub name: String,
    /// Its type, in words.
    pub kind: String,
    /// Value when nothing is said.
    pub default: Value,
    /// Its meaning.
    pub meaning: String,
}

type Run = Box<dyn Fn(&Map<String, Value>, &Given) -> Result<Outcome> + Send + Sync>;
type Settings = Map<String, Value>;
/// Asks for an answer: files of the question and of the answer in, the metrics that the answer's author states out.
pub type Ask<'a> = dyn Fn(&Posed, &Path) -> Result<BTreeMap<String, f64>> + 'a;
type Foreign = Box<dyn Fn(&Settings, &Given, &Ask) -> Result<Outcome> + Send + Sync>;
type Reply =
    Box<dyn Fn(&Settings, &Posed, &Path, u64) -> Result<BTreeMap<String, f64>> + Send + Sync>;
type Check = Box<dyn Fn(&Map<String, Value>) -> std::result::Result<(), String> + Send + Sync>;

/// A method that sweeps can run: a function and the type of its settings.
pub struct Study {
    /// `<paper>/<method>`.
    pub name: &'static str,
    /// Its task, in a line.
    pub about: &'static str,
    /// Folder of `datasets/` that `data` is relative to.
    pub data: &'static str,
    /// Its metrics; the first is what a report is about unless the file says otherwise.
    pub metrics: &'static [(&'static str, Better)],
    /// True if it learns from files beside the instance.
    pub learns: bool,
    settings: Vec<Setting>,
    defaults: Map<String, Value>,
    check: Check,
    run: Run,
    foreign: Option<(Foreign, Reply)>,
    /// Names of metrics that a candidate states of itself.
    pub claims: &'static [&'static str],
    /// Names of the settings that make the question; the others are those of built-in methods. Empty where the study does not tell.
    pub asks: &'static [&'static str],
    crates: &'static [&'static str],
    part: &'static str,
    /// Digest of the sources that its results depend on.
    sources: String,
    commit: (Option<String>, Option<bool>),
}

/// The faults of an answer that any study finds.
#[derive(Debug, thiserror::Error)]
enum AnswerError {
    #[error("the answer states the metric `{0}`, which only the judge measures")]
    Claim(String),
    #[error("the metric `{0}` is {1}, which is no number")]
    NotFinite(String, f64),
    #[error("the study takes no command")]
    NoCommand,
}

impl Study {
    /// A study of settings `S`, whose doc comments are their meanings. `run` finds the same for the same.
    pub fn new<S>(
        name: &'static str,
        about: &'static str,
        data: &'static str,
        metrics: &'static [(&'static str, Better)],
        run: fn(&S, &Given) -> Result<Outcome>,
    ) -> Self
    where
        S: Serialize + DeserializeOwned + JsonSchema + Default + 'static,
    {
        let defaults = match serde_json::to_value(S::default()) {
            Ok(Value::Object(defaults)) => defaults,
            _ => Map::new(),
        };
        let typed = |settings: &Map<String, Value>| {
            serde_json::from_value::<S>(Value::Object(settings.clone())).map_err(|e| e.to_string())
        };
        Self {
            name,
            about,
            data,
            metrics,
            learns: false,
            settings: settings(&schema_for!(S).to_value(), &defaults),
            defaults,
            check: Box::new(move |settings| typed(settings).map(|_| ())),
            run: Box::new(move |settings, given| {
                let settings = typed(settings).map_err(Error::method)?;
                run(&settings, given)
            }),
            foreign: None,
            claims: &[],
            asks: &[],
            crates: &[],
            part: "",
            sources: String::new(),
            commit: (None, None),
        }
    }

    /// A study whose candidate can be a command.
    pub fn trial<T: Trial>(
        name: &'static str,
        about: &'static str,
        data: &'static str,
        metrics: &'static [(&'static str, Better)],
    ) -> Self {
        fn typed<S: DeserializeOwned>(settings: &Settings) -> Result<S> {
            serde_json::from_value(Value::Object(settings.clone())).map_err(Error::method)
        }
        let run = |settings: &T::Settings, given: &Given| {
            let (question, truth) = T::prepare(settings, given)?;
            let answered = T::candidate(settings, &question, given.seed, given.watched)?;
            judged::<T>(settings, &question, &truth, answered)
        };
        let foreign = |settings: &Settings, given: &Given, ask: &Ask| {
            let settings: T::Settings = typed(settings)?;
            let (question, truth) = T::prepare(&settings, given)?;
            let folder =
                tempfile::tempdir().map_err(|e| Error::io("answer".as_ref(), "make", e))?;
            let found = answered::<T>(&question, folder.path(), ask)
                .and_then(|answered| judged::<T>(&settings, &question, &truth, answered));
            // The same failure has the same words in every run: the folder is another each time.
            let place = format!("{}{}", folder.path().display(), std::path::MAIN_SEPARATOR);
            found.map_err(|error| match error {
                Error::Interrupted => Error::Interrupted,
                error => Error::method(error.to_string().replace(&place, "")),
            })
        };
        let reply = |settings: &Settings, posed: &Posed, output: &Path, seed: u64| {
            let settings: T::Settings = typed(settings)?;
            let question = T::posed(posed)?;
            let answered = T::candidate(&settings, &question, seed, &Watched::new(&unwatched))?;
            T::write(&question, &answered.answer, output)?;
            Ok(answered.claims)
        };
        Self {
            foreign: Some((Box::new(foreign), Box::new(reply))),
            claims: T::CLAIMS,
            ..Self::new(name, about, data, metrics, run)
        }
    }

    /// The same study, whose results depend on the sources of these crates and of its part of the experiments.
    #[must_use]
    pub fn made_of(self, crates: &'static [&'static str], part: &'static str) -> Self {
        Self {
            crates,
            part,
            ..self
        }
    }

    /// The same study, of a program.
    #[must_use]
    pub fn of(self, program: &Program) -> Self {
        let sources = &program.sources;
        Self {
            sources: sources.digest(self.crates, self.part),
            commit: (sources.commit.map(str::to_owned), sources.dirty),
            ..self
        }
    }

    /// The commit that its program was built from, and if files differed from it.
    pub(crate) fn commit(&self) -> (Option<String>, Option<bool>) {
        self.commit.clone()
    }

    /// The same study, whose question is made by these settings alone.
    #[must_use]
    pub fn asking(self, asks: &'static [&'static str]) -> Self {
        Self { asks, ..self }
    }

    /// Digest of the sources that its results depend on.
    pub fn sources(&self) -> &str {
        &self.sources
    }

    /// True if an arm can be a command.
    pub fn takes_commands(&self) -> bool {
        self.foreign.is_some()
    }

    /// Runs one task whose answer comes from elsewhere.
    ///
    /// # Errors
    /// Those of asking, and why the answer is none.
    pub fn run_foreign(&self, settings: &Settings, given: &Given, ask: &Ask) -> Result<Outcome> {
        let foreign = self.foreign.as_ref();
        let (foreign, _) = foreign.ok_or_else(|| Error::method(AnswerError::NoCommand))?;
        foreign(settings, given, ask)
    }

    /// Answers a question that lies in files by the built-in method; the metrics that it states are returned.
    ///
    /// # Errors
    /// Those of reading, of the method and of writing.
    pub fn reply(
        &self,
        settings: &Settings,
        posed: &Posed,
        output: &Path,
        seed: u64,
    ) -> Result<BTreeMap<String, f64>> {
        let foreign = self.foreign.as_ref();
        let (_, reply) = foreign.ok_or_else(|| Error::method(AnswerError::NoCommand))?;
        reply(settings, posed, output, seed)
    }

    /// The same study, which learns from files beside the instance ([`Given::database`]).
    #[must_use]
    pub fn learning(self) -> Self {
        Self {
            learns: true,
            ..self
        }
    }

    /// Every setting, in the order of its type.
    pub fn settings(&self) -> &[Setting] {
        &self.settings
    }

    /// All settings, those that are not given at their defaults.
    pub fn complete(&self, given: &Map<String, Value>) -> Map<String, Value> {
        let mut all = self.defaults.clone();
        all.extend(
            given
                .iter()
                .map(|(name, value)| (name.clone(), value.clone())),
        );
        all
    }

    /// Checks that one setting has a value of its type; the error says why not.
    pub fn check(&self, name: &str, value: &Value) -> std::result::Result<(), String> {
        let one = Map::from_iter([(name.to_owned(), value.clone())]);
        (self.check)(&self.complete(&one))
    }

    /// Runs one task.
    ///
    /// # Errors
    /// Those of the method.
    pub fn run(&self, settings: &Map<String, Value>, given: &Given) -> Result<Outcome> {
        (self.run)(settings, given)
    }
}

/// Asks for an answer to a question, whose files lie in a folder.
fn answered<T: Trial>(
    question: &T::Question,
    folder: &Path,
    ask: &Ask,
) -> Result<Answered<T::Answer>> {
    let posed = T::pose(question, folder)?;
    let output = folder.join(T::OUTPUT);
    let claims = ask(&posed, &output)?;
    Ok(Answered {
        claims,
        ..Answered::plain(T::read(question, &output)?)
    })
}

/// The outcome of an answer: what the judge measures, and what only its author can state.
fn judged<T: Trial>(
    settings: &T::Settings,
    question: &T::Question,
    truth: &T::Truth,
    answered: Answered<T::Answer>,
) -> Result<Outcome> {
    let mut metrics = T::judge(settings, question, truth, &answered.answer)?;
    for (name, value) in answered.claims {
        if !T::CLAIMS.contains(&name.as_str()) {
            return Err(Error::method(AnswerError::Claim(name)));
        }
        metrics.insert(name, value);
    }
    if let Some((name, value)) = metrics.iter().find(|(_, value)| !value.is_finite()) {
        return Err(Error::method(AnswerError::NotFinite(name.clone(), *value)));
    }
    Ok(Outcome {
        metrics,
        trace: answered.trace,
        bound: answered.bound,
    })
}

/// The properties of a JSON schema with their defaults.
fn settings(schema: &Value, defaults: &Map<String, Value>) -> Vec<Setting> {
    let none = Map::new();
    let properties = schema["properties"].as_object().unwrap_or(&none);
    let setting = |(name, default): (&String, &Value)| {
        let property = &properties.get(name).unwrap_or(&Value::Null);
        Setting {
            name: name.clone(),
            kind: kind(property, schema),
            default: default.clone(),
            meaning: property["description"]
                .as_str()
                .unwrap_or_default()
                .replace('\n', " "),
        }
    };
    defaults.iter().map(setting).collect()
}

/// A type in words: `integer`, `one of "a", "b"`, `list of ...`.
fn kind(property: &Value, schema: &Value) -> String {
    if let Some(path) = property["$ref"].as_str() {
        let target = path.trim_start_matches('#');
        return schema
            .pointer(target)
            .map_or_else(|| "value".into(), |target| kind(target, schema));
    }
    for list in ["oneOf", "anyOf"] {
        if let Some(choices) = property[list].as_array() {
            let words: Vec<String> = choices.iter().map(|choice| kind(choice, schema)).collect();
            return words.join(" or ");
        }
    }
    if let Some(choices) = property["enum"].as_array() {
        let words: Vec<String> = choices.iter().map(Value::to_string).collect();
        return words.join(" or ");
    }
    if !property["const"].is_null() {
        return property["const"].to_string();
    }
    match property["type"].as_str() {
        Some("array") => format!("list of {}", kind(&property["items"], schema)),
        Some(name) => name.to_owned(),
        None => match property["type"].as_array() {
            Some(names) => {
                let words: Vec<&str> = names.iter().filter_map(Value::as_str).collect();
                words.join(" or ")
            }
            None => "value".to_owned(),
        },
    }
}
