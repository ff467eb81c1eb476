//! From a tiling to its parse tree, and back.
//!
//! A region of several terminals is cut along all full lines of one direction: horizontal lines if there are
//! any, else vertical ones. Its parts have no full line of that direction left, so directions alternate.

use super::collapse::collapse;
use super::error::LibraryError;
use super::rules::{Item, Rule, Rules, Symbol};
use edifice_shape::{Axis, Facade, Rect, Region, Span};

/// Deepest nesting of parts.
pub(super) const DEPTH_LIMIT: usize = 400;

/// Most steps along a side.
pub const STEP_LIMIT: u32 = 1 << 16;

/// A facade as a symbol of a table of rules and the parameters of its rules, in the order of the derivation:
/// each region gives the counts of its own repeats and the sizes of its own parts, then come its parts in
/// order with theirs.
#[derive(Debug, Clone, PartialEq)]
pub struct Parse {
    /// Symbol of the whole.
    pub root: Symbol,
    /// Width and height in steps.
    pub extent: [u32; 2],
    /// The number of periods of each repeat.
    pub counts: Vec<u32>,
    /// Sizes of the parts in steps, without the last part of each region, which fills what is left.
    pub sizes: Vec<u32>,
}

/// A node of the tree of a facade.
struct Node {
    symbol: Symbol,
    counts: Vec<u32>,
    sizes: Vec<u32>,
    parts: Vec<Node>,
}

/// The index of an axis in a pair.
pub(super) fn index(axis: Axis) -> usize {
    match axis {
        Axis::X => 0,
        Axis::Y => 1,
    }
}

/// Parses a facade, adding its new rules to the table. `step` is the length of which all are multiples.
///
/// # Errors
/// [`LibraryError::Layout`] for a layout that full lines do not split into its regions, [`LibraryError::OffStep`],
/// [`LibraryError::TooLarge`], [`LibraryError::TooDeep`].
pub(super) fn parse(facade: &Facade, step: f64, rules: &mut Rules) -> Result<Parse, LibraryError> {
    edifice_shape::splittable(facade).map_err(|source| LibraryError::Layout {
        name: facade.name.clone(),
        source,
    })?;
    let layout = facade.indexed().map_err(|source| LibraryError::Layout {
        name: facade.name.clone(),
        source,
    })?;
    let cuts = [
        in_steps(facade, Axis::X, layout.xs.values(), step)?,
        in_steps(facade, Axis::Y, layout.ys.values(), step)?,
    ];
    let labels = facade
        .regions
        .iter()
        .map(|region| rules.label(&region.label))
        .collect();
    let mut builder = Builder {
        spans: &layout.spans,
        labels,
        cuts: &cuts,
        name: &facade.name,
        rules,
    };
    let mut all: Vec<usize> = (0..layout.spans.len()).collect();
    let node = builder.node(&mut all, 0)?;
    let [width, height] = [&cuts[0], &cuts[1]].map(|cuts| cuts[cuts.len() - 1]);
    let mut parse = Parse {
        root: node.symbol,
        extent: [width, height],
        counts: Vec::new(),
        sizes: Vec::new(),
    };
    flatten(&node, &mut parse);
    Ok(parse)
}

/// The cut coordinates of an axis as numbers of steps.
fn in_steps(
    facade: &Facade,
    axis: Axis,
    values: &[f64],
    step: f64,
) -> Result<Vec<u32>, LibraryError> {
    let convert = |&value: &f64| {
        let steps = (value / step).round();
        if steps > f64::from(STEP_LIMIT) {
            return Err(LibraryError::TooLarge {
                name: facade.name.clone(),
                axis: axis.name(),
                extent: steps,
                step,
                limit: STEP_LIMIT,
            });
        }
        if (value - steps * step).abs() > facade.tolerance() {
            return Err(LibraryError::OffStep {
                name: facade.name.clone(),
                axis: axis.name(),
                value,
                step,
            });
        }
        Ok(steps as u32)
    };
    let mut steps: Vec<u32> = values.iter().map(convert).collect::<Result<_, _>>()?;
    if let Some(first) = steps.first_mut() {
        *first = 0;
    }
    match steps.windows(2).position(|pair| pair[0] >= pair[1]) {
        None => Ok(steps),
        Some(at) => Err(LibraryError::OffStep {
            name: facade.name.clone(),
            axis: axis.name(),
            value: values[at + 1],
            step,
        }),
    }
}

