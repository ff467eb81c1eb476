//! Districts, blocks and rows: the rules between the axiom and the buildings, and how they are taken away again.
//!
//! A grammar is flat if its buildings stand right under the axiom. A flat grammar whose buildings are listed row by row, and where each
//! of them tells what it begins ([`Begins`]), becomes one of districts (`D1`, ...), blocks (`K1`, ...) and rows (`R1`, ...), and flat again
//! without a loss: places within rows are kept on a grid ten times as fine as that of the flat grammar ([`Grid`]), so that they round to
//! where they came from.

use rustc_hash::{FxHashMap, FxHashSet};

use super::derive::Frame;
use super::{InstanceGrammar, InstanceRule, Placement, Places};

/// The largest thing that a building is the first of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Begins {
    /// Nothing: it goes on with the row of the building before it.
    Nothing,
    /// A row, or a building that stands alone, in the block of the building before it.
    Row,
    /// A block in the district of the building before it.
    Block,
    /// A district.
    District,
}

/// Steps on which places and turns lie.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    /// Steps of a metre, of buildings under the axiom.
    pub length: f64,
    /// Steps of a degree.
    pub turn: f64,
}

impl Grid {
    /// Steps of a metre, of buildings within rows: finer, so that what stands in a row rounds to where it stood before. They are
    /// millimetres at least, since a city is written in centimetres when it is read again.
    fn within(&self) -> f64 {
        (10.0 * self.length).max(1000.0)
    }

    fn rounded(&self, mut placed: Placement) -> Placement {
        placed.at = placed.at.map(|v| round(v, self.length));
        placed.turn = turned(placed.turn, self.turn);
        placed
    }
}

/// Steps of a degree, of turns within rows.
const TURNS: f64 = 10_000.0;

fn round(v: f64, steps: f64) -> f64 {
    (v * steps).round() / steps + 0.0
}

fn turned(degrees: f64, steps: f64) -> f64 {
    let turn = round(degrees.rem_euclid(360.0), steps);
    if turn >= 360.0 { 0.0 } else { turn }
}

impl InstanceGrammar {
    /// The flat grammar: everything that has no parameters, identifier or parts of its own is replaced by its successors in their
    /// places, which are put on a grid if one is given.
    #[must_use]
    pub fn flat(&self, grid: Option<&Grid>) -> Self {
        let mut walk = Flat {
            places: Places::new(self),
            grammar: self,
            grid,
            replaced: FxHashSet::default(),
            found: Vec::new(),
        };
        let axiom = Placement::new(self.axiom.as_str(), [0.0; 3], 0.0, [1.0; 3]);
        if let Some(start) = walk.places.rule(&self.axiom) {
            walk.inside(start, &axiom, &Frame::WORLD);
        }
        let Flat {
            replaced, found, ..
        } = walk;
        let mut rules = self.rules.clone();
        rules.retain(|r| !replaced.contains(r.symbol.as_str()));
        if let Some(top) = rules.iter_mut().find(|r| r.symbol == self.axiom) {
            *top = InstanceRule::new(self.axiom.as_str(), top.weight, found);
        }
        Self {
            rules,
            templates: self.templates.clone(),
            name: self.name.clone(),
            reference_system: self.reference_system.clone(),
            axiom: self.axiom.clone(),
            ..*self
        }
    }

    /// The largest thing that each building of [`InstanceGrammar::flat`] begins.
    #[must_use]
    pub fn beginnings(&self) -> Vec<Begins> {
        let places = Places::new(self);
        let mut out = Vec::new();
        if let Some(start) = places.rule(&self.axiom) {
            for placed in &self.rules[start].successors {
                self.begin(placed, Begins::District, &places, &mut out);
            }
        }
        out
    }

    fn begin(&self, placed: &Placement, first: Begins, places: &Places, out: &mut Vec<Begins>) {
        let Some(rule) = self.replaceable(placed, places) else {
            out.push(first);
            return;
        };
        let rule = &self.rules[rule];
        let other = match (rule.row, rule.symbol.chars().next()) {
            (true, _) => Begins::Nothing,
            (false, Some(DISTRICT)) => Begins::Block,
            (false, _) => Begins::Row,
        };
        for (i, placed) in rule.successors.iter().enumerate() {
            self.begin(placed, if i == 0 { first } else { other }, places, out);
        }
    }

    /// The rule of a placement that has no parameters, identifier or parts of its own.
    fn replaceable(&self, placed: &Placement, places: &Places) -> Option<usize> {
        let rule = places.rule(&placed.symbol)?;
        let own = placed.id.is_some() || !placed.parts.is_empty();
        (!own && self.rules[rule].levels == 0).then_some(rule)
    }

    /// The grammar of districts, blocks and rows of a flat grammar whose buildings lie on `grid`. `begins` has an entry for each successor
    /// of the axiom; the first one begins a district. Of one member, nothing is made.
    #[must_use]
    pub fn arranged(&self, begins: &[Begins], grid: &Grid) -> Self {
        let mut out = self.clone();
        let Some(top) = out.top_mut() else {
            return out;
        };
        let members = std::mem::take(&mut top.successors);
        let mut made = Arranged {
            places: Places::new(self),
            within: grid.within(),
            counts: FxHashMap::default(),
            rules: Vec::new(),
        };
        let placed = made.group(members, begins, Begins::District);
        top.successors = placed;
        let Arranged { mut rules, .. } = made;
        // Those that contain others first.
        rules.sort_by_key(|r| (r.row, !r.symbol.starts_with(DISTRICT)));
        out.rules.extend(rules);
        out
    }
}

