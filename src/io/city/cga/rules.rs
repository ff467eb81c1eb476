//! The text of the rules.

use std::collections::BTreeMap;
use std::fmt::Write;

use rustc_hash::{FxHashMap, FxHashSet};

use super::assets;
use super::error::CgaCityError;
use super::shapes::{Kind, Start, commonest};
use edifice_grammar::instance::{InstanceGrammar, InstanceRule, Placement};
use edifice_io::grammar_cga::{identifier, reserved_words};

/// Functions of the text: lengths to the centimetre, extents of at least one, and extents of what is turned.
const FUNCTIONS: &str = "\
cm(v) = case v < 0 : -floor(0.5 - v * 100) / 100 else : floor(v * 100 + 0.5) / 100
span(v) = case cm(v) < 0.01 : 0.01 else : cm(v)
reach(w, d, c, s) = sqrt(w * c * (w * c) + d * s * (d * s))
";
/// Names that [`FUNCTIONS`] takes.
const TAKEN: [&str; 8] = ["cm", "span", "reach", "v", "w", "d", "c", "s"];
/// The first steps of a start rule: x along the first edge of the footprint, and to the middle of it.
const TO_THE_MIDDLE: &str = "alignScopeToGeometry(yUp, 0, 0) t(scope.sx / 2, 0, scope.sz / 2)";

/// A kind of start shapes in the text.
pub(super) struct Known {
    /// The start rule.
    pub rule: String,
    /// Names and values of its attributes.
    pub attributes: Vec<(String, f64)>,
}

/// The rules of a grammar and their names.
pub(super) struct Rules<'g> {
    grammar: &'g InstanceGrammar,
    kinds: BTreeMap<Kind, Known>,
    templates: FxHashMap<&'g str, String>,
}

impl<'g> Rules<'g> {
    /// Names everything that start shapes lead to.
    pub(super) fn new(grammar: &'g InstanceGrammar, starts: &[Start]) -> Self {
        let mut taken: FxHashSet<String> =
            reserved_words().chain(TAKEN).map(str::to_owned).collect();
        let common = commonest(starts);
        let mut used: FxHashSet<&str> = FxHashSet::default();
        for kind in common.keys() {
            match *kind {
                Kind::Rule(rule) => {
                    let successors = grammar.rules[rule].successors.iter();
                    used.extend(successors.map(|s| s.symbol.as_str()));
                }
                Kind::Template(template) => {
                    used.insert(&grammar.templates[template].symbol);
                }
            }
        }
        let symbols = grammar.templates.iter().map(|t| t.symbol.as_str());
        let templates: FxHashMap<&str, String> = symbols
            .filter(|s| used.contains(s))
            .map(|s| (s, identifier(s, &mut taken)))
            .collect();
        let kinds = common.into_iter().map(|(kind, numbers)| {
            let (base, rule, levels) = match kind {
                Kind::Rule(rule) => {
                    let rule = &grammar.rules[rule];
                    let base = identifier(&rule.symbol, &mut taken);
                    (base.clone(), base, Some(rule.levels))
                }
                Kind::Template(template) => {
                    let base = templates[grammar.templates[template].symbol.as_str()].clone();
                    let rule = identifier(&format!("{base}_building"), &mut taken);
                    (base, rule, None)
                }
            };
            let mut names = vec!["width".to_owned(), "depth".to_owned()];
            match levels {
                None => names.push("height".to_owned()),
                Some(levels) => {
                    names.extend((1..=levels).map(|k| format!("h{k}")));
                    names.extend(["width", "depth", "height"].map(|n| format!("{n}_factor")));
                }
            }
            let names = names.iter().map(|n| format!("{base}_{n}"));
            let names: Vec<String> = names.map(|n| identifier(&n, &mut taken)).collect();
            let attributes = names.into_iter().zip(numbers).collect();
            (kind, Known { rule, attributes })
        });
        let kinds = kinds.collect();
        Self {
            grammar,
            kinds,
            templates,
        }
    }

    /// The names of a kind that start shapes are of.
    pub(super) fn kind(&self, kind: Kind) -> &Known {
        &self.kinds[&kind]
    }

