//! Rules from repetition in the plan: pairs of symbols that stand at the same place relative to each
//! other, again and again.
//!
//! Re-Pair (Larsson and Moffat 2000) carried over from strings to the plane: of all pairs of neighbouring
//! symbols at like relative places, the one that occurs most often becomes a rule and its occurrences become one
//! symbol each; so on, until no pair occurs [`LEAST`] times. Many pairs are replaced in each round, the most frequent
//! first, each symbol taking part once. A rule that is used by one other rule alone is
//! then written into it, so that what always stands together is one rule.
//!
//! Symbols that look the same after half a turn have two frames; both are tried, and the first occurrence
//! decides.

use std::collections::BTreeMap;

use rustc_hash::FxHashMap;

/// A pair becomes a rule when it occurs so often: with two occurrences a rule saves nothing.
const LEAST: usize = 3;
/// Greatest distance of relative places that are alike, in metres; it grows with the next constant.
const CLOSE: f64 = 1.0;
/// Share of the distance from the anchor that is added to it.
const CLOSE_SHARE: f64 = 0.1;
/// Greatest difference of turns that are alike, in degrees.
const CLOSE_TURN: f64 = 15.0;
/// Rounds at most.
const ROUNDS: usize = 24;

/// A symbol in the plan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Posed {
    /// Number of its symbol.
    pub kind: usize,
    /// Position in metres.
    pub at: [f64; 3],
    /// Turn about the vertical in degrees.
    pub turn: f64,
}

/// A group of symbols that always stand together.
#[derive(Debug, Clone, PartialEq)]
pub struct Repeated {
    /// Members in the frame of the rule, with mean places: kinds below the number of kinds given, then rules in order.
    pub members: Vec<Posed>,
    /// Number of occurrences.
    pub count: usize,
}

/// Finds rules. `posed`: the symbols, of kinds below `kinds`; `symmetric`, for each kind: whether half a turn
/// does not change it; `near`: pairs of neighbours, as indices. Members of rules come before the rules that use them.
pub fn repeated(
    posed: &[Posed],
    kinds: usize,
    symmetric: &[bool],
    near: &[(usize, usize)],
) -> Vec<Repeated> {
    let mut state = State {
        items: posed.to_vec(),
        symmetric: symmetric.to_vec(),
        kinds,
        rules: Vec::new(),
    };
    // Neighbours of what was joined are those of its members.
    let mut edges: Vec<(usize, usize)> = near.to_vec();
    for _ in 0..ROUNDS {
        edges
            .iter_mut()
            .for_each(|e| *e = (e.0.min(e.1), e.0.max(e.1)));
        edges.sort_unstable();
        edges.dedup();
        let joined = state.round(&edges);
        if joined.is_empty() {
            break;
        }
        for e in &mut edges {
            let now = |i: usize| joined.get(&i).copied().unwrap_or(i);
            *e = (now(e.0), now(e.1));
        }
        edges.retain(|e| e.0 != e.1);
    }
    inlined(state.rules, kinds)
}

/// A place relative to a symbol.
type Relative = ([f64; 3], f64);

/// An occurrence of a pair: anchor, whether its frame takes half a turn, the other, and where it is.
#[derive(Clone, Copy)]
struct Occurrence {
    anchor: usize,
    half: bool,
    other: usize,
    place: Relative,
}

struct State {
    items: Vec<Posed>,
    symmetric: Vec<bool>,
    kinds: usize,
    rules: Vec<Repeated>,
}

impl State {
    /// One round; what each joined item has become.
    fn round(&mut self, edges: &[(usize, usize)]) -> FxHashMap<usize, usize> {
        let mut pairs: BTreeMap<(usize, usize), Vec<(usize, usize)>> = BTreeMap::new();
        for &(i, j) in edges {
            let (a, b) = (self.items[i].kind, self.items[j].kind);
            let (key, pair) = match a <= b {
                true => ((a, b), (i, j)),
                false => ((b, a), (j, i)),
            };
            pairs.entry(key).or_default().push(pair);
        }
        let mut groups: Vec<Vec<Occurrence>> = Vec::new();
        for (_, list) in pairs.into_iter().filter(|(_, l)| l.len() >= LEAST) {
            groups.extend(self.alike(&list).into_iter().filter(|g| g.len() >= LEAST));
        }
        // Stable: of equally many, the pairs of lower kinds.
        groups.sort_by_key(|g| std::cmp::Reverse(g.len()));
        let mut joined = FxHashMap::default();
        for group in groups {
            let mut taken: FxHashMap<usize, ()> = FxHashMap::default();
            let mut free = |o: &Occurrence| {
                let open = |i| !joined.contains_key(&i) && !taken.contains_key(&i);
                let both = open(o.anchor) && open(o.other);
                if both {
                    taken.insert(o.anchor, ());
                    taken.insert(o.other, ());
                }
                both
            };
            let own: Vec<Occurrence> = group.into_iter().filter(|o| free(o)).collect();
            if own.len() >= LEAST {
                self.join(&own, &mut joined);
            }
        }
        joined
    }

