//! The four sides of a house, each by the search of method `best`.

use super::cut::{Candidate, Choice, NARROWEST, choices};
use super::doors::{door_strip, entered, place, porch_door};
use super::glaze::{DOOR, Furnishing, glaze, holds_asymmetric, millimetres, usual_count};
use super::rescale::shrink;
use super::room::{FixedPiece, Strip, Walls};
use super::styles;
use crate::attributes::facade_attributes;
use edifice_shape::solid::Faces;
use edifice_shape::{Building, ElementStyle, FacadePiece, Side};

/// The attributes that the facades are to reach.
#[derive(Debug, Clone, PartialEq)]
pub struct FacadeTarget {
    /// Window-to-wall ratio, symmetry and alignment, each of front, back, left and right.
    pub wanted: [f64; 12],
    /// Sash, sliding, casement, bay, fixed.
    pub windows: [bool; 5],
    /// True if a strip may be cut.
    pub cuts: bool,
    /// Observed pieces that stay as they are.
    pub fixed: Vec<FixedPiece>,
}

/// Facades and how near they are.
#[derive(Debug, Clone, PartialEq)]
pub struct Facades {
    /// The pieces of all sides.
    pub pieces: Vec<FacadePiece>,
    /// Largest distance from the wanted attributes in standard deviations.
    pub max_z: f64,
    /// Number of layouts measured.
    pub evaluations: u64,
}

/// Distances between windows to try, in units of that at which the side has the usual number of windows for its ratio.
const SPACINGS: [f64; 11] = [1.0, 1.15, 0.87, 1.35, 0.75, 1.7, 0.62, 2.3, 0.5, 3.5, 0.36];
/// The nearest and the furthest usual distance (m).
const USUAL: [f64; 2] = [1.2, 40.0];
/// Choices of asymmetric strips tried.
const CHOICES: usize = 10;
/// Distance in standard deviations at which to stop, and what a missing door counts.
const ENOUGH: f64 = 0.04;
const NO_DOOR: f64 = 100.0;

/// Spacings of which the one with the most usual number of windows is taken; others are tried when these do not serve.
const LOOKED: usize = 4;

/// Puts windows and doors on the walls of a building; `deviations` are those of the twelve attributes.
pub fn furnish(
    building: &Building,
    shell: &Faces,
    target: &FacadeTarget,
    deviations: &[f64],
) -> Facades {
    let walls = Walls::new(building, shell, &target.fixed);
    let styles = styles::wanted(target.windows);
    let mut out = Facades {
        pieces: Vec::new(),
        max_z: 0.0,
        evaluations: 0,
    };
    // Windows that the sides so far have beyond the usual number: the others have fewer, so that the house has as many.
    let mut beyond = 0.0;
    for (s, side) in Side::ALL.into_iter().enumerate() {
        let mut search = SideSearch {
            building,
            walls: &walls,
            strips: &walls.strips[s],
            wanted: [0, 1, 2].map(|k| target.wanted[4 * k + s]),
            deviations: [0, 1, 2].map(|k| deviations[4 * k + s]),
            styles: shared(&styles, s),
            column: s,
            side,
            cuts: target.cuts,
            fixed: &target.fixed,
            beyond,
            evaluations: 0,
        };
        let door = (!has_door(&target.fixed))
            .then(|| door_strip(building, &walls, side))
            .flatten();
        let (pieces, z) = search.run(door);
        beyond = search.beyond;
        out.evaluations += search.evaluations;
        out.max_z = out.max_z.max(z);
        out.pieces.extend(pieces);
    }
    missing_styles(&mut out.pieces, &styles, &target.fixed);
    if !has_door(&target.fixed)
        && let Some(side) = entered(building, &walls, &mut out.pieces)
    {
        let ratio = target.wanted[place(side)];
        shrink(&mut out.pieces, side, ratio, &target.fixed);
    }
    out
}

fn windows(pieces: &[FacadePiece]) -> usize {
    let elements = pieces.iter().flat_map(|p| &p.elements);
    elements.filter(|e| e.style != ElementStyle::Door).count()
}

fn is_entered(pieces: &[FacadePiece]) -> bool {
    let mut elements = pieces.iter().flat_map(|p| &p.elements);
    elements.any(|e| e.style == ElementStyle::Door)
}

fn has_door(fixed: &[FixedPiece]) -> bool {
    let mut elements = fixed.iter().flat_map(|f| &f.piece.elements);
    elements.any(|e| e.style == ElementStyle::Door)
}

/// The styles of a side: the main one, and for each further one a side of its own, bays in front.
fn shared(styles: &[ElementStyle], side: usize) -> Vec<ElementStyle> {
    let mut own: Vec<ElementStyle> = styles.first().copied().into_iter().collect();
    for (k, style) in styles.iter().enumerate().skip(1) {
        let home = if *style == ElementStyle::Bay {
            0
        } else {
            [0, 1, 3, 2, 1][k]
        };
        if home == side {
            own.push(*style);
        }
    }
    own
}

