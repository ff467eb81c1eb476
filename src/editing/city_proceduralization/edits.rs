//! Edits of an instance grammar, as text and as values.

use super::super::{CommandError, numbers};
use edifice_grammar::instance::{InstanceGrammar, InstanceGrammarError, InstanceRule, Placement};

/// One edit.
#[derive(Debug, Clone, PartialEq)]
pub enum CityEdit {
    /// `scale NAME=FX,FY,FZ`: factors of width, depth and height of a template, or of a type of building, wherever it stands; a name that
    /// ends in `*` is all names that begin so.
    Scale(String, [f64; 3]),
    /// `weight RULE=W`: weight of a rule, counted from 0 in the order of the file.
    Weight(usize, f64),
}

/// Why a city cannot be edited so.
#[derive(Debug, thiserror::Error)]
pub enum CityEditError {
    /// There is no such template.
    #[error("there is no template or type of building {0:?}: names are T1, B1, E1 or B*")]
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

/// The grammar after edits, made in turn. Residuals of a type that is edited are carried along, or, without `carry`, left out.
///
/// # Errors
/// [`CityEditError`]; the edited grammar is checked whole.
pub fn edit(
    grammar: &InstanceGrammar,
    edits: &[CityEdit],
    carry: bool,
) -> Result<InstanceGrammar, CityEditError> {
    let mut out = grammar.clone();
    for edit in edits {
        match edit {
            CityEdit::Scale(template, factors) => {
                let named = |symbol: &str| match template.strip_suffix('*') {
                    Some(start) => symbol.starts_with(start),
                    None => symbol == template,
                };
                let own = |r: &InstanceRule| r.levels > 0 && named(&r.symbol);
                let types = out.rules.iter().any(own);
                let templates = out.templates.iter().any(|t| named(&t.symbol));
                if !(types || templates) {
                    return Err(CityEditError::NoTemplate(template.clone()));
                }
                let bad = factors.iter().find(|f| !(f.is_finite() && **f > 0.0));
                if let Some(factor) = bad {
                    return Err(CityEditError::Factor(*factor));
                }
                for rule in out.rules.iter_mut().filter(|r| own(r)) {
                    rule.scale = [0, 1, 2].map(|k| rule.scale[k] * factors[k]);
                }
                for placed in out.rules.iter_mut().flat_map(|r| &mut r.successors) {
                    if !carry && types && named(&placed.symbol) {
                        placed.parts.clear();
                    }
                    if templates {
                        scale(placed, &named, factors);
                    }
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

fn scale(placed: &mut Placement, named: &impl Fn(&str) -> bool, factors: &[f64; 3]) {
    if named(&placed.symbol) && placed.numbers.is_empty() {
        for (size, factor) in placed.size.iter_mut().zip(factors) {
            *size *= factor;
        }
    }
    for part in placed.parts.iter_mut().flatten() {
        scale(part, named, factors);
    }
}
