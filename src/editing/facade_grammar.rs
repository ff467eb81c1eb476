//! Facades by their grammar (Wu et al. 2014, Sec. 5): rules are edited on an example facade, which is derived again after
//! each edit.

mod merge;

use std::path::Path;
use std::sync::Arc;

pub use edifice_facade_grammar::city;
pub use merge::merge;
use serde::Deserialize;
use serde_json::{Value, json};

use super::examples::{Example, Source};
use super::script::{Shell, Word};
use super::split_grammar::{Derived, GrammarEdit, Resizing, Wish, derived, edit, glb};
use super::work::Work;
use super::{Applied, CommandError, Editor, Opened, State, ends, parse};
use edifice_base::{Error, Result};
use edifice_grammar::{Costs, Grammar, Operation, Rule, Size, check, listing};
use edifice_io::palette::Palette;
use edifice_io::{draw, facade_json, grammar_cga, grammar_json};
use edifice_shape::Facade;

/// Most regions of a facade that is shown.
const SHOWN: usize = 50_000;
const ENDING: &str = ".grammar.json";
const FORMATS: &[&str] = &["facade.json", "cga", "svg", "png", "glb"];

/// Opens grammars (`*.grammar.json`, `*.cga`), and whole facades, whose grammar is inferred.
pub const EDITOR: Editor = Editor {
    kind: "grammar",
    open,
    examples: &[
        Example {
            id: "fig9",
            kind: "grammar",
            title: "The facade of Wu et al., Fig. 9",
            about: "Its cheapest grammar is inferred; edit one region and all of its rule follow.",
            source: Source::File("facade_grammar/wu2014_fig9.facade.json"),
        },
        Example {
            id: "boulevard",
            kind: "grammar",
            title: "A boulevard",
            about: "A made facade of many windows, explained by a few rules.",
            source: Source::File("facade_grammar/layouts/boulevard_1.facade.json"),
        },
    ],
};

fn open(path: &Path, bytes: &[u8], work: &Work) -> Opened {
    let read = match path {
        p if ends(p, ENDING) => grammar_json::parse(bytes, path).map(|g| (g, None)),
        p if ends(p, ".cga") => grammar_cga::parse(bytes, path).map(|g| (g, None)),
        p if ends(p, ".facade.json") => {
            facade_json::parse(bytes, path).and_then(|f| inferred(path, &f, work))
        }
        _ => return None,
    };
    Some(read.and_then(|(grammar, bound)| {
        check(&grammar).map_err(|e| Error::content(path, e))?;
        let editing = Editing {
            name: name_of(path, &grammar),
            grammar,
            bound,
            size: None,
            seed: 0,
            start: 0,
        };
        Ok(Arc::new(editing) as Arc<dyn State>)
    }))
}

/// The grammar of a whole facade, and the least cost that any grammar of it can have.
fn inferred(path: &Path, facade: &Facade, work: &Work) -> Result<(Grammar, Option<f64>)> {
    facade.check_tiling().map_err(|e| Error::content(path, e))?;
    edifice_shape::splittable(facade).map_err(|e| Error::content(path, e))?;
    work.tell("inferring the grammar", None)?;
    let found = merge::watched(std::slice::from_ref(facade), work)?;
    Ok((found.grammar, found.lower_bound))
}

/// The file's name up to its first dot; the grammar's own where it has none.
fn name_of(path: &Path, grammar: &Grammar) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    match name.split('.').next() {
        Some(stem) if !stem.is_empty() => stem.to_owned(),
        _ => grammar.starts[0].name.clone(),
    }
}

/// A grammar that is being edited, and the example facade that shows it.
#[derive(Clone)]
pub struct Editing {
    name: String,
    grammar: Grammar,
    /// Lower bound on the cost of the facade's grammars; none once the facade is another.
    bound: Option<f64>,
    size: Option<(f64, f64)>,
    seed: u64,
    start: usize,
}

#[derive(Deserialize)]
#[serde(tag = "do", rename_all = "snake_case", deny_unknown_fields)]
enum Command {
    Edit {
        edits: Vec<String>,
    },
    Derive {
        #[serde(default)]
        size: Option<[f64; 2]>,
        #[serde(default)]
        seed: u64,
        #[serde(default)]
        start: usize,
    },
    Merge {
        facades: Vec<String>,
    },
}

