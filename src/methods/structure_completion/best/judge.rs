//! The choice among coherent layouts.
//!
//! With `p_i(t)` the probability that candidate `i` meets a hidden element with an intersection over union of at least `t`,
//! and `E[n]` the expected number of hidden elements, a set `S` has the expected score `2 sum_i p_i / (|S| + E[n])` (the ratio
//! of expectations), where `p_i` is the mean of `p_i(1/2)` and `p_i(3/4)`: an element counts half for being there and half
//! for being exact.
//!
//! Sets are not free: the windows of a layout lie on the lines of one lattice. For each lattice of the pool, candidates on its
//! lines are taken by falling `p_i` as long as the score rises and nothing overlaps; what is chosen is put on shared
//! lines (`regular`), windows that then stand alone on a line are left out, the balconies of each row are made even (`rows`), and
//! windows nearer to another one than the distance that windows keep ([`super::apart`]) are left out. The layout of the highest score
//! is the one of least expected risk among those that were tried.
//!
//! A row with a rhythm of its own ([`super::rhythm`]) is continued in the place of what the lattice has there. Last, a ground floor that
//! is left empty is filled ([`super::ground`]). That does not count for the score: an element of a ground floor is too uncertain to raise
//! the expected F1, but facades without any are rare.
//!
//! Doors are not chosen by their score. A facade that is seen without a door gets at most one, and that is asked beforehand
//! ([`super::doors`]); one that shows a single door gets no other; one that shows several may get more.

use super::apart::Apart;
use super::belong::is_host;
use super::by_place::ByPlace;
use super::candidates::Candidates;
use super::ground::Ground;
use super::observation::{Observation, of};
use super::regular::{clash, regular, without_loners};
use super::rhythm::Continued;
use super::rows;
use crate::completion::Reason;
use crate::layout::lines::numbers;
use crate::layout::{Class, Element};
use edifice_shape::{Axis, Rect};

/// A window is on a line of a lattice when its centre is nearer than this share of the typical extent.
const ON_LINE: f64 = 0.15;
/// Two elements of one class this alike are one.
const SAME: f64 = 0.3;

/// A coherent layout: added elements, each with the candidate that it was or that stands for it, and its score.
#[derive(Debug, Clone)]
pub(super) struct Layout {
    /// Added elements, those of one class by falling probability but for balconies.
    pub added: Vec<(Element, Reason, usize)>,
    /// Expected score without what fills an empty ground floor, 0 to 1.
    pub score: f64,
    /// Columns and rows of its windows and the seen ones, counted as those of an annotation are ([`numbers`]).
    pub numbers: (usize, usize),
}

/// A judge of layouts by the values of their candidates.
pub(super) struct Judge<'a> {
    observation: &'a Observation<'a>,
    candidates: &'a Candidates,
    value: Vec<f64>,
    apart: Apart,
    /// Candidates by falling value.
    order: Vec<usize>,
    /// Least value of a window that is added.
    least: f64,
    /// The door that a facade without one gets.
    door: Option<usize>,
    /// Continuations of rows with a rhythm of their own, and the candidates of their elements.
    own: Vec<(Continued, Vec<usize>)>,
    expected: f64,
}

impl<'a> Judge<'a> {
    /// Judges by the value of each candidate (the mean of its probabilities) and the expected number of hidden elements;
    /// no window of less than `least` is added; `door` is the one that the facade gets, `own` the rows with a rhythm of their own.
    pub(super) fn new(
        observation: &'a Observation<'a>,
        candidates: &'a Candidates,
        value: Vec<f64>,
        least: f64,
        door: Option<usize>,
        own: Vec<(Continued, Vec<usize>)>,
        expected: f64,
    ) -> Self {
        let mut order: Vec<usize> = (0..value.len()).collect();
        // What is set is not chosen.
        order.retain(|c| !own.iter().any(|(_, set)| set.contains(c)));
        order.sort_by(|&a, &b| value[b].total_cmp(&value[a]).then(a.cmp(&b)));
        Self {
            observation,
            candidates,
            value,
            apart: Apart::new(observation),
            order,
            least,
            door,
            own,
            expected,
        }
    }