struct Builder<'a> {
    spans: &'a [Span],
    labels: Vec<Symbol>,
    cuts: &'a [Vec<u32>; 2],
    name: &'a str,
    rules: &'a mut Rules,
}

impl Builder<'_> {
    /// The node of the regions `part`, which fill a rectangle.
    fn node(&mut self, part: &mut [usize], depth: usize) -> Result<Node, LibraryError> {
        if let [only] = part {
            let symbol = self.labels[*only];
            return Ok(Node {
                symbol,
                counts: Vec::new(),
                sizes: Vec::new(),
                parts: Vec::new(),
            });
        }
        if depth == DEPTH_LIMIT {
            return Err(LibraryError::TooDeep {
                name: self.name.to_owned(),
                limit: DEPTH_LIMIT,
            });
        }
        let Some((axis, starts)) = [Axis::Y, Axis::X]
            .into_iter()
            .find_map(|axis| Some((axis, self.pieces(part, axis)?)))
        else {
            // The layout was found to be splittable.
            return Err(LibraryError::Layout {
                name: self.name.to_owned(),
                source: edifice_shape::LayoutError::Empty,
            });
        };
        let cuts = &self.cuts[index(axis)];
        let edge = |i: usize| cuts[self.spans[part[i]].along(axis).0];
        let sizes: Vec<u32> = starts
            .windows(2)
            .map(|pair| edge(pair[1]) - edge(pair[0]))
            .collect();
        let mut parts = Vec::with_capacity(starts.len());
        for (k, &from) in starts.iter().enumerate() {
            let to = starts.get(k + 1).copied().unwrap_or(part.len());
            parts.push(self.node(&mut part[from..to], depth + 1)?);
        }
        let symbols: Vec<Symbol> = parts.iter().map(|node| node.symbol).collect();
        let (items, counts) = collapse(&symbols);
        let symbol = self.rules.intern(Rule { axis, items });
        Ok(Node {
            symbol,
            counts,
            sizes,
            parts,
        })
    }

    /// Sorts the regions along an axis; where each piece between full lines starts. None if there is one piece.
    fn pieces(&self, part: &mut [usize], axis: Axis) -> Option<Vec<usize>> {
        part.sort_unstable_by_key(|&i| (self.spans[i].along(axis).0, i));
        let mut starts = Vec::new();
        let mut reach = 0;
        for (k, &i) in part.iter().enumerate() {
            let (from, to) = self.spans[i].along(axis);
            if k == 0 || from >= reach {
                starts.push(k);
            }
            reach = reach.max(to);
        }
        (starts.len() > 1).then_some(starts)
    }
}

/// Appends the parameters of a node and of its parts.
fn flatten(node: &Node, parse: &mut Parse) {
    parse.counts.extend_from_slice(&node.counts);
    parse.sizes.extend_from_slice(&node.sizes);
    for part in &node.parts {
        flatten(part, parse);
    }
}

/// One part of a rule's region.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Slot {
    /// Its symbol.
    pub symbol: Symbol,
    /// Index of its item in the rule.
    pub item: u32,
    /// Its place in the period of a repeat; 0 for a part.
    pub place: u32,
    /// Which repetition it belongs to; 0 for a part.
    pub repetition: u32,
}

/// The parts of a rule for given counts, in order.
pub fn slots(rule: &Rule, counts: &[u32]) -> Vec<Slot> {
    let mut counts = counts.iter();
    let mut slots = Vec::new();
    for (item, written) in rule.items.iter().enumerate() {
        let times = match written {
            Item::Part(_) => 1,
            Item::Repeat(_) => counts.next().copied().unwrap_or(2),
        };
        for repetition in 0..times {
            for (place, &symbol) in written.symbols().iter().enumerate() {
                slots.push(Slot {
                    symbol,
                    item: item as u32,
                    place: place as u32,
                    repetition,
                });
            }
        }
    }
    slots
}

