//! A layout with its score, changed one element at a time.
//!
//! A change groups the elements of its class (or classes) anew; grids with the same members as before that do not
//! hold the changed element keep what is known of them, and so do pairs of such grids.

use std::sync::Arc;

use super::grid::{Grid, clusters};
use super::{Evaluation, ScoreModel, TERMS, dot};
use crate::layout::{Class, Element};

/// A change of one element.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Change {
    /// Adds an element.
    Add(Element),
    /// Takes the element of this index away; the last element gets its index.
    Remove(usize),
    /// Puts another element in the place of this index.
    Set(usize, Element),
}

/// A layout and its evaluation.
#[derive(Debug, Clone)]
pub struct Scored<'a> {
    model: &'a ScoreModel,
    weights: [f64; TERMS],
    facade: [f64; 2],
    elements: Vec<Element>,
    now: Evaluation,
    score: f64,
    /// The elements, the evaluation and the score before the last change.
    before: Option<(Undo, Evaluation, f64)>,
}

/// The inverse of the last change of the elements.
#[derive(Debug, Clone, Copy)]
enum Undo {
    /// Removes the last element.
    Pop,
    /// Puts an element to its index.
    Put(usize, Element),
    /// Puts an element to its index, and what is there to the end.
    Insert(usize, Element),
}

impl<'a> Scored<'a> {
    /// Evaluates a layout.
    pub fn new(model: &'a ScoreModel, facade: [f64; 2], elements: Vec<Element>) -> Self {
        Self::weighted(model, model.weights, facade, elements)
    }

    /// Evaluates a layout with other weights than the model's.
    pub fn weighted(
        model: &'a ScoreModel,
        weights: [f64; TERMS],
        facade: [f64; 2],
        elements: Vec<Element>,
    ) -> Self {
        let now = model.evaluate(facade, &elements);
        let score = dot(&weights, &now.features);
        Self {
            model,
            weights,
            facade,
            elements,
            now,
            score,
            before: None,
        }
    }

    /// The elements.
    pub fn elements(&self) -> &[Element] {
        &self.elements
    }

    /// The features f.
    pub fn features(&self) -> &[f64; TERMS] {
        &self.now.features
    }

    /// The score `w · f`.
    pub fn score(&self) -> f64 {
        self.score
    }

    /// The evaluation of the layout.
    pub fn evaluation(&self) -> &Evaluation {
        &self.now
    }

    /// Changes an element and returns the new score. An index beyond the last element changes nothing.
    pub fn apply(&mut self, change: Change) -> f64 {
        let Some((undo, classes, touched)) = self.change_elements(change) else {
            self.before = None;
            return self.score;
        };
        let now = self.regroup(classes, touched);
        let before = std::mem::replace(&mut self.now, now);
        self.before = Some((undo, before, self.score));
        self.score = dot(&self.weights, &self.now.features);
        self.score
    }

    /// Takes the last change back; once.
    pub fn undo(&mut self) {
        if let Some((undo, evaluation, score)) = self.before.take() {
            match undo {
                Undo::Pop => {
                    self.elements.pop();
                }
                Undo::Put(index, element) => self.elements[index] = element,
                Undo::Insert(index, element) => {
                    self.elements.push(element);
                    let last = self.elements.len() - 1;
                    self.elements.swap(index, last);
                }
            }
            self.now = evaluation;
            self.score = score;
        }
    }

    /// Applies a change to the elements only: what undoes it, the classes whose grids may differ, and
    /// the indices that now hold another element or none.
    fn change_elements(&mut self, change: Change) -> Option<(Undo, [Class; 2], [u32; 2])> {
        let count = self.elements.len() as u32;
        match change {
            Change::Add(element) => {
                self.elements.push(element);
                Some((Undo::Pop, [element.class; 2], [count; 2]))
            }
            Change::Set(index, element) => {
                let old = std::mem::replace(self.elements.get_mut(index)?, element);
                let undo = Undo::Put(index, old);
                Some((undo, [old.class, element.class], [index as u32; 2]))
            }
            Change::Remove(index) => {
                let moved = self.elements.last()?.class;
                self.elements.get(index)?;
                let old = self.elements.swap_remove(index);
                let undo = Undo::Insert(index, old);
                Some((undo, [old.class, moved], [index as u32, count - 1]))
            }
        }
    }

    fn regroup(&self, classes: [Class; 2], touched: [u32; 2]) -> Evaluation {
        let old = &self.now;
        let mut grids: Vec<Arc<Grid>> = Vec::with_capacity(old.grids.len() + 1);
        let mut from: Vec<Option<usize>> = Vec::with_capacity(old.grids.len() + 1);
        for class in Class::ALL {
            let known = (old.grids.iter().enumerate()).filter(|(_, g)| g.class == class);
            if !classes.contains(&class) {
                for (i, grid) in known {
                    grids.push(Arc::clone(grid));
                    from.push(Some(i));
                }
                continue;
            }
            let of_class: Vec<u32> = (0..self.elements.len() as u32)
                .filter(|&i| self.elements[i as usize].class == class)
                .collect();
            for members in clusters(&self.elements, &of_class) {
                let stays = !touched.iter().any(|t| members.binary_search(t).is_ok());
                let same = known.clone().find(|(_, g)| stays && g.members == members);
                grids.push(match same {
                    Some((_, grid)) => Arc::clone(grid),
                    None => Arc::new(Grid::new(&self.elements, members, class, self.facade[0])),
                });
                from.push(same.map(|(i, _)| i));
            }
        }
        let count = old.grids.len();
        let unary = |i: usize| from[i].map(|i| old.unary[i]);
        let pair = |i: usize, j: usize| {
            let (a, b) = (from[i]?, from[j]?);
            let (a, b) = (a.min(b), a.max(b));
            // Pairs are stored row by row: row a begins after (count - 1) + ... + (count - a) pairs.
            Some(old.pairs[a * count - a * (a + 1) / 2 + (b - a - 1)])
        };
        self.model.evaluate_grids(self.facade, grids, unary, pair)
    }
}
