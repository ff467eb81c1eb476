//! From rules with named sizes and counts to text.
//!
//! ```text
//! attr wall_width = 15.4 // 104 facades, 8 to 31, deviation 3.2
//! attr window_width = 20.1 // 104 facades, 12 to 30, deviation 2.9
//!
//! @StartRule
//! Facade -->
//!     60% : Facade1(4, 5)
//!     else : Facade1(5, 5)
//!
//! Facade1(columns, floors) --> split(y) { { '1 / floors : Row1(columns) }* }
//!
//! Row1(columns) --> split(x) { ~columns * (wall_width + window_width) : split(x) {
//!     { 'wall_width / (columns * (wall_width + window_width)) : wall | ... }* } | ~wall_width : wall }
//! ```
//!
//! All sizes float, so that the rules fill any lot. A period is given as a share of its region, so that it fits exactly as
//! often as its count says.

use rustc_hash::{FxHashMap, FxHashSet};

use super::names::{identifier, identifiers};
use super::reserved;
use super::write::{VERSION, percentages};
use crate::json::quoted;
use crate::palette::Palette;
use edifice_grammar::parametric::{Attribute, Named, NamedItem, NamedPart, NamedRule, Spread};

/// Longest line of a rule, in characters.
const LINE: usize = 120;

/// The text of rules with named sizes and counts.
pub(super) fn to_string(named: &Named) -> String {
    let mut taken: FxHashSet<String> = reserved::words().map(str::to_owned).collect();
    let rules = named.rules.iter().map(|rule| rule.symbol.as_str());
    let labels = named.labels.iter().map(String::as_str);
    let symbols = std::iter::once(named.start.symbol.as_str());
    let symbols = symbols.chain(rules).chain(labels);
    let (mut names, renamed) = identifiers(symbols, &mut taken);
    let attributes = named
        .attributes
        .iter()
        .map(|attribute| attribute.name.as_str());
    let parameters = named.rules.iter().flat_map(|rule| &rule.parameters);
    for name in attributes.chain(parameters.map(String::as_str)) {
        if !names.contains_key(name) {
            names.insert(name, identifier(name, &mut taken));
        }
    }
    let text = Text { names };
    let start = &named.start;
    let symbol = text.name(&start.symbol);
    let called = match start.name == start.symbol {
        true => String::new(),
        false => format!(" {}", quoted(&start.name)),
    };
    let mut lines = vec![
        "// Rules with parameters in CGA (CityEngine) syntax, written by Edifice.".to_owned(),
        format!("version \"{VERSION}\""),
        format!("//@ unit {}", quoted(&named.unit)),
        format!(
            "//@ facade {symbol} {} x {}{called}",
            tidy(start.width),
            tidy(start.height)
        ),
    ];
    for (identifier, symbol) in renamed {
        lines.push(format!("//@ symbol {identifier} {}", quoted(symbol)));
    }
    lines.push(String::new());
    lines.extend(
        named
            .attributes
            .iter()
            .map(|attribute| text.attribute(attribute)),
    );
    if !named.choices.is_empty() {
        lines.push(format!("\n@StartRule\n{symbol} -->{}", text.choices(named)));
    }
    for rule in &named.rules {
        let mark = if rule.symbol == start.symbol {
            "@StartRule\n"
        } else {
            ""
        };
        lines.push(format!("\n{mark}{}", text.rule(rule)));
    }
    lines.push(String::new());
    let palette = Palette::new(named.labels.iter().map(String::as_str));
    for label in &named.labels {
        let [r, g, b] = palette.color(label);
        let mark = if *label == start.symbol {
            "@StartRule\n"
        } else {
            ""
        };
        let label = text.name(label);
        lines.push(format!(
            "{mark}{label} --> color(\"#{r:02x}{g:02x}{b:02x}\")"
        ));
    }
    lines.join("\n") + "\n"
}

/// A length without the noise of its last digits.
fn tidy(length: f64) -> f64 {
    (length * 1e9).round() / 1e9
}

