//! Learning the weights (Sec. 4.4): contrastive divergence through [`log_linear`](edifice_model::log_linear).
//!
//! The states of a facade are finite, so that the model is a proper distribution: each element of the
//! layout, and as many spurious ones as a fifth of them at random places, is a *site* that is present or
//! not, in one of 5 x 5 offsets (tenths of its size), three sizes and four classes. In the data, the
//! elements are present with no offset, and the spurious ones absent.
//!
//! The unbiased sampler takes a block of a tenth of the sites and resamples its attributes one by one
//! given all else, by Metropolis with uniform proposals, which leaves `p(x; w)` invariant.

use std::borrow::Cow;

use rand::RngExt;
use rand::seq::SliceRandom;

use super::{Change, ScoreModel, Scored, TERMS};
use crate::layout::{Class, Element, Layout};
use edifice_base::Watch;
use edifice_base::rng::Stream;
use edifice_model::ModelError;
use edifice_model::factor_graph::Settings;
use edifice_model::log_linear::LogLinear;
use edifice_shape::Rect;

/// Offsets along each axis, in tenths of the size.
const OFFSETS: [f64; 5] = [0.0, -0.2, -0.1, 0.1, 0.2];
/// Sizes relative to the data's.
const SIZES: [f64; 3] = [1.0, 0.7, 1.4];
/// Number of values of each attribute: offset along x and y, size, shift of the class.
const VALUES: [u8; 4] = [
    OFFSETS.len() as u8,
    OFFSETS.len() as u8,
    SIZES.len() as u8,
    4,
];
/// Share of spurious sites, and of the sites in a block.
const SPURIOUS: f64 = 0.2;
const BLOCK: f64 = 0.1;

/// A place where an element may be.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Site {
    data: Element,
    present: bool,
    /// Index of the offset along x, along y, of the size and of the class's shift.
    attributes: [u8; 4],
}

/// A layout as a state of the model.
#[derive(Debug, Clone, PartialEq)]
pub struct Sites {
    facade: [f64; 2],
    sites: Vec<Site>,
}

/// A layout that weights are learnt from.
pub trait State: Clone + Send + Sync {
    /// Extent of the facade.
    fn facade(&self) -> [f64; 2];
    /// Its elements.
    fn elements(&self) -> Cow<'_, [Element]>;
}

impl State for Layout {
    fn facade(&self) -> [f64; 2] {
        [self.width, self.height]
    }
    fn elements(&self) -> Cow<'_, [Element]> {
        Cow::Borrowed(&self.elements)
    }
}

impl State for Sites {
    fn facade(&self) -> [f64; 2] {
        self.facade
    }
    fn elements(&self) -> Cow<'_, [Element]> {
        let present = self.sites.iter().filter(|s| s.present);
        Cow::Owned(present.map(|s| s.element(self.facade)).collect())
    }
}

impl Site {
    fn element(&self, facade: [f64; 2]) -> Element {
        let r = self.data.rect;
        let [dx, dy, size, shift] = self.attributes.map(usize::from);
        let (width, height) = (r.width * SIZES[size], r.height * SIZES[size]);
        let (x, y) = r.centre();
        let x = x + OFFSETS[dx] * r.width - width / 2.0;
        let y = y + OFFSETS[dy] * r.height - height / 2.0;
        let x = x.clamp(0.0, (facade[0] - width).max(0.0));
        let y = y.clamp(0.0, (facade[1] - height).max(0.0));
        let class = Class::ALL[(self.data.class.index() + shift) % 4];
        match self.attributes[..3] {
            // As it is, without rounding.
            [0, 0, 0] => Element::new(class, r),
            _ => Element::new(class, Rect::new(x, y, width, height)),
        }
    }
}

impl Sites {
    /// The state that a whole layout is, with its spurious sites.
    pub fn of_layout(layout: &Layout, rng: &mut Stream) -> Self {
        let site = |data: Element, present| Site {
            data,
            present,
            attributes: [0; 4],
        };
        let mut sites: Vec<Site> = layout.elements.iter().map(|e| site(*e, true)).collect();
        let count = (SPURIOUS * sites.len() as f64).ceil() as usize;
        for _ in 0..count.min(sites.len() * layout.elements.len()) {
            let mut data = layout.elements[rng.random_range(0..layout.elements.len())];
            let r = &mut data.rect;
            r.x = rng.random::<f64>() * (layout.width - r.width).max(0.0);
            r.y = rng.random::<f64>() * (layout.height - r.height).max(0.0);
            sites.push(site(data, false));
        }
        Self {
            facade: [layout.width, layout.height],
            sites,
        }
    }

    /// A draw of `p(x; w)` on the sites, as far as `sweeps` of the chain forget where it began: in a state in which
    /// every attribute is random.
    pub fn draw(
        &self,
        model: &ScoreModel,
        weights: &[f64; TERMS],
        sweeps: usize,
        rng: &mut Stream,
    ) -> Self {
        let mut drawn = self.clone();
        for site in &mut drawn.sites {
            site.present = rng.random();
            site.attributes = VALUES.map(|n| rng.random_range(0..n));
        }
        let all: Vec<usize> = (0..drawn.sites.len()).collect();
        drawn.resample(&all, model, weights, sweeps, rng);
        drawn
    }

