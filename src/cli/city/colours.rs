//! Colours of buildings in a picture, by what they tell.

use std::path::Path;

use clap::ValueEnum;
use edifice_base::{Error, Result};
use edifice_grammar::instance::{Begins, InstanceGrammar};
use edifice_io_city::picture::Legend;
use edifice_shape::triangles::{City, CityBuilding};
use rustc_hash::FxHashMap;

use super::data;

/// A property of buildings that their colours tell.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Colour {
    /// Nothing: buildings are light, textures are shown.
    Plain,
    /// The type of building, of a grammar: the most frequent ones have colours of their own.
    Type,
    /// The height above its own ground, in metres.
    Height,
    /// Levels of its rule, of a grammar.
    Level,
    /// The row that it stands in, of a grammar: rows take turns with colours, buildings in no row have the last.
    Row,
    /// The block that it stands in, of a grammar, as for rows.
    Block,
    /// The district that it stands in, of a grammar, as for rows.
    District,
    /// By how much its volume differs from that in `--beside`, in per cent.
    Error,
}

/// Colours of types; all further types share the last.
const TYPES: [[u8; 3]; 12] = [
    [0x4e, 0x79, 0xa7],
    [0xf2, 0x8e, 0x2b],
    [0x59, 0xa1, 0x4f],
    [0xe1, 0x57, 0x59],
    [0xb0, 0x7a, 0xa1],
    [0xed, 0xc9, 0x48],
    [0x76, 0xb7, 0xb2],
    [0xff, 0x9d, 0xa7],
    [0x9c, 0x75, 0x5f],
    [0x8c, 0xd1, 0x7d],
    [0x49, 0x96, 0x94],
    [0xba, 0xb0, 0xac],
];
/// Colours of amounts, from little to much.
const RAMP: [[u8; 3]; 6] = [
    [0xfe, 0xf0, 0xb5],
    [0xfd, 0xcc, 0x7a],
    [0xf7, 0x96, 0x4b],
    [0xe0, 0x52, 0x3a],
    [0xae, 0x1c, 0x4e],
    [0x5d, 0x12, 0x55],
];

/// A city that was read, and the grammar that it was derived from.
pub(super) struct Read {
    /// The city.
    pub city: City,
    grammar: Option<InstanceGrammar>,
}

impl Read {
    /// Reads a city or a grammar.
    pub(super) fn new(path: &Path) -> Result<Self> {
        let grammar = match data::is_grammar(path) {
            true => Some(data::grammar(path)?),
            false => None,
        };
        let city = match &grammar {
            Some(grammar) => data::derived(grammar, path)?,
            None => data::city(path)?,
        };
        Ok(Self { city, grammar })
    }
}

/// Colours of a city's buildings, of those of the city beside it, and what they stand for.
#[derive(Default)]
pub(super) struct Colouring {
    /// Of the city.
    pub colours: Option<Vec<[u8; 3]>>,
    /// Of the city beside it.
    pub beside: Option<Vec<[u8; 3]>>,
    /// The meaning of each colour.
    pub legend: Legend,
}

/// The colours that a picture of `shown`, with `beside` to its left, has.
pub(super) fn colouring(colour: Colour, shown: &Read, beside: Option<&Read>) -> Result<Colouring> {
    let option = |text: &str| Error::option("--colour", text);
    let symbols = |read: &Read| -> Result<Vec<String>> {
        let grammar = read.grammar.as_ref();
        let grammar =
            grammar.ok_or_else(|| option("types and levels are told of grammars only"))?;
        Ok(symbols(grammar, &read.city))
    };
    match colour {
        Colour::Plain => Ok(Colouring::default()),
        Colour::Height => {
            let heights =
                |read: &Read| read.city.buildings.iter().map(height).collect::<Vec<f64>>();
            let own = heights(shown);
            let steps = steps(&own);
            let other = beside.map(|b| ramp(&heights(b), &steps));
            Ok(Colouring {
                colours: Some(ramp(&own, &steps)),
                beside: other,
                legend: legend(&steps, " m"),
            })
        }
        Colour::Level => {
            let grammar = shown.grammar.as_ref();
            let levels: FxHashMap<&str, usize> = grammar
                .iter()
                .flat_map(|g| &g.rules)
                .map(|r| (r.symbol.as_str(), r.levels))
                .collect();
            let of = |s: &String| levels.get(s.as_str()).copied().unwrap_or(0) as f64;
            let own: Vec<f64> = symbols(shown)?.iter().map(of).collect();
            let steps = [1.0, 2.0, 3.0, 4.0, 5.0];
            Ok(Colouring {
                colours: Some(ramp(&own, &steps)),
                beside: None,
                legend: legend(&steps, " levels"),
            })
        }
        Colour::Type => {
            let own = symbols(shown)?;
            let mut counts: FxHashMap<&str, usize> = FxHashMap::default();
            own.iter().for_each(|s| *counts.entry(s).or_default() += 1);
            let mut order: Vec<(&str, usize)> = counts.into_iter().collect();
            order.sort_by(|a, b| b.1.cmp(&a.1).then(a.0.cmp(b.0)));
            let last = TYPES.len() - 1;
            let place: FxHashMap<&str, usize> = order
                .iter()
                .enumerate()
                .map(|(k, o)| (o.0, k.min(last)))
                .collect();
            let named = order.iter().take(last).zip(TYPES);
            let mut legend: Legend = named
                .map(|((symbol, count), colour)| (colour, format!("{symbol} {count}")))
                .collect();
            if let Some(rest) = order.len().checked_sub(last).filter(|n| *n > 0) {
                legend.push((TYPES[last], format!("{rest} other types")));
            }
            let colours = own.iter().map(|s| TYPES[place[s.as_str()]]).collect();
            Ok(Colouring {
                colours: Some(colours),
                beside: None,
                legend,
            })
        }
        Colour::Row => grouped(shown, Begins::Row, "in no row"),
        Colour::Block => grouped(shown, Begins::Block, "alone in its block"),
        Colour::District => grouped(shown, Begins::District, "alone in its district"),
        Colour::Error => {
            let beside = beside.ok_or_else(|| option("errors are told against a city --beside"))?;
            let volumes: FxHashMap<&str, f64> = (beside.city.buildings.iter())
                .map(|b| (b.id.as_str(), volume(b)))
                .collect();
            let error = |b: &CityBuilding| {
                let truth = volumes.get(b.id.as_str()).copied().unwrap_or(0.0);
                match truth > 0.0 {
                    true => 100.0 * (volume(b) - truth).abs() / truth,
                    false => 100.0,
                }
            };
            let own: Vec<f64> = shown.city.buildings.iter().map(error).collect();
            let steps = [1.0, 2.0, 5.0, 10.0, 25.0];
            Ok(Colouring {
                colours: Some(ramp(&own, &steps)),
                beside: None,
                legend: legend(&steps, " %"),
            })
        }
    }
}

