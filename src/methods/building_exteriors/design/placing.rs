//! Marked windows and doors on the walls of a house: pieces of facade that stay as they are.

use edifice_shape::{Building, ElementStyle, FacadeElement, FacadePiece, Rect, Side};

use super::left_out::{LeftOut, SILL};
use super::marked::{Mark, NARROWEST_DOOR};
use super::storeys::Storeys;
use crate::facade::FixedPiece;
use crate::house::walls::{WallPiece, wall_pieces};

/// Lowest door, and the least size of a window (m).
const LOWEST_DOOR: f64 = 1.6;
const SMALLEST: f64 = 0.1;
/// Places nearer than this are one (m).
const SAME: f64 = 1e-3;

/// A place for each mark: the wall that it stands on, or why it has none.
#[derive(Clone)]
pub(super) struct Places<'a> {
    marks: &'a [Mark],
    storeys: &'a Storeys,
    /// For each mark the index of its piece, or why it is left out.
    pub of: Vec<Result<usize, LeftOut>>,
    /// The pieces of the sides, without elements, and the coordinate across of their walls.
    pieces: Vec<FixedPiece>,
}

impl<'a> Places<'a> {
    /// Puts the marks on the foremost walls of their sides. `building` has walls up to the eaves everywhere.
    pub(super) fn new(marks: &'a [Mark], building: &Building, storeys: &'a Storeys) -> Self {
        let (mut of, mut pieces) = (Vec::with_capacity(marks.len()), Vec::new());
        // Of each mark that has a wall: its side, storey and walls, the first and the last one.
        let mut spans: Vec<Option<(Side, usize, [usize; 2])>> = Vec::new();
        let all = wall_pieces(building);
        let walls = Side::ALL.map(|side| foremost(&all, side));
        let own = |side: Side| &walls[Side::ALL.iter().position(|s| *s == side).unwrap_or(0)];
        for (k, mark) in marks.iter().enumerate() {
            let found = check(mark, storeys, &marks[..k], &of).and_then(|storey| {
                let span = span(own(mark.side), mark.rect).ok_or(LeftOut::Corner {
                    from: mark.rect.x,
                    to: mark.rect.right(),
                })?;
                Ok((mark.side, storey, span))
            });
            spans.push(found.clone().ok());
            of.push(found.map(|_| 0));
        }
        for side in Side::ALL
            .into_iter()
            .filter(|s| marks.iter().any(|m| m.side == *s))
        {
            for storey in 0..storeys.lines.len() {
                let here: Vec<[usize; 2]> = spans
                    .iter()
                    .flatten()
                    .filter(|s| s.0 == side && s.1 == storey)
                    .map(|s| s.2)
                    .collect();
                let mut first = 0;
                let walls = own(side);
                while first < walls.len() {
                    // Walls in one plane that some mark joins are one piece.
                    let mut last = first;
                    while let Some(next) = here.iter().find(|s| s[0] <= last && last < s[1]) {
                        last = next[1];
                    }
                    for (mark, span) in of.iter_mut().zip(&spans) {
                        let is_own = |s: &(Side, usize, [usize; 2])| {
                            s.0 == side && s.1 == storey && (first..=last).contains(&s.2[0])
                        };
                        if let (Ok(piece), Some(true)) = (mark, span.as_ref().map(is_own)) {
                            *piece = pieces.len();
                        }
                    }
                    pieces.push(piece(&walls[first], &walls[last], storeys, storey));
                    if first < last {
                        let behind = hidden(&all, &walls[first..=last]);
                        pieces.extend(behind.map(|w| piece(w, w, storeys, storey)));
                    }
                    first = last + 1;
                }
            }
        }
        let mut places = Self {
            marks,
            storeys,
            of,
            pieces,
        };
        places.raise();
        places
    }

    /// Lets pieces reach as high as their marks.
    fn raise(&mut self) {
        for (mark, place) in self.marks.iter().zip(&self.of) {
            if let Ok(piece) = place {
                let piece = &mut self.pieces[*piece].piece;
                piece.height = piece.height.max(mark.rect.top() - piece.base);
            }
        }
    }

    /// The pieces with the marks that have a place, windows without a style of their own in the given one.
    pub(super) fn fixed(&self, style: ElementStyle) -> Vec<FixedPiece> {
        let mut pieces = self.pieces.clone();
        for (mark, place) in self.marks.iter().zip(&self.of) {
            if let Ok(index) = place {
                let piece = &mut pieces[*index].piece;
                piece.elements.push(FacadeElement {
                    style: mark.style.unwrap_or(style),
                    x: micrometres(mark.rect.x - piece.start),
                    y: micrometres(mark.rect.y - piece.base),
                    width: mark.rect.width,
                    height: mark.rect.height,
                });
            }
        }
        pieces
    }

