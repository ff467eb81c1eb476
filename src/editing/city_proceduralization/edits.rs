//! Edits of an instance grammar, as text and as values.

use rustc_hash::{FxHashMap, FxHashSet};

use super::super::{CommandError, numbers};
use edifice_grammar::instance::{InstanceGrammar, InstanceGrammarError, InstanceRule, Placement};

/// One edit.
#[derive(Debug, Clone, PartialEq)]
pub enum CityEdit {
    /// `scale NAME=FX,FY,FZ`: factors of width, depth and height of a template, or of a type of building, wherever it stands; a name that
    /// ends in `*` is all names that begin so.
    Scale(String, [f64; 3]),
    /// `move NAME=DX,DY,DZ`: a shift in metres of a district, block or row, along the axes of what it stands in.
    Move(String, [f64; 3]),
    /// `turn NAME=DEGREES`: a turn of a district, block or row about the place of its first building, counterclockwise from above.
    Turn(String, f64),
    /// `remove NAME`: takes a district, block, row, type of building or template away, and buildings that nothing is left of; a
    /// row closes up.
    Remove(String),
    /// `weight RULE=W`: weight of a rule, counted from 0 in the order of the file.
    Weight(usize, f64),
}

/// Why a city cannot be edited so.
#[derive(Debug, thiserror::Error)]
pub enum CityEditError {
    /// There is no such template.
    #[error("there is no template or type of building {0:?}: names are T1, B1, E1 or B*")]
    NoTemplate(String),
    /// There is no such thing to be moved.
    #[error("there is no district, block or row {0:?}: names are D1, K1, R1 or R*")]
    NoGroup(String),
    /// There is no such thing to be taken away.
    #[error("nothing but the axiom is named {0:?}")]
    NoSymbol(String),
    /// A number that is infinite or none.
    #[error("{0} is no length or angle")]
    Shift(f64),
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
        "move" => {
            let (group, shift) = value()?;
            CityEdit::Move(group.to_owned(), numbers(shift)?)
        }
        "turn" => {
            let (group, degrees) = value()?;
            CityEdit::Turn(group.to_owned(), numbers::<1>(degrees)?[0])
        }
        "remove" if rest.is_empty() => return Err("expected a name".into()),
        "remove" => CityEdit::Remove(rest.to_owned()),
        "weight" => {
            let (rule, weight) = value()?;
            let rule = rule.parse().map_err(|_| format!("{rule:?} is no index"))?;
            CityEdit::Weight(rule, numbers::<1>(weight)?[0])
        }
        _ => return Err("expected scale, move, turn, remove or weight".into()),
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
                let named = |symbol: &str| is_named(template, symbol);
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
            CityEdit::Move(group, shift) => each_group(&mut out, group, shift, |placed| {
                placed.at = [0, 1, 2].map(|k| placed.at[k] + shift[k]);
            })?,
            CityEdit::Turn(group, degrees) => each_group(&mut out, group, &[*degrees], |placed| {
                placed.turn = (placed.turn + degrees).rem_euclid(360.0);
            })?,
            CityEdit::Remove(name) => remove(&mut out, name)?,
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

/// True if a name, or what it begins with before a `*`, names a symbol.
fn is_named(name: &str, symbol: &str) -> bool {
    match name.strip_suffix('*') {
        Some(start) => symbol.starts_with(start),
        None => symbol == name,
    }
}

/// Edits the instances of what has a rule without parameters: districts, blocks and rows.
fn each_group(
    grammar: &mut InstanceGrammar,
    name: &str,
    values: &[f64],
    edit: impl Fn(&mut Placement),
) -> Result<(), CityEditError> {
    if let Some(bad) = values.iter().find(|v| !v.is_finite()) {
        return Err(CityEditError::Shift(*bad));
    }
    let own = |r: &&InstanceRule| r.levels == 0 && is_named(name, &r.symbol);
    let groups = grammar.rules.iter().filter(own);
    let groups: FxHashSet<String> = groups.map(|r| r.symbol.clone()).collect();
    let all = grammar.rules.iter_mut().flat_map(|r| &mut r.successors);
    let mut found = false;
    for placed in all.filter(|p| groups.contains(&p.symbol)) {
        edit(placed);
        found = true;
    }
    match found {
        true => Ok(()),
        false => Err(CityEditError::NoGroup(name.to_owned())),
    }
}

/// Takes symbols out of all rules, and what instances say of them.
fn remove(grammar: &mut InstanceGrammar, name: &str) -> Result<(), CityEditError> {
    let gone = |symbol: &str| symbol != grammar.axiom && is_named(name, symbol);
    let mut kept: FxHashMap<String, Vec<bool>> = FxHashMap::default();
    for rule in &grammar.rules {
        let stays = rule.successors.iter().map(|s| !gone(&s.symbol));
        kept.entry(rule.symbol.clone())
            .or_insert_with(|| stays.collect());
    }
    // A template may stand in the parts of instances alone.
    let template = grammar.templates.iter().any(|t| is_named(name, &t.symbol));
    if !template && kept.values().flatten().all(|&stays| stays) {
        return Err(CityEditError::NoSymbol(name.to_owned()));
    }
    grammar
        .rules
        .retain(|r| r.symbol == grammar.axiom || !is_named(name, &r.symbol));
    grammar.templates.retain(|t| !is_named(name, &t.symbol));
    for rule in &mut grammar.rules {
        rule.successors.retain(|s| !is_named(name, &s.symbol));
        let own = rule.successors.iter_mut();
        own.for_each(|s| drop_parts(s, &kept, &|symbol| is_named(name, symbol)));
    }
    remove_empty(grammar);
    Ok(())
}

/// Takes out of all rules what derives to nothing any more.
fn remove_empty(grammar: &mut InstanceGrammar) {
    let mut rules: FxHashMap<&str, &InstanceRule> = FxHashMap::default();
    for rule in &grammar.rules {
        rules.entry(rule.symbol.as_str()).or_insert(rule);
    }
    let mut empty: FxHashSet<&str> = FxHashSet::default();
    loop {
        let known = empty.len();
        for (symbol, rule) in &rules {
            if rule.successors.iter().all(|s| is_empty(s, &rules, &empty)) {
                empty.insert(symbol);
            }
        }
        if empty.len() == known {
            break;
        }
    }
    let stays = |rule: &InstanceRule| -> Vec<bool> {
        let successors = rule.successors.iter();
        successors.map(|s| !is_empty(s, &rules, &empty)).collect()
    };
    let masks: Vec<Vec<bool>> = grammar.rules.iter().map(stays).collect();
    let mut kept: FxHashMap<String, Vec<bool>> = FxHashMap::default();
    for (rule, mask) in grammar.rules.iter().zip(&masks) {
        kept.entry(rule.symbol.clone())
            .or_insert_with(|| mask.clone());
    }
    let bare = kept
        .iter()
        .filter(|(symbol, mask)| !mask.contains(&true) && **symbol != grammar.axiom);
    let bare: FxHashSet<String> = bare.map(|(symbol, _)| symbol.clone()).collect();
    for (rule, mask) in grammar.rules.iter_mut().zip(masks) {
        let mut mask = mask.into_iter();
        rule.successors
            .retain(|_| mask.next().is_none_or(|stays| stays));
        let own = rule.successors.iter_mut();
        own.for_each(|s| drop_parts(s, &kept, &|symbol| bare.contains(symbol)));
    }
    grammar.rules.retain(|r| !bare.contains(&r.symbol));
}

/// True if an instance derives to nothing; `empty` are symbols that do where the rule says where parts stand.
fn is_empty(
    placed: &Placement,
    rules: &FxHashMap<&str, &InstanceRule>,
    empty: &FxHashSet<&str>,
) -> bool {
    let Some(rule) = rules.get(placed.symbol.as_str()) else {
        return false;
    };
    if placed.parts.is_empty() {
        return empty.contains(placed.symbol.as_str());
    }
    let parts = rule.successors.iter().enumerate();
    parts
        .map(|(i, own)| placed.parts.get(i).map_or(Some(own), Option::as_ref))
        .all(|part| part.is_none_or(|part| is_empty(part, rules, empty)))
}

/// The parts of an instance without those of successors that are gone, and without those of symbols that are.
fn drop_parts(
    placed: &mut Placement,
    kept: &FxHashMap<String, Vec<bool>>,
    gone: &impl Fn(&str) -> bool,
) {
    for part in &mut placed.parts {
        *part = part.take().filter(|p| !gone(&p.symbol));
    }
    if let Some(stays) = kept.get(&placed.symbol) {
        let mut stays = stays.iter();
        placed.parts.retain(|_| stays.next().is_none_or(|s| *s));
    }
    let parts = placed.parts.iter_mut().flatten();
    parts.for_each(|p| drop_parts(p, kept, gone));
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