    /// Expected score of candidates.
    fn score(&self, chosen: impl Iterator<Item = usize>) -> f64 {
        let (mut count, mut sum) = (0.0, 0.0);
        for c in chosen {
            count += 1.0;
            sum += self.value[c];
        }
        2.0 * sum / (count + self.expected.max(sum)).max(1e-12)
    }

    /// The candidates that `allowed` allows, taken greedily.
    fn greedy(&self, allowed: impl Fn(&Element) -> bool) -> Vec<usize> {
        let partial = self.observation.partial;
        let facade = [partial.width, partial.height];
        let mut taken = ByPlace::new(facade, self.observation.size, self.expected as usize);
        // Only a facade that shows several doors gets more than the one that was asked for.
        let several = of(&self.observation.elements, Class::Door).count() > 1;
        let mut chosen: Vec<usize> = Vec::new();
        let (mut sum, mut score) = (0.0, 0.0);
        for c in self.door.into_iter().chain(self.order.iter().copied()) {
            let own = &self.candidates.all[c].element;
            let met = |o: &Element| {
                clash(o, own) || (o.class == own.class && o.rect.iou(&own.rect) > SAME)
            };
            let improbable = own.class == Class::Window && self.value[c] < self.least;
            let second = own.class == Class::Door && self.door != Some(c) && !several;
            if second || improbable || !allowed(own) || taken.any_near(&own.rect, met) {
                continue;
            }
            if own.class == Class::Window && self.is_too_close(&own.rect, &taken) {
                continue;
            }
            let with = sum + self.value[c];
            let next = 2.0 * with / ((chosen.len() + 1) as f64 + self.expected.max(with));
            if next < score {
                break;
            }
            (sum, score) = (with, next);
            chosen.push(c);
            taken.push(*own);
        }
        chosen
    }

    /// True if a window would stand closer to an observed one or to one of these than windows do.
    fn is_too_close(&self, window: &Rect, others: &ByPlace) -> bool {
        let close = |o: &Element| o.class == Class::Window && self.apart.too_close(&o.rect, window);
        let around = self.apart.around(window);
        self.observation.elements.any_near(&around, close) || others.any_near(&around, close)
    }

    /// The coherent layout of some candidates.
    fn coherent(&self, chosen: &[usize]) -> Layout {
        let all = &self.candidates.all;
        let given: Vec<(Element, Reason)> = chosen
            .iter()
            .map(|&c| (all[c].element, all[c].reason))
            .collect();
        let made = regular(self.observation, &given);
        let mut added: Vec<(Element, Reason, usize)> = without_loners(self.observation, made)
            .into_iter()
            .map(|(e, r, k)| (e, r, chosen[k]))
            .collect();
        let score = self.score(added.iter().map(|a| a.2));
        let whole = |added: &[(Element, Reason, usize)]| {
            let whole: Vec<(Element, Reason)> = added.iter().map(|(e, r, _)| (*e, *r)).collect();
            regular(self.observation, &whole)
        };
        let hosts = whole(&added).hosts;
        // A balcony pays where its value is above half of the score.
        if let Some(balconies) = rows::even(self.observation, &hosts, &added, score / 2.0, |b| {
            self.like(b)
        }) {
            added.retain(|(e, ..)| !rows::is_single(self.observation, e));
            added.extend(balconies);
            let kept = whole(&added).added.into_iter();
            added = kept.map(|(e, r, k)| (e, r, added[k].2)).collect();
        }
        self.keep_apart(&mut added);
        self.continue_rows(&mut added);
        self.without_orphans(&mut added);
        let score = self.score(added.iter().map(|a| a.2));
        self.fill_ground(&mut added);
        let seen = &self.observation.partial.observed;
        Layout {
            score,
            numbers: numbers(seen.iter().chain(added.iter().map(|a| &a.0))),
            added,
        }
    }