    /// All layouts of the sites, each with the logarithm of the number of states that it stands for: as the attributes of an
    /// absent element do not show. There are 301 for each site.
    pub fn states(&self) -> Vec<(f64, Vec<Element>)> {
        let hidden = f64::from(VALUES.iter().map(|&n| u32::from(n)).product::<u32>()).ln();
        let mut all = vec![(0.0, Vec::new())];
        for site in &self.sites {
            let mut ways = vec![(hidden, None)];
            for code in 0..VALUES.iter().map(|&n| usize::from(n)).product::<usize>() {
                let mut rest = code;
                let attributes = VALUES.map(|n| {
                    let value = rest % usize::from(n);
                    rest /= usize::from(n);
                    value as u8
                });
                let present = Site {
                    attributes,
                    present: true,
                    ..*site
                };
                ways.push((0.0, Some(present.element(self.facade))));
            }
            all = all
                .iter()
                .flat_map(|(log, elements): &(f64, Vec<Element>)| {
                    ways.iter().map(move |(own, element)| {
                        let mut elements = elements.clone();
                        elements.extend(*element);
                        (log + own, elements)
                    })
                })
                .collect();
        }
        all
    }

    /// The layout that the state is.
    pub fn layout(&self, name: String) -> Layout {
        Layout {
            name,
            width: self.facade[0],
            height: self.facade[1],
            elements: self.elements().into_owned(),
        }
    }

    /// Resamples a block of a tenth of the sites given the rest, `sweeps` times each attribute.
    pub fn resample_block(
        &mut self,
        model: &ScoreModel,
        weights: &[f64; TERMS],
        sweeps: usize,
        rng: &mut Stream,
    ) {
        let mut order: Vec<usize> = (0..self.sites.len()).collect();
        order.shuffle(rng);
        order.truncate((BLOCK * order.len() as f64).ceil() as usize);
        self.resample(&order, model, weights, sweeps, rng);
    }

    /// Resamples each attribute of some sites given all else, `sweeps` times.
    fn resample(
        &mut self,
        order: &[usize],
        model: &ScoreModel,
        weights: &[f64; TERMS],
        sweeps: usize,
        rng: &mut Stream,
    ) {
        // Index of each site's element in the layout that is scored, and back.
        let mut of_element: Vec<usize> = (0..self.sites.len())
            .filter(|&s| self.sites[s].present)
            .collect();
        let mut index = vec![0; self.sites.len()];
        for (i, &site) in of_element.iter().enumerate() {
            index[site] = i;
        }
        let mut scored =
            Scored::weighted(model, *weights, self.facade, self.elements().into_owned());
        for _ in 0..sweeps {
            for &at in order {
                for attribute in 0..5 {
                    let old = self.sites[at];
                    let site = &mut self.sites[at];
                    match attribute {
                        4 => site.present = !site.present,
                        a => site.attributes[a] = rng.random_range(0..VALUES[a]),
                    }
                    let before = scored.score();
                    let new = self.sites[at];
                    let after = match (old.present, new.present) {
                        // The same value was proposed.
                        _ if new == old => before,
                        (false, false) => before,
                        (true, true) => {
                            scored.apply(Change::Set(index[at], new.element(self.facade)))
                        }
                        (false, true) => scored.apply(Change::Add(new.element(self.facade))),
                        (true, false) => scored.apply(Change::Remove(index[at])),
                    };
                    if rng.random::<f64>().ln() >= after - before {
                        if (old.present || new.present) && new != old {
                            scored.undo();
                        }
                        self.sites[at] = old;
                    } else if new.present && !old.present {
                        index[at] = of_element.len();
                        of_element.push(at);
                    } else if old.present && !new.present {
                        of_element.swap_remove(index[at]);
                        if let Some(&moved) = of_element.get(index[at]) {
                            index[moved] = index[at];
                        }
                    }
                }
            }
        }
    }
}

/// Weights from their differences to 1.
pub(crate) fn from_prior(differences: &[f64]) -> [f64; TERMS] {
    // A weight at its least value is 0 but for rounding.
    std::array::from_fn(|k| (1.0 + differences[k]).max(0.0))
}

/// Learns the weights of `model` from layouts; `sampler` changes a layout into its negative, given the weights. One that
/// leaves `p(x; w)` invariant, as [`Sites::resample_block`] does, makes the update unbiased. The penalty of `settings`
/// draws each weight to 1, at which the score is the sum of the log densities. None becomes less than 0: what is probable in the
/// database never speaks against a layout.
///
/// # Errors
/// As [`fit`](edifice_model::factor_graph::fit).
pub fn learn_weights<X: State>(
    model: &ScoreModel,
    data: &[X],
    sampler: impl Fn(&mut X, &[f64; TERMS], &mut Stream) + Sync,
    settings: &Settings,
    seed: u64,
    watch: &Watch,
) -> Result<[f64; TERMS], ModelError> {
    let features = |x: &X| model.evaluate(x.facade(), &x.elements()).features.to_vec();
    let step = |x: &mut X, weights: &[f64], rng: &mut Stream| {
        sampler(x, &from_prior(weights), rng);
    };
    let fitted = LogLinear::new(TERMS, features, step)
        .at_least(-1.0)
        .fit(data, settings, seed, watch)?;
    Ok(from_prior(&fitted.weights))
}