    /// Groups the occurrences of a pair of kinds by relative place.
    fn alike(&self, pairs: &[(usize, usize)]) -> Vec<Vec<Occurrence>> {
        let mut groups: Vec<(Relative, Vec<Occurrence>)> = Vec::new();
        // Leaders by cells of their tolerance.
        let mut cells: FxHashMap<[i64; 2], Vec<usize>> = FxHashMap::default();
        let ways: Vec<Vec<Occurrence>> = pairs.iter().map(|&p| self.ways(p)).collect();
        let farthest = ways
            .iter()
            .map(|w| length(w[0].place.0))
            .fold(0.0, f64::max);
        let side = CLOSE + CLOSE_SHARE * farthest;
        for ways in ways {
            let cell = |p: [f64; 3]| [0, 1].map(|k| (p[k] / side).floor() as i64);
            let mut best: Option<(f64, usize, Occurrence)> = None;
            for way in &ways {
                let [x, y] = cell(way.place.0);
                let around = (-1..=1).flat_map(|u| (-1..=1).map(move |v| [x + u, y + v]));
                for &g in around.filter_map(|c| cells.get(&c)).flatten() {
                    let Some((far, place)) = self.close(&groups[g].0, way) else {
                        continue;
                    };
                    if best.is_none_or(|b| (far, g) < (b.0, b.1)) {
                        best = Some((far, g, Occurrence { place, ..*way }));
                    }
                }
            }
            match best {
                Some((_, g, occurrence)) => groups[g].1.push(occurrence),
                None => {
                    cells
                        .entry(cell(ways[0].place.0))
                        .or_default()
                        .push(groups.len());
                    groups.push((ways[0].place, vec![ways[0]]));
                }
            }
        }
        groups.into_iter().map(|g| g.1).collect()
    }

    /// The ways to see a pair: from a symbol that half a turn changes, if there is one; from either, if both are of
    /// one kind.
    fn ways(&self, (i, j): (usize, usize)) -> Vec<Occurrence> {
        let same = self.items[i].kind == self.items[j].kind;
        let [a, b] = [i, j].map(|k| self.symmetric[self.items[k].kind]);
        let mut anchors = match (a, b) {
            (true, false) => vec![(j, i)],
            _ => vec![(i, j)],
        };
        if same {
            anchors.push((j, i));
        }
        let mut ways = Vec::new();
        for (anchor, other) in anchors {
            let turns: &[bool] = match self.symmetric[self.items[anchor].kind] {
                true => &[false, true],
                false => &[false],
            };
            for &half in turns {
                let place = relative(&self.items[other], &self.items[anchor], half);
                ways.push(Occurrence {
                    anchor,
                    half,
                    other,
                    place,
                });
            }
        }
        ways
    }

    /// The distance of an occurrence from a leader, and its relative place, if it is alike; `None` otherwise. The other
    /// symbol's turn is chosen to fit.
    fn close(&self, leader: &Relative, way: &Occurrence) -> Option<(f64, Relative)> {
        let shift = [0, 1, 2].map(|k| way.place.0[k] - leader.0[k]);
        let far = length(shift);
        let mut turn = wrapped(way.place.1 - leader.1);
        if self.symmetric[self.items[way.other].kind] && turn.abs() > 90.0 {
            turn = wrapped(turn + 180.0);
        }
        let close = far <= CLOSE + CLOSE_SHARE * length(leader.0) && turn.abs() <= CLOSE_TURN;
        close.then_some((far, (way.place.0, leader.1 + turn)))
    }

