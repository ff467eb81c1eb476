//! Families of plans: which corners are cut off and where walls step back.
//!
//! A cut corner takes area and leaves the boundary as long as it was; a recess adds twice its depth to it. So the
//! recesses of a family share the depth that the boundary asks for, and all widths grow together until the
//! coverage is met.

use rand::{Rng, RngExt};

use super::site::Site;
use edifice_shape::{Rect, Side};

/// The form of a plan, seen from above.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Family {
    /// One long body, a corner a little set back.
    Bar,
    /// A deep corner cut off at the back.
    L,
    /// Both corners at the back, so that a stem is left.
    T,
    /// A deep recess at the back.
    U,
    /// Recesses at the front and the back.
    H,
    /// Corners at the back and the front.
    Cross,
    /// Opposite corners, so that two blocks stand offset.
    Offset,
    /// Two recesses at the back.
    Comb,
    /// Recesses in the sides.
    Waist,
    /// A corner cut off in two steps.
    Stairs,
}

impl Family {
    /// All of them.
    pub const ALL: [Family; 10] = [
        Family::Bar,
        Family::L,
        Family::T,
        Family::U,
        Family::H,
        Family::Cross,
        Family::Offset,
        Family::Comb,
        Family::Waist,
        Family::Stairs,
    ];

    /// Any of them; those that seldom fit more often.
    pub(super) fn draw(rng: &mut impl Rng) -> Self {
        let mut left = rng.random_range(0..WEIGHTS.iter().sum());
        for (family, weight) in Self::ALL.into_iter().zip(WEIGHTS) {
            if left < weight {
                return family;
            }
            left -= weight;
        }
        Self::L
    }
}

/// Weight of each family among those tried.
const WEIGHTS: [u32; 10] = [10, 3, 4, 2, 5, 9, 4, 12, 2, 2];

/// Corners in the order of [`Site::deepest`].
const BACK_LEFT: usize = 0;
const BACK_RIGHT: usize = 1;
const FRONT_LEFT: usize = 2;
const FRONT_RIGHT: usize = 3;
/// Shallowest and deepest recess, the latter as a share of the house (m).
const SHALLOWEST: f64 = 0.3;
const DEEPEST: f64 = 0.42;
/// Deepest recess of a bar (m).
const LOGGIA: f64 = 1.8;
/// Narrowest recess and corner, and thinnest wing (m).
const NARROWEST: f64 = 1.2;
const WING: f64 = 1.7;
/// Shallowest corner (m).
const CORNER: f64 = 0.8;

/// A corner cut off, `width` along the front in the common scale.
struct Corner {
    which: usize,
    width: f64,
    depth: f64,
    /// Area it takes beyond what others take, by the scale.
    area: f64,
}

/// A stretch of wall that steps back.
struct Recess {
    side: Side,
    width: f64,
    /// Share of the depth of all recesses.
    share: f64,
    /// Place along what is free of the side.
    at: f64,
}

/// The cuts of a plan in the common scale.
struct Cuts {
    corners: Vec<Corner>,
    recesses: Vec<Recess>,
}

impl Family {
    /// The cuts that take `area` and whose recesses are `recess` deep together; `None` where the site has no place.
    pub(super) fn cuts(
        self,
        site: &Site,
        area: f64,
        recess: f64,
        rng: &mut impl Rng,
    ) -> Option<Vec<Rect>> {
        let cuts = self.draw_cuts(site, rng);
        let corners: f64 = cuts.corners.iter().map(|c| c.area).sum();
        let recesses = cuts.recesses.iter().map(|r| r.width * r.share * recess);
        let scale = area / (corners + recesses.sum::<f64>());
        if !(scale > 0.0 && scale.is_finite()) {
            return None;
        }
        let mut free = site.free;
        let mut out = Vec::new();
        for c in &cuts.corners {
            let (width, is_left) = (
                c.width * scale,
                c.which == BACK_LEFT || c.which == FRONT_LEFT,
            );
            let is_back = c.which == BACK_LEFT || c.which == BACK_RIGHT;
            if width < NARROWEST || c.depth > site.deepest[c.which] || c.depth < CORNER {
                return None;
            }
            let x = if is_left { 0.0 } else { site.width - width };
            let y = if is_back { site.depth - c.depth } else { 0.0 };
            let along = &mut free[if is_back { 1 } else { 0 }];
            match is_left {
                true => along[0] = along[0].max(width),
                false => along[1] = along[1].min(x),
            }
            let up = &mut free[if is_left { 2 } else { 3 }];
            match is_back {
                true => up[1] = up[1].min(y),
                false => up[0] = up[0].max(c.depth),
            }
            out.push(Rect::new(x, y, width, c.depth));
        }
        for r in &cuts.recesses {
            let (width, depth) = (r.width * scale, r.share * recess);
            let is_across = matches!(r.side, Side::Left | Side::Right);
            let extent = if is_across { site.width } else { site.depth };
            let most = if self == Family::Bar {
                LOGGIA
            } else {
                DEEPEST * extent
            };
            let [low, high] = free[side_index(r.side)];
            let slack = high - low - 2.0 * WING - width;
            if width < NARROWEST || !(SHALLOWEST..most).contains(&depth) || slack < 0.0 {
                return None;
            }
            let at = low + WING + r.at * slack;
            out.push(match r.side {
                Side::Front => Rect::new(at, 0.0, width, depth),
                Side::Back => Rect::new(at, site.depth - depth, width, depth),
                Side::Left => Rect::new(0.0, at, depth, width),
                Side::Right => Rect::new(site.width - depth, at, depth, width),
            });
        }
        Some(out)
    }

