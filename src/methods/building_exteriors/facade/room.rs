//! The free places of walls, in which windows can stand.

use crate::house::model::garage_opening;
use crate::house::walls::{WallPiece, wall_pieces};
use edifice_shape::solid::{Faces, Wall};
use edifice_shape::{Building, FacadePiece, Side};

/// Clear wall between a window and a corner, and over and under it (m).
pub(super) const CLEAR: f64 = 0.13;
/// Height of the middle of a window over its floor (m).
pub(super) const EYE: f64 = 1.5;

/// A wall piece of a strip with what it has free.
#[derive(Debug, Clone)]
pub(super) struct Room {
    pub piece: WallPiece,
    /// A garage door or a fixed piece takes this wall.
    pub taken: bool,
    /// The observed piece that stays as it is.
    pub fixed: Option<FacadePiece>,
}

/// An observed facade piece that a house must keep, and the coordinate across of its wall.
#[derive(Debug, Clone, PartialEq)]
pub struct FixedPiece {
    /// The piece.
    pub piece: FacadePiece,
    /// y of a front or back wall, x of a left or right one.
    pub at: f64,
}

/// The wall of all floors between two corners of the outlines of a side.
#[derive(Debug, Clone)]
pub(super) struct Strip {
    pub start: f64,
    pub end: f64,
    /// Pieces from the ground up.
    pub rooms: Vec<Room>,
}

impl Strip {
    pub(super) fn width(&self) -> f64 {
        self.end - self.start
    }
}

/// The walls of a building and their free places.
pub(super) struct Walls<'a> {
    pub shell: &'a Faces,
    pub floor_height: f64,
    /// The strips of each side.
    pub strips: [Vec<Strip>; 4],
}

impl<'a> Walls<'a> {
    pub(super) fn new(building: &Building, shell: &'a Faces, fixed: &[FixedPiece]) -> Self {
        let garage = garage_opening(building, shell);
        let mut strips: [Vec<Strip>; 4] = Default::default();
        for piece in wall_pieces(building) {
            let taken = garage.is_some_and(|(wall, span)| {
                let overlap = span[0][1].min(piece.end) - span[0][0].max(piece.start);
                piece.floor == 0 && same(&wall, &piece.wall()) && overlap > 0.0
            });
            let side = Side::ALL.iter().position(|s| *s == piece.side).unwrap_or(0);
            let room = Room {
                piece,
                taken,
                fixed: None,
            };
            match strips[side].last_mut() {
                Some(last) if last.start == piece.start => last.rooms.push(room),
                _ => strips[side].push(Strip {
                    start: piece.start,
                    end: piece.end,
                    rooms: vec![room],
                }),
            }
        }
        for f in fixed {
            let side = Side::ALL.iter().position(|s| *s == f.piece.side);
            let floor = (f.piece.base / building.floor_height).round() as usize;
            fix(&mut strips[side.unwrap_or(0)], f, floor);
        }
        Self {
            shell,
            floor_height: building.floor_height,
            strips,
        }
    }

    /// Heights over the floor between which a stretch of a piece is bare around eye level.
    pub(super) fn free(&self, room: &Room, span: [f64; 2]) -> Option<[f64; 2]> {
        if room.taken {
            return None;
        }
        let base = room.piece.floor as f64 * self.floor_height;
        let span = [span[0] - CLEAR, span[1] + CLEAR];
        let band = self.shell.free_band(&room.piece.wall(), span, base + EYE)?;
        let ends = [
            band[0].max(base) - base + CLEAR,
            band[1].min(base + self.floor_height) - base - CLEAR,
        ];
        (ends[1] - ends[0] > 0.3).then_some(ends)
    }
}

/// Cuts the strips at the ends of a fixed piece and gives it its wall; the piece stands where it starts, and no other
/// piece stands on the rest of its wall.
fn fix(strips: &mut Vec<Strip>, fixed: &FixedPiece, floor: usize) {
    let (start, end) = (fixed.piece.start, fixed.piece.start + fixed.piece.width);
    for cut in [start, end] {
        let inside = |s: &Strip| s.start + SAME < cut && cut < s.end - SAME;
        if let Some(k) = strips.iter().position(inside) {
            let mut rest = strips[k].clone();
            strips[k].end = cut;
            rest.start = cut;
            strips.insert(k + 1, rest);
        }
    }
    let within = |s: &&mut Strip| s.start > start - SAME && s.end < end + SAME;
    for strip in strips.iter_mut().filter(within) {
        let first = (strip.start - start).abs() < SAME;
        let own = |r: &Room| r.piece.floor == floor && (r.piece.at - fixed.at).abs() < SAME;
        if first {
            for room in strip.rooms.iter_mut().filter(|r| own(r)) {
                (room.taken, room.fixed) = (true, Some(fixed.piece.clone()));
            }
        } else {
            strip.rooms.retain(|r| !own(r));
        }
    }
    strips.retain(|s| !s.rooms.is_empty());
}

/// Places nearer than this are one (m).
const SAME: f64 = 1e-3;

fn same(a: &Wall, b: &Wall) -> bool {
    a.axis == b.axis && a.positive == b.positive && (a.at - b.at).abs() < 1e-6
}
