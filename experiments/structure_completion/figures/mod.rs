//! The paper's figures, each with the numbers that the paper lacks.

pub(crate) mod figure_10;
pub(crate) mod figure_11;
pub(crate) mod figure_13;
pub(crate) mod figure_14;
pub(crate) mod figure_15;
pub(crate) mod figure_16;
pub(crate) mod figure_18;
pub(crate) mod figure_20;
pub(crate) mod figure_8;

pub(crate) use figure_18::{drawn, without};

use super::data::{self, Item};
use edifice_base::unwatched;
use edifice_base::{Error, Result};
use edifice_frame::Context;
use edifice_structure_completion::completion::Completion;
use edifice_structure_completion::layout::{Class, Element, Layout};
use edifice_structure_completion::policy::PaperModel;

/// Facades that fit a picture and that a search of seconds can complete.
const ELEMENTS: std::ops::RangeInclusive<usize> = 8..=90;

/// Facades with at least eight windows and at most 90 elements; those in scope only, where there are enough.
pub(crate) fn facades(ctx: &mut Context) -> Result<Vec<Item>> {
    let mut items = data::items(ctx)?;
    items.retain(in_size);
    if items.iter().filter(|i| i.in_scope).count() > items.len() / 2 {
        items.retain(|i| i.in_scope);
    }
    Ok(items)
}

/// True if a facade has at least eight windows and at most 90 elements.
pub(crate) fn in_size(item: &Item) -> bool {
    item.layout.count(Class::Window) >= 8 && ELEMENTS.contains(&item.layout.elements.len())
}

/// Up to `count` facades at equal distances, at most half of all, and the others, for learning.
fn split(items: &[Item], count: usize) -> (Vec<&Item>, Vec<&Item>) {
    let count = count.min(items.len() / 2).max(1);
    let chosen = |i: usize| (i * count) / items.len() != ((i + 1) * count) / items.len();
    let of = |wanted: bool| {
        let all = items.iter().enumerate();
        all.filter(|(i, _)| chosen(*i) == wanted)
            .map(|(_, item)| item)
            .collect()
    };
    (of(true), of(false))
}

/// The paper's part of a model, learnt from some facades; a quick run takes few of them.
fn paper(ctx: &Context, items: &[&Item]) -> Result<PaperModel> {
    let count = ctx.budget().choose(6, items.len(), items.len());
    let layouts = items.iter().take(count).map(|i| i.layout.clone());
    let layouts: Vec<Layout> = layouts.collect();
    PaperModel::train(&layouts, ctx.seed(), &unwatched).map_err(Error::method)
}

/// The elements that the first completion adds.
fn first(completions: &[Completion]) -> Vec<Element> {
    let added = completions.first().into_iter().flat_map(|c| &c.added);
    added.map(|a| a.element).collect()
}

/// Mean and its standard error, as text.
fn plus_minus(values: &[f64]) -> String {
    let (mean, error) = mean_error(values);
    format!("{mean:.3} ± {error:.3}")
}

/// Standard errors beyond which a difference counts as shown.
const SHOWN: f64 = 2.0;

/// The verdict on a claim that the differences bear out.
const TRUE: &str = "true here";

/// The state of a claim of the paper by differences that are above 0 where it is true, facade by facade.
fn verdict(differences: &[f64]) -> &'static str {
    let (mean, error) = mean_error(differences);
    match mean.abs() > SHOWN * error {
        true if mean > 0.0 => TRUE,
        true => "false here",
        false => "not shown here",
    }
}

/// A sentence on a claim of the paper, with the differences that decide it.
fn judged(claim: &str, measure: &str, differences: &[f64]) -> String {
    format!(
        "The paper's claim that {claim} is {}: {measure} {}, mean and standard error over {} facades; a difference below two standard errors shows nothing.",
        verdict(differences),
        plus_minus(differences),
        differences.len()
    )
}

fn mean_error(values: &[f64]) -> (f64, f64) {
    let n = values.len().max(1) as f64;
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0).max(1.0);
    (mean, (variance / n).sqrt())
}