impl Editing {
    fn derived(&self, align: bool) -> Result<Derived> {
        let resizing = match align {
            true => Resizing::Aligned,
            false => Resizing::Rules,
        };
        let wish = Wish {
            start: self.start,
            size: self.size,
            seed: self.seed,
            resizing,
        };
        let made = derived(&self.grammar, &wish).map_err(Error::method)?;
        let count = made.facade.regions.len();
        match count > SHOWN {
            true => Err(CommandError::Regions { count, most: SHOWN }.into()),
            false => Ok(made),
        }
    }

    fn edit(&self, texts: &[String]) -> Result<Applied> {
        let edits: std::result::Result<Vec<GrammarEdit>, CommandError> =
            texts.iter().map(|t| t.parse()).collect();
        let edits = edits?;
        if edits.is_empty() {
            return Err(CommandError::Nothing.into());
        }
        let grammar = edit(&self.grammar, &edits).map_err(Error::method)?;
        let warnings = check(&grammar).map_err(Error::method)?;
        let outline = edits.iter().any(|e| matches!(e, GrammarEdit::Outline(_)));
        let state = Self {
            grammar,
            bound: None,
            size: self.size.filter(|_| !outline),
            ..self.clone()
        };
        state.derived(false)?;
        let mut shell = Shell::new(["grammar", "edit", "--output", ">", "--", "<"]);
        for text in texts {
            shell = shell.arg(text);
        }
        Ok(Applied {
            state: Arc::new(state),
            said: texts.join(", "),
            shell: shell.gives(ENDING, Some(String::new())),
            warnings: warnings.iter().map(ToString::to_string).collect(),
        })
    }

    /// One grammar of the facades of this one and of others.
    fn merge(&self, texts: &[String], work: &Work) -> Result<Applied> {
        let further = merge::facades(texts)?;
        if further.is_empty() {
            return Err(CommandError::Nothing.into());
        }
        let found = merge::merge(&self.grammar, &further, work)?;
        let starts = found.grammar.starts.len();
        let state = Self {
            name: self.name.clone(),
            grammar: found.grammar,
            bound: found.lower_bound,
            size: None,
            seed: 0,
            start: 0,
        };
        state.derived(false)?;
        let mut shell = Shell::new(["grammar", "merge", "--output", ">", "--", "<"]);
        let held = |text: &String| Word::File(".facade.json", text.clone());
        shell.words.extend(texts.iter().map(held));
        Ok(Applied {
            state: Arc::new(state),
            said: format!("one grammar of {starts} facades"),
            shell: shell.gives(ENDING, Some(String::new())),
            warnings: Vec::new(),
        })
    }

    /// Another example facade; the grammar stays.
    fn shown_at(&self, size: Option<[f64; 2]>, seed: u64, start: usize) -> Result<Applied> {
        let state = Self {
            size: size.map(|[w, h]| (w, h)),
            seed,
            start,
            ..self.clone()
        };
        state.derived(false)?;
        let at = size.map_or("its own size".to_owned(), |[w, h]| format!("{w} x {h}"));
        Ok(Applied {
            state: Arc::new(state),
            said: format!("derive at {at}, seed {seed}"),
            shell: Shell::default(),
            warnings: Vec::new(),
        })
    }
}