/// Colours of rows, blocks or districts, `what` tells of those of one building.
fn grouped(shown: &Read, least: Begins, what: &str) -> Result<Colouring> {
    let none = || {
        Error::option(
            "--colour",
            "rows, blocks and districts are told of grammars only",
        )
    };
    let grammar = shown.grammar.as_ref().ok_or_else(none)?;
    let flat = grammar.flat(None);
    let placed = flat.top().into_iter().flat_map(|r| &r.successors);
    let mut groups: Vec<Vec<&str>> = Vec::new();
    for (placed, begins) in placed.zip(grammar.beginnings()) {
        let id = placed.id.as_deref().unwrap_or_default();
        match groups.last_mut().filter(|_| begins < least) {
            Some(group) => group.push(id),
            None => groups.push(vec![id]),
        }
    }
    let last = TYPES.len() - 1;
    let mut colours: FxHashMap<&str, [u8; 3]> = FxHashMap::default();
    let many = groups.iter().filter(|g| g.len() > 1).enumerate();
    for (k, group) in many {
        colours.extend(group.iter().map(|id| (*id, TYPES[k % last])));
    }
    let of = |b: &CityBuilding| colours.get(b.id.as_str()).copied().unwrap_or(TYPES[last]);
    Ok(Colouring {
        colours: Some(shown.city.buildings.iter().map(of).collect()),
        beside: None,
        legend: vec![(TYPES[last], what.to_owned())],
    })
}

/// The symbol that stands for each building: the innermost with its identifier.
fn symbols(grammar: &InstanceGrammar, city: &City) -> Vec<String> {
    let placed = grammar.rules.iter().flat_map(|r| &r.successors);
    let named: FxHashMap<&str, &str> = placed
        .filter_map(|p| Some((p.id.as_deref()?, p.symbol.as_str())))
        .collect();
    let of = |b: &CityBuilding| {
        named
            .get(b.id.as_str())
            .map_or_else(String::new, |s| (*s).to_owned())
    };
    city.buildings.iter().map(of).collect()
}

fn height(building: &CityBuilding) -> f64 {
    building
        .mesh
        .bounds()
        .map_or(0.0, |(low, high)| high[2] - low[2])
}

fn volume(building: &CityBuilding) -> f64 {
    let base = building.mesh.bounds().map_or(0.0, |b| b.0[2]);
    building.mesh.volume_above(base).abs()
}

/// Round steps between colours: quantiles of the values, to two digits.
fn steps(values: &[f64]) -> [f64; 5] {
    let mut sorted: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    [0.2, 0.4, 0.6, 0.8, 0.95].map(|share| {
        let at = (share * sorted.len() as f64) as usize;
        let v = sorted.get(at).or(sorted.last()).copied().unwrap_or(0.0);
        let unit = 10f64.powf(v.max(1e-3).log10().floor() - 1.0);
        (v / unit).round() * unit
    })
}

fn ramp(values: &[f64], steps: &[f64; 5]) -> Vec<[u8; 3]> {
    let of = |v: &f64| RAMP[steps.iter().filter(|s| *v > **s).count()];
    values.iter().map(of).collect()
}

fn legend(steps: &[f64; 5], unit: &str) -> Legend {
    let text = |k: usize| match k {
        5 => format!("over {}{unit}", number(steps[4])),
        _ => format!("to {}{unit}", number(steps[k])),
    };
    // Between equal steps there is no class.
    let is_class = |k: usize| k == 0 || k == 5 || steps[k] > steps[k - 1];
    let classes = RAMP.into_iter().enumerate().filter(|(k, _)| is_class(*k));
    classes.map(|(k, c)| (c, text(k))).collect()
}

fn number(v: f64) -> String {
    let text = format!("{v:.1}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}