/// A symbol or rule with names in parentheses, if there are any.
fn with(name: &str, inside: &[String]) -> String {
    match inside.is_empty() {
        true => name.to_owned(),
        false => format!("{name}({})", inside.join(", ")),
    }
}

struct Text<'n> {
    names: FxHashMap<&'n str, String>,
}

impl Text<'_> {
    fn name<'s>(&'s self, name: &'s str) -> &'s str {
        self.names.get(name).map_or(name, String::as_str)
    }

    fn all(&self, names: &[String]) -> Vec<String> {
        names
            .iter()
            .map(|name| self.name(name).to_owned())
            .collect()
    }

    fn attribute(&self, attribute: &Attribute) -> String {
        let line = format!(
            "attr {} = {}",
            self.name(&attribute.name),
            tidy(attribute.value)
        );
        match &attribute.spread {
            None => line,
            Some(Spread { facades: 1, .. }) => format!("{line} // 1 facade"),
            Some(Spread {
                facades,
                deviation,
                range: (least, greatest),
            }) => {
                format!(
                    "{line} // {facades} facades, {least:.1} to {greatest:.1}, deviation {deviation:.1}"
                )
            }
        }
    }

    /// The replacements of the start, with the shares of the facades that chose them.
    fn choices(&self, named: &Named) -> String {
        let calls = named.choices.iter().map(|choice| {
            let counts: Vec<String> = choice.counts.iter().map(u32::to_string).collect();
            with(self.name(&choice.symbol), &counts)
        });
        let calls: Vec<String> = calls.collect();
        if let [only] = &calls[..] {
            return format!(" {only}");
        }
        let weights: Vec<f64> = named.choices.iter().map(|c| c.facades as f64).collect();
        let (percentages, _) = percentages(&weights);
        let last = calls.len() - 1;
        let line = |(k, call): (usize, &String)| match k == last {
            true => format!("\n    else : {call}"),
            false => format!("\n    {}% : {call}", percentages[k]),
        };
        calls.iter().enumerate().map(line).collect()
    }

    fn rule(&self, rule: &NamedRule) -> String {
        let head = with(self.name(&rule.symbol), &self.all(&rule.parameters));
        let axis = rule.axis.name();
        let items: Vec<String> = match &rule.items[..] {
            [NamedItem::Repeat { count, period }] => vec![self.repeat(count, period)],
            items => items
                .iter()
                .map(|item| match item {
                    NamedItem::Part(part) => {
                        format!("~{} : {}", self.name(&part.size), self.part(part))
                    }
                    NamedItem::Repeat { count, period } => {
                        let (size, times) = (self.period(period), self.name(count));
                        let inner = self.repeat(count, period);
                        format!("~{times} * {size} : split({axis}) {{ {inner} }}")
                    }
                })
                .collect(),
        };
        let line = format!("{head} --> split({axis}) {{ {} }}", items.join(" | "));
        match line.chars().count() <= LINE {
            true => line,
            false => format!(
                "{head} --> split({axis}) {{\n    {} }}",
                items.join(" |\n    ")
            ),
        }
    }

    fn part(&self, part: &NamedPart) -> String {
        with(self.name(&part.symbol), &self.all(&part.arguments))
    }

    /// The size of one period.
    fn period(&self, period: &[NamedPart]) -> String {
        let sizes: Vec<&str> = period.iter().map(|part| self.name(&part.size)).collect();
        match &sizes[..] {
            [only] => (*only).to_owned(),
            several => format!("({})", several.join(" + ")),
        }
    }

    /// A period that fits as often as its count says.
    fn repeat(&self, count: &str, period: &[NamedPart]) -> String {
        let (times, whole) = (self.name(count), self.period(period));
        let parts = period.iter().map(|part| {
            let share = match period {
                [_] => format!("'1 / {times}"),
                _ => format!("'{} / ({times} * {whole})", self.name(&part.size)),
            };
            format!("{share} : {}", self.part(part))
        });
        let parts: Vec<String> = parts.collect();
        format!("{{ {} }}*", parts.join(" | "))
    }
}

#[cfg(test)]
mod tests;