impl State for Editing {
    fn kind(&self) -> &'static str {
        EDITOR.kind
    }

    fn name(&self) -> &str {
        &self.name
    }

    fn ending(&self) -> &'static str {
        ENDING
    }

    fn bytes(&self) -> Result<Vec<u8>> {
        Ok(grammar_json::to_string(&self.grammar).into_bytes())
    }

    fn view(&self) -> Result<Value> {
        let shown = self.derived(false)?;
        let facade = &shown.facade;
        let palette = Palette::new(facade.regions.iter().map(|r| r.label.as_str()));
        let terminals = facade.regions.iter().zip(&shown.derivation.origins);
        let terminals = terminals.map(|(region, origin)| {
            let r = region.rect;
            json!([
                region.label,
                r.x,
                r.y,
                r.width,
                r.height,
                origin.map(|o| [o.0, o.1])
            ])
        });
        let labels = facade
            .regions
            .iter()
            .map(|r| (r.label.clone(), json!(palette.color(&r.label))));
        let inner = shown.derivation.non_terminals.iter().map(|n| {
            let r = n.rect;
            json!([n.rule, n.depth, r.x, r.y, r.width, r.height])
        });
        let lines = listing(&self.grammar, false);
        let rules = self
            .grammar
            .rules
            .iter()
            .zip(&lines)
            .map(|(r, line)| rule(r, line));
        let starts = self
            .grammar
            .starts
            .iter()
            .map(|s| json!({"name": s.name, "width": s.width, "height": s.height}));
        let stochastic = self.grammar.rules.iter().any(|r| r.weight.is_some());
        Ok(json!({
            "unit": self.grammar.unit, "width": facade.width, "height": facade.height,
            "terminals": terminals.collect::<Vec<_>>(), "nonTerminals": inner.collect::<Vec<_>>(),
            "colors": labels.collect::<serde_json::Map<_, _>>(), "rules": rules.collect::<Vec<_>>(),
            "starts": starts.collect::<Vec<_>>(), "start": self.start, "seed": self.seed, "stochastic": stochastic,
            "size": self.size.map(|s| [s.0, s.1]), "bound": self.bound.map(tidy),
            "cost": tidy(Costs::default().grammar(&self.grammar)),
        }))
    }

    fn apply(&self, command: &Value, work: &Work) -> Result<Applied> {
        match parse(command)? {
            Command::Edit { edits } => self.edit(&edits),
            Command::Derive { size, seed, start } => self.shown_at(size, seed, start),
            Command::Merge { facades } => self.merge(&facades, work),
        }
    }

    fn merges_in(&self) -> Option<&str> {
        Some(&self.grammar.unit)
    }

    fn formats(&self) -> &'static [&'static str] {
        FORMATS
    }

    fn export(&self, format: &str) -> Result<Vec<u8>> {
        let facade = || self.derived(true).map(|d| d.facade);
        match format {
            "facade.json" => Ok(facade_json::to_string(&facade()?).into_bytes()),
            "cga" => Ok(grammar_cga::to_string(&self.grammar).into_bytes()),
            "svg" => Ok(draw::svg(&facade()?).into_bytes()),
            "png" => draw::png(&facade()?).map_err(Error::method),
            "glb" => glb(&facade()?),
            other => Err(CommandError::Format(other.to_owned()).into()),
        }
    }
}

/// The cost, rounded to nine decimals: sums of tenths without their errors.
fn tidy(cost: f64) -> f64 {
    (cost * 1e9).round() / 1e9
}

/// A rule with its parts, those of a grid row by row, and the sizes of its columns and rows.
fn rule(rule: &Rule, line: &str) -> Value {
    let sized =
        |size: Size| json!({"size": size.value(), "relative": matches!(size, Size::Relative(_))});
    let part = |symbol: &str, size: Size| {
        let mut part = sized(size);
        part["symbol"] = symbol.into();
        part
    };
    let mut grid = [Vec::new(), Vec::new()];
    let (axis, parts): (Option<&str>, Vec<Value>) = match &rule.operation {
        Operation::Split { axis, successors }
        | Operation::Repeat { axis, successors }
        | Operation::SymSplit {
            axis, successors, ..
        } => {
            let parts = successors.iter().map(|s| part(&s.symbol, s.size));
            (Some(axis.name()), parts.collect())
        }
        Operation::RepeatAba { axis, a, b } => {
            let parts = [a, b].map(|s| part(&s.symbol, s.size));
            (Some(axis.name()), parts.into())
        }
        Operation::GridSplit {
            columns,
            rows,
            cells,
        } => {
            grid = [columns, rows].map(|sizes| sizes.iter().map(|s| sized(*s)).collect());
            let cell = |s: &String| json!({"symbol": s, "size": null, "relative": null});
            (None, cells.iter().flatten().map(cell).collect())
        }
    };
    let [columns, rows] = grid;
    let center = matches!(rule.operation, Operation::SymSplit { center: true, .. });
    let body = line.split_once('→').map_or(line, |(_, body)| body.trim());
    json!({
        "symbol": rule.symbol, "weight": rule.weight, "operation": rule.operation.name(), "axis": axis, "center": center,
        "parts": parts, "columns": columns, "rows": rows, "text": body, "cost": tidy(Costs::default().rule(&rule.operation)),
    })
}
