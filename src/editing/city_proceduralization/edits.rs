//! Edits of an instance grammar, as text and as values.

use super::super::{CommandError, numbers};
use edifice_grammar::instance::{InstanceGrammar, InstanceGrammarError, Placement};

/// One edit.
#[derive(Debug, Clone, PartialEq)]
pub enum CityEdit {
    /// `scale TEMPLATE=FX,FY,FZ`: factors of width, depth and height wherever the template stands.
    Scale(String, [f64; 3]),
    /// `weight RULE=W`: weight of a rule, counted from 0 in the order of the file.
    Weight(usize, f64),
}

/// Why a city cannot be edited so.
#[derive(Debug, thiserror::Error)]
pub enum CityEditError {
    /// There is no such template.
    #[error("there is no template {0:?}")]
    NoTemplate(String),
    /// There is no such rule.
    #[error("there is no rules[{rule}]: the grammar has {count}")]
    NoRule {
        /// Its index.
        rule: usize,
        /// Rules of the grammar.
        count: usize,
    },
    /// A factor that is no positive number.
    #[error("{0} is no factor: expected a number above zero")]
    Factor(f64),
    /// The edited grammar is none.
    #[error(transparent)]
    Grammar(#[from] InstanceGrammarError),
}

impl std::str::FromStr for CityEdit {
    type Err = CommandError;

    fn from_str(text: &str) -> Result<Self, CommandError> {
        read(text).map_err(|message| CommandError::Edit {
            edit: text.to_owned(),
            message,
        })
    }
}

fn read(text: &str) -> Result<CityEdit, String> {
    let (verb, rest) = text.split_once(' ').unwrap_or((text, ""));
    let value = || {
        rest.rsplit_once('=')
            .ok_or("expected a value after =".to_owned())
    };
    Ok(match verb {
        "scale" => {
            let (template, factors) = value()?;
            CityEdit::Scale(template.to_owned(), numbers(factors)?)
        }
        "weight" => {
            let (rule, weight) = value()?;
            let rule = rule.parse().map_err(|_| format!("{rule:?} is no index"))?;
            CityEdit::Weight(rule, numbers::<1>(weight)?[0])
        }
        _ => return Err("expected scale or weight".into()),
    })
}

/// The grammar after edits, made in turn.
///
/// # Errors
/// [`CityEditError`]; the edited grammar is checked whole.
pub fn edit(
    grammar: &InstanceGrammar,
    edits: &[CityEdit],
) -> Result<InstanceGrammar, CityEditError> {
    let mut out = grammar.clone();
    for edit in edits {
        match edit {
            CityEdit::Scale(template, factors) => {
                if !out.templates.iter().any(|t| t.symbol == *template) {
                    return Err(CityEditError::NoTemplate(template.clone()));
                }
                let bad = factors.iter().find(|f| !(f.is_finite() && **f > 0.0));
                if let Some(factor) = bad {
                    return Err(CityEditError::Factor(*factor));
                }
                for placed in out.rules.iter_mut().flat_map(|r| &mut r.successors) {
                    scale(placed, template, factors);
                }
            }
            CityEdit::Weight(rule, weight) => {
                let (rule, count) = (*rule, out.rules.len());
                let own = out.rules.get_mut(rule);
                own.ok_or(CityEditError::NoRule { rule, count })?.weight = *weight;
            }
        }
    }
    out.check()?;
    Ok(out)
}

fn scale(placed: &mut Placement, template: &str, factors: &[f64; 3]) {
    if placed.symbol == template {
        for (size, factor) in placed.size.iter_mut().zip(factors) {
            *size *= factor;
        }
    }
    for part in placed.parts.iter_mut().flatten() {
        scale(part, template, factors);
    }
}
