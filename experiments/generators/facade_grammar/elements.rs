//! Windows, doors, shops, dormers: the smallest named parts.

use rand::RngExt;

use super::draft::{Draft, Part, leaf};
use edifice_base::rng::Stream;

/// The division of a window.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Glazing {
    /// One terminal.
    Plain,
    /// A frame around two panes.
    Casement,
    /// Two panes and two smaller ones above.
    Transom,
    /// An upper and a lower pane.
    Sash,
    /// A window between shutters.
    Shutters,
    /// Two by three panes between bars.
    Lattice,
}

/// A kind of window with its surroundings.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Kind {
    glazing: Glazing,
    height: u32,
    trim: u32,
    sill: u32,
    lintel: u32,
    balcony: bool,
}

/// Sizes that a whole facade shares, in centimetres.
#[derive(Debug, Clone)]
pub(crate) struct Style {
    /// Height of a floor.
    pub floor: u32,
    /// Wall between two columns.
    pub gap: u32,
    /// Width of a window column with its trim.
    pub column: u32,
    /// Height of cornices between floors; 0 for none.
    pub cornice: u32,
    frame: u32,
    below: u32,
    kinds: Vec<Kind>,
}

/// A window that is not what the rhythm asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Break {
    /// No window.
    Blank,
    /// Bricked up: another label.
    Blind,
    /// A little narrower.
    Narrow,
    /// A little lower.
    Low,
}

impl Style {
    /// Draws the sizes of a facade with these windows.
    pub(crate) fn draw(rng: &mut Stream, glazing: &[Glazing]) -> Self {
        let five = |rng: &mut Stream, low: u32, high: u32| 5 * rng.random_range(low..=high);
        let column = five(rng, 22, 28);
        let below = five(rng, 13, 18);
        let floor = five(rng, 62, 74);
        let mut kinds = Vec::new();
        for (i, &glazing) in glazing.iter().enumerate() {
            kinds.push(Kind {
                glazing,
                height: five(rng, 30, 36),
                trim: if i % 2 == 0 { five(rng, 0, 2) } else { 10 },
                sill: if rng.random_bool(0.7) { 10 } else { 0 },
                lintel: if i % 2 == 1 { 20 } else { five(rng, 0, 2) },
                balcony: false,
            });
        }
        Self {
            floor,
            gap: five(rng, 12, 22),
            column,
            cornice: if rng.random_bool(0.7) {
                five(rng, 3, 5)
            } else {
                0
            },
            frame: 5,
            below,
            kinds,
        }
    }

    /// Number of kinds of windows.
    pub(crate) fn kinds(&self) -> usize {
        self.kinds.len()
    }

    /// Gives every second kind a balcony.
    pub(crate) fn with_balconies(mut self) -> Self {
        for kind in self.kinds.iter_mut().skip(1).step_by(2) {
            kind.balcony = true;
        }
        if let [only] = self.kinds.as_slice() {
            let balcony = Kind {
                balcony: true,
                ..*only
            };
            self.kinds.push(balcony);
        }
        self
    }

    /// A column of the wall, `height` high, with a window of kind `k` in it.
    pub(crate) fn column(
        &self,
        draft: &mut Draft,
        k: usize,
        height: u32,
        change: Option<Break>,
    ) -> Part {
        let kind = self.kinds[k % self.kinds.len()];
        if change == Some(Break::Blank) {
            return leaf("wall", self.column, height);
        }
        let lower = if change == Some(Break::Low) { 20 } else { 0 };
        let cut = if change == Some(Break::Narrow) { 10 } else { 0 };
        let spare = height.saturating_sub(60);
        let balcony = if kind.balcony { 30 } else { 0 };
        let below = if kind.balcony {
            10
        } else {
            self.below.min(spare / 4)
        };
        let tall = (kind.height + if kind.balcony { 20 } else { 0 } - lower)
            .min(spare.saturating_sub(below + balcony + kind.sill + kind.lintel));
        let inner = self.column - 2 * kind.trim - 2 * cut;
        let glazing = match change {
            Some(Break::Blind) => leaf("blind", inner, tall),
            _ => self.glazing(draft, kind.glazing, inner, tall),
        };
        let trim = |side| leaf(if cut > 0 { "wall" } else { "trim" }, side, tall);
        let window = draft.row(
            "Window",
            vec![trim(kind.trim + cut), glazing, trim(kind.trim + cut)],
        );
        let sill = if kind.balcony { 0 } else { kind.sill };
        let above = height - below - balcony - sill - tall - kind.lintel;
        draft.stack(
            "Column",
            vec![
                leaf("wall", self.column, below),
                leaf("balcony", self.column, balcony),
                leaf("sill", self.column, sill),
                window,
                leaf("lintel", self.column, kind.lintel),
                leaf("wall", self.column, above),
            ],
        )
    }