/// Beginnings of the symbols of districts, blocks and rows.
const DISTRICT: char = 'D';
const BLOCK: char = 'K';
const ROW: char = 'R';

/// A walk that makes a grammar flat.
struct Flat<'g> {
    places: Places<'g>,
    grammar: &'g InstanceGrammar,
    grid: Option<&'g Grid>,
    replaced: FxHashSet<String>,
    found: Vec<Placement>,
}

impl Flat<'_> {
    fn inside(&mut self, rule: usize, own: &Placement, frame: &Frame) {
        for placed in self.places.of(rule, own).iter().flatten() {
            let (at, turn) = frame.place(placed);
            match self.grammar.replaceable(placed, &self.places) {
                Some(rule) => {
                    self.replaced.insert(placed.symbol.clone());
                    let scale = frame.scale * placed.size[0];
                    self.inside(rule, placed, &Frame { at, turn, scale });
                }
                None => {
                    let mut out = placed.clone().into_owned();
                    (out.at, out.turn) = (at, turn);
                    out.size = out.size.map(|v| v * frame.scale);
                    self.found.push(match self.grid {
                        Some(grid) => grid.rounded(out),
                        None => out,
                    });
                }
            }
        }
    }
}

/// Rules of districts, blocks and rows in the making.
struct Arranged<'g> {
    places: Places<'g>,
    within: f64,
    counts: FxHashMap<char, usize>,
    rules: Vec<InstanceRule>,
}

impl Arranged<'_> {
    /// The members of a thing, of which each part begins with `part`, as placements of its parts.
    fn group(
        &mut self,
        members: Vec<Placement>,
        begins: &[Begins],
        part: Begins,
    ) -> Vec<Placement> {
        let mut parts: Vec<(Vec<Placement>, Vec<Begins>)> = Vec::new();
        for (placed, &begin) in members.into_iter().zip(begins) {
            match parts.last_mut() {
                Some((list, starts)) if begin < part => {
                    list.push(placed);
                    starts.push(begin);
                }
                _ => parts.push((vec![placed], vec![begin])),
            }
        }
        let one = |(members, begins): (Vec<Placement>, Vec<Begins>)| {
            let mut inner = match part {
                Begins::District => self.group(members, &begins, Begins::Block),
                Begins::Block => self.group(members, &begins, Begins::Row),
                _ => members,
            };
            match (inner.len(), part) {
                (1, _) => inner.remove(0),
                (_, Begins::District) => self.moved(DISTRICT, inner),
                (_, Begins::Block) => self.moved(BLOCK, inner),
                _ => self.row(inner),
            }
        };
        parts.into_iter().map(one).collect()
    }

    fn symbol(&mut self, kind: char) -> String {
        let count = self.counts.entry(kind).or_default();
        *count += 1;
        format!("{kind}{count}")
    }

    /// A rule with its origin where the first of its members stands.
    fn moved(&mut self, kind: char, mut members: Vec<Placement>) -> Placement {
        let symbol = self.symbol(kind);
        let at = members[0].at;
        for placed in &mut members {
            placed.at = [0, 1, 2].map(|k| round(placed.at[k] - at[k], self.within));
        }
        let rule = InstanceRule::new(symbol.as_str(), 1.0, members);
        self.rules.push(rule);
        Placement::new(symbol, at, 0.0, [1.0; 3])
    }

    /// A row with its origin where the first of its members stands, and its x axis towards the second.
    fn row(&mut self, mut members: Vec<Placement>) -> Placement {
        let symbol = self.symbol(ROW);
        let quarter = self.direction(&members[0], &members[1]);
        let frame = Placement::new(
            symbol.as_str(),
            members[0].at,
            turned(members[0].turn + 90.0 * quarter, TURNS),
            [1.0; 3],
        );
        let mut end = None;
        for placed in &mut members {
            let [x, y, z] = [0, 1, 2].map(|k| placed.at[k] - frame.at[k]);
            let (sin, cos) = frame.turn.to_radians().sin_cos();
            let (along, across) = (x * cos + y * sin, y * cos - x * sin);
            placed.turn = turned(placed.turn - frame.turn, TURNS);
            let half = self.places.length(placed, placed.turn) / 2.0;
            let begin = end.map_or(0.0, |end: f64| end + half);
            placed.at = [along - begin, across, z].map(|v| round(v, self.within));
            end = Some(begin + placed.at[0] + half);
        }
        self.rules.push(InstanceRule {
            row: true,
            ..InstanceRule::new(symbol, 1.0, members)
        });
        frame
    }

    /// The quarter turn of `one` in whose direction the other stands: where least of both lies side by side.
    fn direction(&self, one: &Placement, other: &Placement) -> f64 {
        let away = [0, 1].map(|k| other.at[k] - one.at[k]);
        let apart = |quarter: f64| {
            let turn = one.turn + 90.0 * quarter;
            let (sin, cos) = turn.to_radians().sin_cos();
            let half = |p: &Placement| self.places.length(p, p.turn - turn) / 2.0;
            away[0] * cos + away[1] * sin - half(one) - half(other)
        };
        let quarters = [0.0, 1.0, 2.0, 3.0].into_iter();
        let best = quarters.max_by(|a, b| apart(*a).total_cmp(&apart(*b)).then(b.total_cmp(a)));
        best.unwrap_or(0.0)
    }
}