    /// Makes a rule of a group's occurrences, and an item of each.
    fn join(&mut self, own: &[Occurrence], joined: &mut FxHashMap<usize, usize>) {
        let n = own.len() as f64;
        let mean = |f: &dyn Fn(&Occurrence) -> f64| own.iter().map(f).sum::<f64>() / n;
        let (anchor, other) = (own[0].anchor, own[0].other);
        let members = vec![
            Posed {
                kind: self.items[anchor].kind,
                at: [0.0; 3],
                turn: 0.0,
            },
            Posed {
                kind: self.items[other].kind,
                at: [0, 1, 2].map(|k| mean(&|o| o.place.0[k])),
                turn: mean(&|o| o.place.1),
            },
        ];
        let kind = self.kinds + self.rules.len();
        self.rules.push(Repeated {
            members,
            count: own.len(),
        });
        self.symmetric.push(false);
        for o in own {
            let from = self.items[o.anchor];
            joined.insert(o.anchor, self.items.len());
            joined.insert(o.other, self.items.len());
            self.items.push(Posed {
                kind,
                at: from.at,
                turn: from.turn + if o.half { 180.0 } else { 0.0 },
            });
        }
    }
}

/// The place of `item` in the frame of `anchor`, turned by half a turn or not.
fn relative(item: &Posed, anchor: &Posed, half: bool) -> Relative {
    let turn = anchor.turn + if half { 180.0 } else { 0.0 };
    let (sin, cos) = turn.to_radians().sin_cos();
    let [x, y, z] = [0, 1, 2].map(|k| item.at[k] - anchor.at[k]);
    (
        [x * cos + y * sin, y * cos - x * sin, z],
        wrapped(item.turn - turn),
    )
}

/// The place outside of an item that is given in the frame of `frame`.
fn placed(item: &Posed, frame: &Posed) -> Posed {
    let (sin, cos) = frame.turn.to_radians().sin_cos();
    let [x, y, z] = item.at;
    Posed {
        kind: item.kind,
        at: [
            frame.at[0] + x * cos - y * sin,
            frame.at[1] + x * sin + y * cos,
            frame.at[2] + z,
        ],
        turn: wrapped(frame.turn + item.turn),
    }
}

/// Degrees from -180 to 180.
fn wrapped(turn: f64) -> f64 {
    (turn + 180.0).rem_euclid(360.0) - 180.0
}

/// Length in the plan: heights follow the ground.
fn length(v: [f64; 3]) -> f64 {
    v[0].hypot(v[1])
}

/// Writes rules that one other rule alone uses, at each of its occurrences, into that rule.
fn inlined(mut rules: Vec<Repeated>, kinds: usize) -> Vec<Repeated> {
    let mut used = vec![0usize; rules.len()];
    for rule in &rules {
        for m in rule.members.iter().filter(|m| m.kind >= kinds) {
            used[m.kind - kinds] += rule.count;
        }
    }
    let users = |r: usize, rules: &[Repeated]| {
        let uses = rules.iter().map(|q| &q.members);
        uses.flatten().filter(|m| m.kind == kinds + r).count()
    };
    let whole: Vec<bool> = (0..rules.len())
        .map(|r| used[r] == rules[r].count && users(r, &rules) == 1)
        .collect();
    // Children are before parents, so that what is written in is final.
    for r in 0..rules.len() {
        let members = std::mem::take(&mut rules[r].members);
        for m in members {
            match m.kind.checked_sub(kinds).filter(|&c| whole[c]) {
                Some(child) => {
                    let inner = rules[child].members.clone();
                    let inner = inner.iter().map(|i| placed(i, &m));
                    rules[r].members.extend(inner);
                }
                None => rules[r].members.push(m),
            }
        }
    }
    let mut number = Vec::with_capacity(rules.len());
    let mut next = kinds;
    for &gone in &whole {
        number.push(next);
        next += usize::from(!gone);
    }
    let mut out = Vec::new();
    for (mut rule, gone) in rules.into_iter().zip(whole) {
        for m in rule.members.iter_mut().filter(|m| m.kind >= kinds) {
            m.kind = number[m.kind - kinds];
        }
        if !gone {
            out.push(rule);
        }
    }
    out
}

#[cfg(test)]
mod tests;