    /// Cuts of the family with depths and proportions drawn at random.
    fn draw_cuts(self, site: &Site, rng: &mut impl Rng) -> Cuts {
        let mut one_of = |sides: &[Side]| sides[rng.random_range(0..sides.len())];
        let anywhere = one_of(&[Side::Back, Side::Right, Side::Front, Side::Left]);
        let lengthwise = one_of(&[Side::Right, Side::Front, Side::Left]);
        let across = one_of(&[Side::Back, Side::Front]);
        let mut within = |low: f64, high: f64| rng.random_range(low..high);
        let deep = site.depth * within(0.27, 0.48);
        let (shallow, at, other) = (within(0.9, 1.8), within(0.2, 0.8), within(0.7, 1.4));
        let front = site.depth * within(0.2, 0.36);
        let is_left = within(0.0, 1.0) < 0.5;
        let (coin, share) = (within(0.0, 1.0) < 0.5, within(0.4, 0.6));
        let one = |which: usize, width: f64, depth: f64| Corner {
            which,
            width,
            depth,
            area: width * depth,
        };
        let back = if is_left { BACK_LEFT } else { BACK_RIGHT };
        let opposite = if is_left { FRONT_RIGHT } else { FRONT_LEFT };
        let wall = |side: Side, width: f64, share: f64| Recess {
            side,
            width,
            share,
            at,
        };
        let pair = |width: f64| {
            [(0.1, share), (0.9, 1.0 - share)].map(|(at, share)| Recess {
                side: Side::Back,
                width,
                share,
                at,
            })
        };
        let (corners, recesses) = match self {
            Family::Bar => (
                vec![one(back, 1.0, shallow)],
                match coin {
                    true => vec![wall(anywhere, 0.4, 1.0)],
                    false => vec![
                        wall(across, 0.4, share),
                        wall(Side::Right, 0.3, 1.0 - share),
                    ],
                },
            ),
            Family::L => (vec![one(back, 1.0, deep)], vec![wall(anywhere, 0.5, 1.0)]),
            Family::T => (
                vec![one(BACK_LEFT, 1.0, deep), one(BACK_RIGHT, other, deep)],
                vec![wall(anywhere, 0.6, 1.0)],
            ),
            Family::U => (
                match coin {
                    true => vec![one(FRONT_RIGHT, 0.4, shallow + 0.4)],
                    false => Vec::new(),
                },
                vec![wall(Side::Back, 1.0, 1.0)],
            ),
            Family::H => (
                Vec::new(),
                vec![
                    wall(Side::Back, 1.0, share),
                    wall(Side::Front, other, 1.0 - share),
                ],
            ),
            Family::Cross => {
                let mut corners = vec![
                    one(BACK_LEFT, 1.0, deep),
                    one(BACK_RIGHT, other, deep),
                    one(FRONT_RIGHT, 0.8, front),
                ];
                if site.deepest[FRONT_LEFT] > 0.0 {
                    corners.push(one(FRONT_LEFT, 0.8, front));
                }
                (corners, vec![wall(across, 0.5, 1.0)])
            }
            Family::Offset => (
                vec![one(back, 1.0, deep), one(opposite, other, front)],
                vec![wall(anywhere, 0.5, 1.0)],
            ),
            Family::Comb => (
                match coin {
                    true => vec![one(FRONT_RIGHT, 0.5, shallow + 0.4)],
                    false => Vec::new(),
                },
                pair(1.0).into(),
            ),
            Family::Waist => (
                match coin {
                    true => Vec::new(),
                    false => vec![one(back, 0.5, shallow)],
                },
                match site.free[2][1] - site.free[2][0] > 6.0 {
                    true => vec![
                        wall(Side::Right, 1.0, share),
                        wall(Side::Left, 1.0, 1.0 - share),
                    ],
                    false => vec![wall(Side::Right, 1.0, 1.0)],
                },
            ),
            Family::Stairs => {
                let outer = one(back, 1.0, 0.5 * deep);
                let inner = Corner {
                    which: back,
                    width: 0.5,
                    depth: 1.07 * deep,
                    area: 0.5 * 0.57 * deep,
                };
                (vec![outer, inner], vec![wall(lengthwise, 0.4, 1.0)])
            }
        };
        Cuts { corners, recesses }
    }
}

fn side_index(side: Side) -> usize {
    match side {
        Side::Front => 0,
        Side::Back => 1,
        Side::Left => 2,
        Side::Right => 3,
    }
}