/// Walks a parse and calls `visit` for each terminal with its label, corner and extent in steps.
///
/// # Errors
/// [`LibraryError::Invalid`] for parameters that do not fit the rules.
pub(super) fn unfold(
    parse: &Parse,
    rules: &[Rule],
    mut visit: impl FnMut(u32, [u32; 2], [u32; 2]),
) -> Result<(), LibraryError> {
    let wrong = |place: String, message: &str| LibraryError::Invalid {
        place,
        message: message.to_owned(),
    };
    let (mut count, mut size) = (0, 0);
    let mut stack = vec![(parse.root, [0, 0], parse.extent)];
    while let Some((symbol, corner, extent)) = stack.pop() {
        let rule = match symbol {
            Symbol::Terminal(label) => {
                visit(label, corner, extent);
                continue;
            }
            Symbol::Rule(index) => rules
                .get(index as usize)
                .ok_or_else(|| wrong(format!("rule {index}"), "there is no such rule"))?,
        };
        let repeats = rule.items.iter().filter(|item| item.is_repeat()).count();
        let counts = parse
            .counts
            .get(count..count + repeats)
            .ok_or_else(|| wrong(format!("counts[{count}]"), "a repeat has no count"))?;
        let most = extent[index(rule.axis)];
        if let Some(k) = counts.iter().position(|&c| c < 2 || c > most) {
            let place = format!("counts[{}]", count + k);
            return Err(wrong(
                place,
                "expected at least 2, and no more than there are steps",
            ));
        }
        count += repeats;
        let slots = slots(rule, counts);
        let inner = slots.len() - 1;
        let sizes = parse
            .sizes
            .get(size..size + inner)
            .ok_or_else(|| wrong(format!("sizes[{size}]"), "a part has no size"))?;
        let mut left = most;
        let mut at = corner;
        let first = stack.len();
        for (k, slot) in slots.iter().enumerate() {
            let own = sizes.get(k).copied().unwrap_or(left);
            if own == 0 || own > left || (k < inner && own == left) {
                let place = format!("sizes[{}]", size + k);
                return Err(wrong(place, "the parts do not fit their region"));
            }
            let mut part = extent;
            part[index(rule.axis)] = own;
            stack.push((slot.symbol, at, part));
            at[index(rule.axis)] += own;
            left -= own;
        }
        stack[first..].reverse();
        size += inner;
    }
    match (count < parse.counts.len(), size < parse.sizes.len()) {
        (true, _) => Err(wrong(
            format!("counts[{count}]"),
            "no repeat is left for it",
        )),
        (_, true) => Err(wrong(format!("sizes[{size}]"), "no part is left for it")),
        _ => Ok(()),
    }
}

/// The facade of a parse; regions from the bottom up, then from the left.
///
/// # Errors
/// [`LibraryError::Invalid`] for parameters that do not fit the rules.
pub(super) fn facade(
    parse: &Parse,
    rules: &[Rule],
    labels: &[String],
    step: f64,
    (name, unit): (&str, &str),
) -> Result<Facade, LibraryError> {
    let mut found = Vec::new();
    unfold(parse, rules, |label, corner, extent| {
        found.push((corner[1], corner[0], label, extent))
    })?;
    found.sort_unstable();
    let region = |&(y, x, label, extent): &(u32, u32, u32, [u32; 2])| {
        let label = labels
            .get(label as usize)
            .ok_or_else(|| LibraryError::Invalid {
                place: format!("label {label}"),
                message: "there is no such label".to_owned(),
            })?;
        // Edges, not extents, are multiples of the step: neighbours share them exactly.
        let edge = |steps: u32| f64::from(steps) * step;
        let (left, bottom) = (edge(x), edge(y));
        let rect = Rect::new(
            left,
            bottom,
            edge(x + extent[0]) - left,
            edge(y + extent[1]) - bottom,
        );
        Ok(Region {
            label: label.clone(),
            rect,
        })
    };
    let regions = found.iter().map(region).collect::<Result<_, _>>()?;
    let [width, height] = parse.extent.map(|steps| f64::from(steps) * step);
    Facade::new(name, unit, width, height, regions).map_err(|source| LibraryError::Layout {
        name: name.to_owned(),
        source,
    })
}