/// Gives a style that no piece shows yet to the last piece of the most common style.
fn missing_styles(pieces: &mut [FacadePiece], styles: &[ElementStyle], fixed: &[FixedPiece]) {
    let is_free = |p: &FacadePiece| fixed.iter().all(|f| f.piece != *p);
    let windows = |p: &FacadePiece| p.elements.iter().any(|e| e.style != ElementStyle::Door);
    for style in styles {
        let shows = |p: &FacadePiece, s: ElementStyle| p.elements.iter().any(|e| e.style == s);
        if pieces.iter().any(|p| shows(p, *style)) {
            continue;
        }
        let count = |s: ElementStyle| pieces.iter().filter(|p| shows(p, s)).count();
        let most = styles.iter().copied().max_by_key(|s| count(*s));
        let Some(most) = most.filter(|s| count(*s) > 1) else {
            continue;
        };
        let last = pieces
            .iter_mut()
            .rev()
            .find(|p| windows(p) && shows(p, most) && is_free(p));
        for e in last.into_iter().flat_map(|p| &mut p.elements) {
            if e.style == most {
                e.style = *style;
            }
        }
    }
}

struct SideSearch<'a> {
    building: &'a Building,
    walls: &'a Walls<'a>,
    strips: &'a [Strip],
    /// Window-to-wall ratio, symmetry, alignment.
    wanted: [f64; 3],
    deviations: [f64; 3],
    styles: Vec<ElementStyle>,
    column: usize,
    side: Side,
    cuts: bool,
    /// Observed pieces that stay as they are.
    fixed: &'a [FixedPiece],
    /// Windows beyond the usual number on the sides before this one, then with it.
    beyond: f64,
    evaluations: u64,
}