    /// True if a mark with a place has this style of its own.
    pub(super) fn shows(&self, style: ElementStyle) -> bool {
        self.placed().any(|m| m.style == Some(style))
    }

    /// True if a mark with a place is a window of any style.
    pub(super) fn is_plain(&self) -> bool {
        self.placed().any(|m| m.style.is_none())
    }

    fn placed(&self) -> impl Iterator<Item = &Mark> {
        let known = self.marks.iter().zip(&self.of);
        known.filter(|(_, place)| place.is_ok()).map(|(m, _)| m)
    }

    /// The storeys of the house.
    pub(super) fn storeys(&self) -> &Storeys {
        self.storeys
    }
}

/// A difference of numbers without the noise of its last digits.
fn micrometres(v: f64) -> f64 {
    (v * 1e6).round() / 1e6
}

/// The storey of a mark, if it has the size and place of a window or a door.
fn check(
    mark: &Mark,
    storeys: &Storeys,
    before: &[Mark],
    of: &[Result<usize, LeftOut>],
) -> Result<usize, LeftOut> {
    let r = mark.rect;
    let (what, least) = match mark.is_door() {
        true => ("door", [NARROWEST_DOOR, LOWEST_DOOR]),
        false => ("window", [SMALLEST; 2]),
    };
    if r.width < least[0] - SAME || r.height < least[1] - SAME {
        let (width, height) = (r.width, r.height);
        return Err(LeftOut::Small {
            what,
            width,
            height,
        });
    }
    if !storeys.holds(mark) {
        return Err(LeftOut::Storey {
            from: r.y,
            to: r.top(),
            storey: storeys.height,
            eaves: storeys.eaves,
        });
    }
    let storey = storeys.at(r.y);
    let sill = r.y - storeys.lines[storey];
    if mark.is_door() && sill > SILL {
        return Err(LeftOut::Sill { sill });
    }
    let meets = |m: &Mark| {
        let x = m.rect.right().min(r.right()) - m.rect.x.max(r.x);
        let y = m.rect.top().min(r.top()) - m.rect.y.max(r.y);
        m.side == mark.side && x.min(y) > SAME
    };
    let mut known = before.iter().zip(of).filter(|(_, place)| place.is_ok());
    match known.find(|(m, _)| meets(m)) {
        Some((other, _)) => Err(LeftOut::Overlaps {
            other: other.regions[0],
        }),
        None => Ok(storey),
    }
}

/// The walls of the ground floor of a side that no other hides, in order along the side.
fn foremost(all: &[WallPiece], side: Side) -> Vec<WallPiece> {
    let outer = |a: &WallPiece, b: &WallPiece| match side {
        Side::Front | Side::Left => a.at < b.at,
        Side::Back | Side::Right => a.at > b.at,
    };
    let own = || all.iter().filter(|w| w.side == side && w.floor == 0);
    let seen = |w: &&WallPiece| !own().any(|o| o.start == w.start && outer(o, w));
    let mut walls: Vec<WallPiece> = own().filter(seen).copied().collect();
    walls.sort_by(|a, b| a.start.total_cmp(&b.start));
    walls
}

/// The walls of the ground floor behind these. Pieces are told apart by where they start, so that behind a joined one none may have windows.
fn hidden<'a>(all: &'a [WallPiece], walls: &'a [WallPiece]) -> impl Iterator<Item = &'a WallPiece> {
    let side = walls.first().map(|w| w.side);
    let behind = |w: &&WallPiece| {
        let own = walls.iter().find(|o| o.start == w.start);
        own.is_some_and(|o| o.at != w.at)
    };
    let ground = all.iter().filter(|w| w.floor == 0);
    ground.filter(move |w| Some(w.side) == side).filter(behind)
}

/// The first and the last of neighbouring walls in one plane that a rectangle stands on.
fn span(walls: &[WallPiece], r: Rect) -> Option<[usize; 2]> {
    let first = walls
        .iter()
        .position(|w| w.start - SAME <= r.x && r.x < w.end)?;
    let mut last = first;
    while walls[last].end + SAME < r.right() {
        let (own, next) = (&walls[last], walls.get(last + 1)?);
        if (own.at - next.at).abs() > SAME || (own.end - next.start).abs() > SAME {
            return None;
        }
        last += 1;
    }
    Some([first, last])
}

fn piece(first: &WallPiece, last: &WallPiece, storeys: &Storeys, storey: usize) -> FixedPiece {
    let base = storeys.lines[storey];
    FixedPiece {
        piece: FacadePiece {
            side: first.side,
            start: first.start,
            base,
            width: last.end - first.start,
            height: storeys.top(storey) - base,
            elements: Vec::new(),
        },
        at: first.at,
    }
}
