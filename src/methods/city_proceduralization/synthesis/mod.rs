//! New cities from a grammar's buildings, within a drawn shape (Fig. 9).
//!
//! A building of type A that stands calls for its neighbours: where, in the grammar's city, a building of type A has
//! a neighbour of type B, a B is put at the same place relative to it, if it lies inside the shape and on
//! nothing that stands. Most often the neighbours are those of the very building that was copied; now and then (`JUMP`)
//! those of another building of its type, the one copied least so far, so that the new city is no copy of a district.
//! Where nothing more fits, a building that was copied least is tried at chance places, and the growth goes on from
//! there.
//!
//! Whether buildings overlap is read off a grid of 1 m: inner points of a new building must find cells that no other
//! building covers. A building also brings the open ground that is nearer to it than to any other building of its city: no other may
//! stand there, so that streets and yards stay open. Buildings are in classes of equally many, by plan area and height, and no class
//! may run ahead of the others, so that small buildings do not take over where large ones do not fit; of the largest, some are put
//! down before anything else. At the end, buildings are taken out again that make sizes and distances unlike those of the grammar's
//! city (`trim`).

mod occupancy;
mod shape;
mod sources;
mod trim;

use std::collections::VecDeque;

use rand::RngExt;

use self::occupancy::Occupancy;
pub use self::shape::Shape;
use self::shape::rotated;
use self::sources::{AREAS, HEIGHTS, Source, sources};
use super::localization::Landmark;
use edifice_base::rng;
use edifice_grammar::instance::{InstanceGrammar, InstanceGrammarError, InstanceRule};

/// Share of buildings whose neighbours are those of another building of the same type.
const JUMP: f64 = 0.08;
/// Chance places tried one after the other without success before the shape is full.
const TRIES: usize = 200;
/// A class may have so many times its share of the copies,
const AHEAD: f64 = 1.05;
/// and so many more.
const MORE: f64 = 1.0;
/// Classes by plan area, from the largest, of which buildings are put down first,
const LARGE: usize = 1;
/// as many as this share of the grammar's city's density.
const DENSITY: f64 = 0.5;
/// A building is copied no more often than the one copied least, plus this.
const SPREAD: usize = 1;

/// A copy: source, place and turn.
#[derive(Clone, Copy)]
struct Copy {
    source: usize,
    at: [f64; 2],
    turn: f64,
}

/// A grammar over the same templates and rules whose axiom fills `shape`; buildings are named `s1`, `s2`, ....
///
/// # Errors
/// [`InstanceGrammarError`]; the grammar is checked whole first.
pub fn synthesize(
    grammar: &InstanceGrammar,
    shape: &Shape,
    seed: u64,
) -> Result<InstanceGrammar, InstanceGrammarError> {
    let sources = sources(grammar)?;
    let copies = like_the_city(&sources, fill(&sources, shape, seed));
    let mut successors = Vec::new();
    for (i, copy) in copies.iter().enumerate() {
        let source = &sources[copy.source];
        for placed in &source.placed {
            let mut placed = placed.clone();
            let turn = copy.turn - source.turn;
            let [x, y] = rotated(
                [placed.at[0] - source.at[0], placed.at[1] - source.at[1]],
                turn,
            );
            let round = |v: f64, steps: f64| (v * steps).round() / steps;
            placed.at = [
                round(copy.at[0] + x, 100.0),
                round(copy.at[1] + y, 100.0),
                // Copies stand on level ground.
                round(placed.at[2] - source.at[2], 100.0),
            ];
            placed.turn = round((placed.turn + turn).rem_euclid(360.0), 100.0);
            placed.id = Some(format!("s{}", i + 1));
            placed.attributes.clear();
            successors.push(placed);
        }
    }
    let mut out = grammar.clone();
    for rule in out.rules.iter_mut().filter(|r| r.symbol == out.axiom) {
        let symbol = rule.symbol.clone();
        *rule = InstanceRule::new(symbol, 1.0, std::mem::take(&mut successors));
    }
    Ok(out)
}