impl SideSearch<'_> {
    /// The pieces nearest to the wanted attributes, and their distance.
    fn run(&mut self, door: Option<usize>) -> (Vec<FacadePiece>, f64) {
        let total: f64 = self
            .strips
            .iter()
            .map(|s| s.width() * s.rooms.len() as f64)
            .sum();
        let wanted = (1.0 - self.wanted[1]) * total - self.fixed_asymmetric();
        let enough = 0.01 * self.deviations[1] * total;
        // The usual number of windows for the glazed area, evenly on all walls.
        let glazed = self.wanted[0] * total * self.building.floor_height
            - f64::from(u8::from(door.is_some())) * DOOR[0] * DOOR[1];
        let own = usual_count(glazed);
        let usual = (own - self.beyond).clamp(0.5 * own, 2.0 * own);
        let natural = (total / usual).clamp(USUAL[0], USUAL[1]);
        let mut best: Option<(Vec<FacadePiece>, [f64; 3])> = None;
        for (k, spacing) in SPACINGS
            .map(|share| share * natural)
            .into_iter()
            .enumerate()
        {
            if k >= LOOKED && best.as_ref().is_some_and(|b| b.1[0] <= ENOUGH) {
                break;
            }
            let candidates = self.strips.iter().map(|s| self.candidate(s, spacing));
            let candidates: Vec<Candidate> = candidates.collect();
            let choices = choices(&candidates, wanted, enough, self.cuts, CHOICES);
            'near: for choice in &choices {
                let (strips, plans) = self.plans(choice, door);
                for plans in self.alignments(&strips, plans) {
                    let ratio = self.wanted[0];
                    let mut pieces = glaze(self.walls, &strips, &plans, ratio, spacing);
                    self.lead_to_porch(&mut pieces);
                    let (mut z, sum) = self.distance(&pieces);
                    let missing = door.is_some() && !is_entered(&pieces);
                    z += if missing { NO_DOOR } else { 0.0 };
                    // Of layouts that are near enough the one with the most usual number of windows.
                    let off = (windows(&pieces) as f64 - usual).abs();
                    let rank = [z.max(ENOUGH), if z <= ENOUGH { off } else { sum }, z];
                    if best.as_ref().is_none_or(|(_, least)| rank < *least) {
                        best = Some((pieces, rank));
                    }
                    if z <= ENOUGH {
                        break 'near;
                    }
                }
            }
        }
        let (pieces, [_, _, z]) = best.unwrap_or_default();
        self.beyond += windows(&pieces) as f64 - own;
        (pieces, z % NO_DOOR)
    }

    /// Hangs the door of a porch that none leads to, unless what is observed has a door.
    fn lead_to_porch(&self, pieces: &mut [FacadePiece]) {
        let hangs = !has_door(self.fixed);
        if hangs && porch_door(self.building, self.walls, pieces, self.side) {
            shrink(pieces, self.side, self.wanted[0], self.fixed);
        }
    }

    /// Asymmetric width of the fixed pieces.
    fn fixed_asymmetric(&self) -> f64 {
        let rooms = self.strips.iter().flat_map(|s| &s.rooms);
        let fixed: Vec<FacadePiece> = rooms.filter_map(|r| r.fixed.clone()).collect();
        let width: f64 = fixed.iter().map(|p| p.width).sum();
        let symmetric = self.measured(&fixed)[1].unwrap_or(1.0);
        (1.0 - symmetric) * width
    }

    /// Room for windows off the middle.
    fn candidate(&self, strip: &Strip, spacing: f64) -> Candidate {
        let holds = |r: &&super::room::Room| {
            strip.width() >= NARROWEST && holds_asymmetric(self.walls, strip, r, spacing)
        };
        Candidate {
            width: strip.width(),
            height: strip.rooms.iter().filter(holds).count() as f64,
            whole: strip.rooms.iter().any(|r| r.fixed.is_some()),
        }
    }

    /// Strips, one of them cut in two, with what is to stand on each.
    fn plans(&self, choice: &Choice, door: Option<usize>) -> (Vec<Strip>, Vec<Furnishing>) {
        let (mut strips, mut plans) = (Vec::new(), Vec::new());
        let main = self.styles.first().copied().unwrap_or(ElementStyle::Fixed);
        for (k, strip) in self.strips.iter().enumerate() {
            let plan = Furnishing {
                symmetric: !choice.asymmetric[k],
                aligned: true,
                style: main,
                door: door == Some(k),
            };
            match choice.cut {
                Some((cut, width)) if cut == k => {
                    let at = millimetres(strip.start + width);
                    let mut first = strip.clone();
                    first.end = at;
                    let mut rest = strip.clone();
                    rest.start = at;
                    let roomy = rest.width() > first.width();
                    strips.extend([first, rest]);
                    plans.push(Furnishing {
                        door: plan.door && !roomy,
                        ..plan
                    });
                    plans.push(Furnishing {
                        symmetric: true,
                        door: plan.door && roomy,
                        ..plan
                    });
                }
                _ => {
                    strips.push(strip.clone());
                    plans.push(plan);
                }
            }
        }
        // Further styles take the widest strips, one each.
        let mut widest: Vec<usize> = (0..strips.len()).filter(|&k| !plans[k].door).collect();
        widest.sort_by(|&a, &b| strips[b].width().total_cmp(&strips[a].width()));
        for (style, k) in self.styles.iter().skip(1).zip(widest) {
            plans[k].style = *style;
        }
        (strips, plans)
    }

    /// Plans with subsets of the strips of several floors out of line: those with the wanted share of pairs first.
    fn alignments(&self, strips: &[Strip], plans: Vec<Furnishing>) -> Vec<Vec<Furnishing>> {
        let pairs: Vec<(usize, usize)> = strips
            .iter()
            .enumerate()
            .map(|(k, s)| {
                let floors: Vec<usize> = s
                    .rooms
                    .iter()
                    .filter(|r| !r.taken)
                    .map(|r| r.piece.floor)
                    .collect();
                let above = |a: &usize| floors.iter().filter(|b| *b > a).count();
                (k, floors.iter().map(above).sum())
            })
            .filter(|(_, pairs)| *pairs > 0)
            .take(8)
            .collect();
        let total: usize = pairs.iter().map(|p| p.1).sum();
        let mut ranked: Vec<(f64, u32)> = (0..1_u32 << pairs.len())
            .map(|mask| {
                let out: usize = (0..pairs.len())
                    .filter(|k| mask >> k & 1 == 1)
                    .map(|k| pairs[k].1)
                    .sum();
                let share = if total == 0 {
                    0.0
                } else {
                    1.0 - out as f64 / total as f64
                };
                ((share - self.wanted[2]).abs(), mask)
            })
            .collect();
        ranked.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let best = ranked.into_iter().take(2);
        best.map(|(_, mask)| {
            let mut plans = plans.clone();
            for (k, (strip, _)) in pairs.iter().enumerate() {
                plans[*strip].aligned = mask >> k & 1 == 0;
            }
            plans
        })
        .collect()
    }

    /// Largest and summed distance of the side's attributes, measured by the one code of attributes.
    fn distance(&mut self, pieces: &[FacadePiece]) -> (f64, f64) {
        self.evaluations += 1;
        let measured = self.measured(pieces);
        let z = (0..3).map(|k| {
            let value = measured[k].unwrap_or(0.0);
            ((value - self.wanted[k]) / self.deviations[k]).abs()
        });
        z.fold((0.0, 0.0), |(most, sum), z| (z.max(most), sum + z))
    }

    /// Window-to-wall ratio, symmetry and alignment of pieces of this side.
    fn measured(&self, pieces: &[FacadePiece]) -> [Option<f64>; 3] {
        let side = Building {
            name: String::new(),
            unit: String::new(),
            floor_height: self.building.floor_height,
            boxes: Vec::new(),
            facades: pieces.to_vec(),
            special: Vec::new(),
            unobserved: Vec::new(),
        };
        let measured = facade_attributes(&side);
        [0, 1, 2].map(|k| measured[4 * k + self.column])
    }
}
