//! A building as one closed surface with its windows and doors.

use super::clearance::is_clear;
use super::roofs::Joining;
use super::solids::prisms;
use super::walls::{WallPiece, wall_pieces, walls_of_pieces};
use super::windows::{bare, cased, garage_door};
use edifice_shape::solid::exact::{UNIT, units};
use edifice_shape::solid::{
    Faces, Finish, Opening, Prism, Report, Span, Surface, SurfaceError, Wall, faces, integral,
};
use edifice_shape::{BoxStyle, Building, ElementStyle, Side};

/// A house one could print.
#[derive(Debug, Clone, PartialEq)]
pub struct Model {
    /// Its surface.
    pub surface: Surface,
    /// Result of the check of the surface.
    pub report: Report,
    /// Elements that no wall has room for, as facade piece and element: hidden behind a lower roof, over a corner,
    /// or overlapping another.
    pub unplaced: Vec<(usize, usize)>,
    /// Volume taken away by openings less that of bays and casings, and of hollows under eaves that are filled.
    pub openings: f64,
}

/// Least height of the lower edge of a door over what lies before it (m).
const THRESHOLD: f64 = 0.02;
/// Smallest and largest garage door, and room left over it (m).
const GARAGE: [f64; 2] = [2.0, 5.2];
const LINTEL: f64 = 0.25;

/// Builds the surface of a building with all elements that its walls have room for.
///
/// # Errors
/// [`SurfaceError`] when the solids touch in a line only.
pub fn model(building: &Building, joining: Joining) -> Result<Model, SurfaceError> {
    furnished(building, faces(&prisms(building, joining)))
}

/// The same from the faces of the building's prisms, without openings.
///
/// # Errors
/// As [`model`].
pub(super) fn furnished(building: &Building, mut shell: Faces) -> Result<Model, SurfaceError> {
    let mut unplaced = Vec::new();
    let mut openings = 0.0;
    let walls = walls_of_pieces(building);
    for (i, (piece, wall)) in building.facades.iter().zip(&walls).enumerate() {
        for (k, e) in piece.elements.iter().enumerate() {
            let (u, z) = (piece.start + e.x, piece.base + e.y);
            let rect = [[u, u + e.width], [z, z + e.height]];
            let cut = wall.and_then(|w| place(&mut shell, &exact(w.wall()), e.style, rect));
            match cut {
                Some(volume) => openings += volume,
                None => unplaced.push((i, k)),
            }
        }
    }
    if let Some((wall, rect)) = garage_opening(building, &shell) {
        let opening = Opening {
            wall: exact(wall),
            panel: garage_door(rect),
        };
        openings += shell.cut(&opening).unwrap_or(0.0);
    }
    let (surface, hollow) = shell.triangulated()?.filled();
    openings -= hollow;
    let report = surface.check()?;
    Ok(Model {
        surface,
        report,
        unplaced,
        openings,
    })
}

/// Volume that the surface of a building should enclose, by integration over its plan.
pub fn expected_volume(building: &Building, joining: Joining, openings: f64) -> f64 {
    let solids: Vec<Prism> = prisms(building, joining);
    integral::volume(&solids) - openings
}

/// A wall where its faces are, in whole units; what differs by rounding alone is left as it is.
fn exact(wall: Wall) -> Wall {
    let at = units(wall.at) as f64 * UNIT;
    match (at - wall.at).abs() > 1e-9 {
        true => Wall { at, ..wall },
        false => wall,
    }
}

/// Cuts an element into its wall: with a casing where there is room, else without.
fn place(shell: &mut Faces, wall: &Wall, style: ElementStyle, mut rect: Span) -> Option<f64> {
    if style == ElementStyle::Door {
        // A door begins above the ground, a porch's floor or a step.
        let middle = (rect[1][0] + rect[1][1]) / 2.0;
        let free = shell.free_band(wall, rect[0], middle)?;
        rect[1][0] = rect[1][0].max(free[0] + THRESHOLD);
        if rect[1][0] > middle {
            return None;
        }
    }
    // A bay that would reach into the eaves is a window like any other.
    let bay = style == ElementStyle::Bay;
    let style = match bay && !is_clear(shell, wall, &rect, -cased(style, rect).depth) {
        true => ElementStyle::Fixed,
        false => style,
    };
    let mut cut = |panel| {
        let wall = *wall;
        shell.cut(&Opening { wall, panel })
    };
    cut(cased(style, rect)).or_else(|| cut(bare(style, rect)))
}

/// Wall and extent of the garage door: the widest free stretch of a wall of the garage, in front if there is one.
pub(crate) fn garage_opening(building: &Building, shell: &Faces) -> Option<(Wall, Span)> {
    garage_walls(building)
        .into_iter()
        .find_map(|(piece, height)| {
            let wall = piece.wall();
            let width = (piece.end - piece.start - 0.5).min(GARAGE[1]);
            let middle = (piece.start + piece.end) / 2.0;
            let span = [middle - width / 2.0, middle + width / 2.0];
            if width < GARAGE[0] {
                return None;
            }
            let free = shell.free_band(&wall, span, 1.0)?;
            let rect = [
                span,
                [
                    free[0] + THRESHOLD,
                    (height - LINTEL).min(2.2).min(free[1] - 0.05),
                ],
            ];
            (rect[1][1] > 1.8 && shell.around(&wall, &rect).is_some()).then_some((wall, rect))
        })
}

/// Wall pieces of the ground floor that bound the garage, best first, with its height.
pub(crate) fn garage_walls(building: &Building) -> Vec<(WallPiece, f64)> {
    let garages = || {
        building
            .boxes
            .iter()
            .filter(|b| b.style == BoxStyle::Garage)
    };
    let mut found: Vec<(WallPiece, f64)> = Vec::new();
    for piece in wall_pieces(building).into_iter().filter(|p| p.floor == 0) {
        for g in garages() {
            let plan = g.plan();
            let (at, start, end) = match piece.side {
                Side::Front => (plan.y, plan.x, plan.right()),
                Side::Back => (plan.top(), plan.x, plan.right()),
                Side::Left => (plan.x, plan.y, plan.top()),
                Side::Right => (plan.right(), plan.y, plan.top()),
            };
            let near = |a: f64, b: f64| (a - b).abs() < 1e-6;
            if near(piece.at, at) && piece.start >= start - 1e-6 && piece.end <= end + 1e-6 {
                found.push((piece, g.height));
            }
        }
    }
    let rank = |p: &WallPiece| match p.side {
        Side::Front => 0,
        Side::Left | Side::Right => 1,
        Side::Back => 2,
    };
    found.sort_by(|(a, _), (b, _)| {
        let wide = |p: &WallPiece| p.end - p.start;
        rank(a).cmp(&rank(b)).then(wide(b).total_cmp(&wide(a)))
    });
    found
}

/// The finishes that a colour scheme must name.
pub const FINISHES: [Finish; 9] = [
    Finish::Chimney,
    Finish::Wall,
    Finish::Roof,
    Finish::Trim,
    Finish::Deck,
    Finish::Frame,
    Finish::Pane,
    Finish::Door,
    Finish::GarageDoor,
];