    /// Puts what rows with a rhythm of their own continue to in the place of what is there, doors aside.
    fn continue_rows(&self, added: &mut Vec<(Element, Reason, usize)>) {
        let doors: Vec<Element> = (added.iter().map(|a| a.0))
            .filter(|e| e.class == Class::Door)
            .collect();
        let set: Vec<(Element, Reason, usize)> = (self.own.iter())
            .flat_map(|(row, candidates)| row.elements.iter().zip(candidates))
            .filter(|(e, _)| !doors.iter().any(|d| clash(d, e)))
            .map(|(e, c)| (*e, Reason::Lattice, *c))
            .collect();
        let stays = |e: &Element| {
            let (x, y) = e.rect.centre();
            let within = self.own.iter().any(|(row, _)| row.band.contains(x, y));
            e.class == Class::Door || !(within || set.iter().any(|(s, ..)| clash(s, e)))
        };
        let wide = |e: &Element| e.class == Class::Balcony && !rows::is_single(self.observation, e);
        added.retain(|(e, ..)| wide(e) || stays(e));
        added.extend(set);
    }

    /// Leaves out windows that shared lines brought too close to observed ones or to those before them.
    fn keep_apart(&self, added: &mut Vec<(Element, Reason, usize)>) {
        let partial = self.observation.partial;
        let facade = [partial.width, partial.height];
        let mut kept = ByPlace::new(facade, self.observation.size, added.len());
        added.retain(|(e, ..)| {
            let stays = e.class != Class::Window || !self.is_too_close(&e.rect, &kept);
            if stays {
                kept.push(*e);
            }
            stays
        });
    }

    /// Adds what stands on a ground floor that is left empty.
    fn fill_ground(&self, added: &mut Vec<(Element, Reason, usize)>) {
        let all = &self.candidates.all;
        let ground = Ground {
            observation: self.observation,
            apart: &self.apart,
        };
        let templates = self.order.iter().map(|&c| (c, &all[c].element));
        ground.fill(added, templates, |e| self.like(e));
    }

    /// The balconies of windows that are gone go with them.
    fn without_orphans(&self, added: &mut Vec<(Element, Reason, usize)>) {
        let is_window = |e: &&Element| e.class == Class::Window;
        let all = self.observation.elements.iter();
        let all = all.chain(added.iter().map(|a| &a.0)).filter(is_window);
        let windows: Vec<Rect> = all.map(|e| e.rect).collect();
        added.retain(|(e, ..)| {
            !rows::is_single(self.observation, e) || windows.iter().any(|w| is_host(w, &e.rect))
        });
    }

    /// The candidate of the highest value that is like an element, and its value.
    fn like(&self, element: &Element) -> Option<(usize, f64)> {
        let near = self.candidates.near(element).into_iter().filter(|&c| {
            let own = &self.candidates.all[c].element;
            own.class == element.class && own.rect.iou(&element.rect) > SAME
        });
        near.map(|c| (c, self.value[c]))
            .reduce(|a, b| if b.1 > a.1 { b } else { a })
    }

    /// The best coherent layout on a lattice with columns and rows at these places.
    pub(super) fn on_lattice(&self, lines: &[Vec<f64>; 2]) -> Layout {
        let near = |axis: Axis, lines: &[f64], at: f64| {
            let reach = ON_LINE * self.observation.extent(axis);
            let k = lines.partition_point(|&x| x < at - reach);
            lines.get(k).is_some_and(|&x| x <= at + reach)
        };
        let seen = Axis::BOTH.map(|axis| -> Vec<f64> {
            self.observation.lines(axis).iter().map(|l| l.at).collect()
        });
        let on = |axis: Axis, at: f64| {
            let k = axis as usize;
            // Windows of a seen line may differ among themselves.
            let reach = 0.35 * self.observation.extent(axis);
            near(axis, &lines[k], at) || seen[k].iter().any(|x| (x - at).abs() < reach)
        };
        let chosen = self.greedy(|e| {
            let (x, y) = e.rect.centre();
            e.class != Class::Window || (on(Axis::X, x) && on(Axis::Y, y))
        });
        self.coherent(&chosen)
    }

    /// The coherent layout of the best candidates of all lattices.
    pub(super) fn freely(&self) -> Layout {
        self.coherent(&self.greedy(|_| true))
    }
}