    /// The window proper.
    pub(crate) fn glazing(
        &self,
        draft: &mut Draft,
        glazing: Glazing,
        width: u32,
        height: u32,
    ) -> Part {
        let f = self.frame;
        let panes = |draft: &mut Draft, high: u32| {
            let pane = (width - 3 * f) / 2;
            let rest = width - 3 * f - 2 * pane;
            draft.row(
                "Panes",
                vec![
                    leaf("frame", f, high),
                    leaf("glass", pane, high),
                    leaf("frame", f + rest, high),
                    leaf("glass", pane, high),
                    leaf("frame", f, high),
                ],
            )
        };
        let bar = || leaf("frame", width, f);
        match glazing {
            Glazing::Plain => leaf("window", width, height),
            Glazing::Casement => {
                let panes = panes(draft, height - 2 * f);
                draft.stack("Casement", vec![bar(), panes, bar()])
            }
            Glazing::Transom => {
                let light = 35.min(height / 4);
                let lower = panes(draft, height - light - 3 * f);
                let upper = panes(draft, light);
                draft.stack("Transom", vec![bar(), lower, bar(), upper, bar()])
            }
            Glazing::Sash => {
                let half = (height - 3 * f) / 2;
                let pane = |draft: &mut Draft, high: u32| {
                    let side = leaf("frame", f, high);
                    let glass = leaf("glass", width - 2 * f, high);
                    draft.row("Pane", vec![side.clone(), glass, side])
                };
                let lower = pane(draft, height - 3 * f - half);
                let upper = pane(draft, half);
                draft.stack("Sash", vec![bar(), lower, bar(), upper, bar()])
            }
            Glazing::Shutters => {
                let wing = width / 4;
                let shutter = leaf("shutter", wing, height);
                let middle = leaf("window", width - 2 * wing, height);
                draft.row("Shutters", vec![shutter.clone(), middle, shutter])
            }
            Glazing::Lattice => {
                let light = (height - 2 * f) / 3;
                let pane = (width - f) / 2;
                let mut light_row = |high: u32| {
                    draft.row(
                        "Lights",
                        vec![
                            leaf("glass", pane, high),
                            leaf("frame", width - 2 * pane, high),
                            leaf("glass", pane, high),
                        ],
                    )
                };
                let lower = light_row(height - 2 * f - 2 * light);
                let upper = light_row(light);
                draft.stack("Lattice", vec![lower, bar(), upper.clone(), bar(), upper])
            }
        }
    }
}

/// A door with its light, `width` by `height`.
pub(crate) fn door(draft: &mut Draft, width: u32, height: u32) -> Part {
    let leaves = (height * 2 / 3).max(60).min(height - 30);
    let wing = leaf("door", (width - 30) / 2, leaves);
    let jamb = leaf("trim", 10, leaves);
    let middle = leaf("trim", width - 20 - 2 * wing.width, leaves);
    let doors = draft.row(
        "Doors",
        vec![jamb.clone(), wing.clone(), middle, wing, jamb],
    );
    draft.stack(
        "Entrance",
        vec![
            doors,
            leaf("trim", width, 10),
            leaf("window", width, 20.min(height - leaves - 10)),
            leaf("wall", width, (height - leaves - 10).saturating_sub(20)),
        ],
    )
}

/// A shop: base, panes between mullions, sign, awning.
pub(crate) fn shop(draft: &mut Draft, width: u32, height: u32, panes: u32, awning: bool) -> Part {
    let (base, sign, shade) = (40, 45, if awning { 30 } else { 0 });
    let glass = height - base - sign - shade;
    let panes = panes.max(1);
    let pane = (width - 10 * (panes + 1)) / panes;
    let rest = width - 10 * (panes + 1) - panes * pane;
    let mut front = vec![leaf("frame", 10, glass)];
    for i in 0..panes {
        front.push(leaf(
            "shop",
            pane + if i + 1 == panes { rest } else { 0 },
            glass,
        ));
        front.push(leaf("frame", 10, glass));
    }
    let front = draft.row("Front", front);
    draft.stack(
        "Shop",
        vec![
            leaf("base", width, base),
            front,
            leaf("awning", width, shade),
            leaf("sign", width, sign),
        ],
    )
}

/// A pilaster with base and capital.
pub(crate) fn pilaster(draft: &mut Draft, width: u32, height: u32) -> Part {
    draft.stack(
        "Pilaster",
        vec![
            leaf("base", width, 25),
            leaf("pilaster", width, height - 50),
            leaf("capital", width, 25),
        ],
    )
}

/// A dormer: cheeks, a window, a small roof.
pub(crate) fn dormer(
    draft: &mut Draft,
    style: &Style,
    glazing: Glazing,
    width: u32,
    height: u32,
) -> Part {
    let glass = style.glazing(draft, glazing, width - 30, height * 3 / 5);
    let cheek = leaf("dormer", 15, glass.height);
    let middle = draft.row("DormerWindow", vec![cheek.clone(), glass, cheek]);
    let (foot, cap) = (height / 8, 20);
    draft.stack(
        "Dormer",
        vec![
            leaf("roof", width, foot),
            middle.clone(),
            leaf("dormer", width, cap),
            leaf("roof", width, height - foot - cap - middle.height),
        ],
    )
}