    /// The text; assets that it inserts are added to `meshes`.
    pub(super) fn text(
        &self,
        folder: &str,
        meshes: &mut Vec<(String, String)>,
    ) -> Result<String, CgaCityError> {
        let residuals = self.grammar.residuals();
        let mut out = format!(
            "version \"2019.0\"\n// {}: types of buildings, in metres. Start shapes state rule and attributes.\n\
             // Left out: the residuals of {residuals} instances (parts stand where the rules put them), pictures, weights of rules.\n\n",
            self.grammar.name.escape_debug()
        );
        for known in self.kinds.values() {
            for (name, value) in &known.attributes {
                // Writing to a String cannot fail.
                let _ = writeln!(out, "@Group(\"{}\") attr {name} = {value}", known.rule);
            }
        }
        if self.kinds.keys().any(|k| matches!(k, Kind::Rule(_))) {
            let _ = write!(out, "\n{FUNCTIONS}");
        }
        for (kind, known) in &self.kinds {
            let _ = write!(
                out,
                "\n@StartRule\n{} -->\n    {TO_THE_MIDDLE}\n",
                known.rule
            );
            let names: Vec<&str> = known.attributes.iter().map(|a| a.0.as_str()).collect();
            match *kind {
                Kind::Template(template) => {
                    let leaf = &self.templates[self.grammar.templates[template].symbol.as_str()];
                    let [w, d, h] = [0, 1, 2].map(|k| names[k]);
                    let _ = writeln!(out, "    s({w}, {h}, {d}) {leaf}");
                }
                Kind::Rule(rule) => {
                    let rule = &self.grammar.rules[rule];
                    if rule.successors.is_empty() {
                        out.push_str("    NIL\n");
                    }
                    for successor in &rule.successors {
                        let leaf = &self.templates[successor.symbol.as_str()];
                        let _ = writeln!(out, "    [ {} {leaf} ]", part(rule, successor, &names));
                    }
                }
            }
        }
        out.push('\n');
        for template in &self.grammar.templates {
            let Some(leaf) = self.templates.get(template.symbol.as_str()) else {
                continue;
            };
            let Some((low, high)) = assets::bounds(template)? else {
                let _ = writeln!(out, "{leaf} --> NIL");
                continue;
            };
            let up = times(low[2], "scope.sy").unwrap_or_else(|| "0".to_owned());
            let (x, z) = (low[0], 0.0 - high[1]);
            let _ = write!(out, "{leaf} --> t({x} * scope.sx, {up}, {z} * scope.sz) ");
            let [x, y, z] = [0, 1, 2].map(|k| high[k] - low[k]);
            if [x, y, z] != [1.0; 3] {
                let _ = write!(out, "s({x} * scope.sx, {z} * scope.sy, {y} * scope.sz) ");
            }
            if assets::is_box(&template.mesh, low, high) {
                out.push_str("primitiveCube()\n");
                continue;
            }
            let _ = writeln!(out, "i(\"{folder}/{leaf}.obj\")");
            meshes.push((format!("{leaf}.obj"), assets::obj(template)));
        }
        Ok(out)
    }
}

/// The operations that bring a scope to a successor of a rule with parameters, as [`InstanceRule::part`] computes them.
fn part(rule: &InstanceRule, successor: &Placement, names: &[&str]) -> String {
    let (width, depth, levels) = (names[0], names[1], &names[2..2 + rule.levels]);
    let factors = &names[2 + rule.levels..];
    let level = successor.at[2];
    let below = levels.iter().enumerate().map(|(k, h)| {
        let share = (level - k as f64).clamp(0.0, 1.0);
        times(share, h)
    });
    let below: Vec<String> = below.flatten().collect();
    let shift = |length: Option<String>, factor: &str| match length {
        Some(length) => format!("cm({length}) * {factor}"),
        None => "0".to_owned(),
    };
    let by = [
        shift(times(successor.at[0], width), factors[0]),
        shift((!below.is_empty()).then(|| below.join(" + ")), factors[2]),
        shift(times(-successor.at[1], depth), factors[1]),
    ];
    let (sin, cos) = successor.turn.to_radians().sin_cos();
    // Of what is turned by quarters, the width lies along one side.
    let quarters = successor.turn.rem_euclid(180.0);
    let along = |w: &str, d: &str, cos: f64, sin: f64| match quarters {
        0.0 => w.to_owned(),
        90.0 => d.to_owned(),
        _ => format!("reach({w}, {d}, {cos}, {sin})"),
    };
    let extent = |share: f64, length: String, factor: String| {
        let length = times(share, &length).unwrap_or(length);
        format!("span({length}) * {factor}")
    };
    let size = [
        extent(
            successor.size[0],
            along(width, depth, cos, sin),
            along(factors[0], factors[1], cos, sin),
        ),
        extent(
            successor.size[2],
            levels[level.max(0.0) as usize].to_owned(),
            factors[2].to_owned(),
        ),
        extent(
            successor.size[1],
            along(depth, width, cos, sin),
            along(factors[1], factors[0], cos, sin),
        ),
    ];
    let mut out = String::new();
    if by.iter().any(|v| v != "0") {
        let _ = write!(out, "t({}) ", by.join(", "));
    }
    if successor.turn != 0.0 {
        let _ = write!(out, "r(0, {}, 0) ", successor.turn);
    }
    let _ = write!(out, "s({})", size.join(", "));
    out
}

/// A share of a length; `None` for none of it.
fn times(share: f64, name: &str) -> Option<String> {
    match share {
        0.0 => None,
        1.0 => Some(name.to_owned()),
        _ => Some(format!("{share} * {name}")),
    }
}