/// Grows copies inside the shape.
fn fill(sources: &[Source], shape: &Shape, seed: u64) -> Vec<Copy> {
    let Some((low, high)) = shape.bounds() else {
        return Vec::new();
    };
    if sources.is_empty() {
        return Vec::new();
    }
    let mut rng = rng::stream(seed, "city synthesis", 0);
    let count = sources.iter().map(|s| s.kind + 1).max().unwrap_or(0);
    let mut kinds: Vec<Vec<usize>> = vec![Vec::new(); count];
    for (i, s) in sources.iter().enumerate() {
        kinds[s.kind].push(i);
    }
    let mut used = vec![0usize; sources.len()];
    let mut ground = Occupancy::default();
    let mut copies: Vec<Copy> = Vec::new();
    let mut queue: VecDeque<usize> = VecDeque::new();
    let mut failed = 0;
    let mut classes = [0usize; AREAS * HEIGHTS];
    // Copies when all of them were last asked for neighbours.
    let mut asked = 0;
    let chance =
        |rng: &mut rng::Stream| [0, 1].map(|k| low[k] + rng.random::<f64>() * (high[k] - low[k]));
    let mut put = |copy: Copy,
                   ahead: f64,
                   copies: &mut Vec<Copy>,
                   used: &mut [usize],
                   classes: &mut [usize]| {
        let source = &sources[copy.source];
        let share = copies.len() as f64 / classes.len() as f64;
        let fits = (classes[source.class] as f64) < ahead * (share + MORE)
            && ground.take(&source.footprint, copy.at, copy.turn, shape);
        if fits {
            classes[source.class] += 1;
            used[copy.source] += 1;
            copies.push(copy);
        }
        fits
    };
    // Large buildings find no room between others: as many as the shape will hold are put down first.
    for source in large(sources, shape, &mut rng) {
        for _ in 0..TRIES {
            let at = chance(&mut rng);
            let turn = sources[source].turn;
            if put(
                Copy { source, at, turn },
                f64::INFINITY,
                &mut copies,
                &mut used,
                &mut classes,
            ) {
                queue.push_back(copies.len() - 1);
                break;
            }
        }
    }
    loop {
        let least = used.iter().copied().min().unwrap_or(0);
        let Some(i) = queue.pop_front() else {
            if copies.len() > asked {
                // Classes that had run ahead may have room now.
                asked = copies.len();
                queue.extend(0..copies.len());
                continue;
            }
            if failed >= TRIES {
                return copies;
            }
            // Of the class that is most behind, a building copied least, at a chance place, turned as it is in its city.
            let behind = |s: &usize| classes[sources[*s].class];
            let fewest = (0..sources.len()).map(|s| behind(&s)).min().unwrap_or(0);
            let own = (0..sources.len()).filter(|s| behind(s) == fewest);
            let least = own.clone().map(|s| used[s]).min().unwrap_or(0);
            let rare: Vec<usize> = own.filter(|&s| used[s] == least).collect();
            let source = rare[rng.random_range(0..rare.len())];
            let at = chance(&mut rng);
            let turn = sources[source].turn;
            let copy = Copy { source, at, turn };
            if put(copy, AHEAD, &mut copies, &mut used, &mut classes) {
                failed = 0;
                queue.push_back(copies.len() - 1);
            } else {
                failed += 1;
            }
            continue;
        };
        let stands = copies[i];
        let mut like = stands.source;
        if rng.random::<f64>() < JUMP {
            let own = &kinds[sources[like].kind];
            let least = own.iter().map(|&s| used[s]).min().unwrap_or(0);
            let rare: Vec<usize> = own.iter().copied().filter(|&s| used[s] == least).collect();
            like = rare[rng.random_range(0..rare.len())];
        }
        let from = &sources[like];
        let turn = stands.turn - from.turn;
        for &n in &from.near {
            let next = &sources[n];
            if used[n] > least + SPREAD {
                continue;
            }
            let shift = rotated([next.at[0] - from.at[0], next.at[1] - from.at[1]], turn);
            let copy = Copy {
                source: n,
                at: [stands.at[0] + shift[0], stands.at[1] + shift[1]],
                turn: next.turn + turn,
            };
            if put(copy, AHEAD, &mut copies, &mut used, &mut classes) {
                queue.push_back(copies.len() - 1);
            }
        }
    }
}

/// The copies without those that make the new city unlike the grammar's.
fn like_the_city(sources: &[Source], copies: Vec<Copy>) -> Vec<Copy> {
    let old: Vec<Landmark> = sources.iter().map(|s| s.looks).collect();
    let moved = |copy: &Copy| {
        let source = &sources[copy.source];
        let shift = [0, 1].map(|k| source.looks.at[k] - source.at[k]);
        let [x, y] = rotated(shift, copy.turn - source.turn);
        Landmark {
            at: [copy.at[0] + x, copy.at[1] + y],
            seen: source.looks.seen,
        }
    };
    let new: Vec<Landmark> = copies.iter().map(moved).collect();
    let stays = trim::trim(&old, &new);
    let kept = copies.into_iter().zip(stays).filter(|c| c.1);
    kept.map(|c| c.0).collect()
}

/// The sources that are put down first, the largest first: of the classes of the largest plans, evenly over their heights.
fn large(sources: &[Source], shape: &Shape, rng: &mut rng::Stream) -> Vec<usize> {
    let ground: f64 = sources.iter().map(|s| s.footprint.ground()).sum();
    let share = DENSITY * shape.area() / ground;
    let mut own: Vec<usize> = (0..sources.len())
        .filter(|&s| sources[s].class >= (AREAS - LARGE) * HEIGHTS)
        .collect();
    own.sort_by(|&a, &b| {
        let key = |s: usize| (sources[s].class, sources[s].looks.seen.height);
        let ((i, u), (j, v)) = (key(a), key(b));
        i.cmp(&j).then(u.total_cmp(&v)).then(a.cmp(&b))
    });
    // Systematic sampling.
    let mut due = rng.random::<f64>();
    let mut chosen = Vec::new();
    for source in own {
        due += share;
        while due >= 1.0 {
            due -= 1.0;
            chosen.push(source);
        }
    }
    chosen.sort_by_key(|&s| std::cmp::Reverse(sources[s].footprint.points()));
    chosen
}
